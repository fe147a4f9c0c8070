#pragma once
// Depth unsharp masking. T. Luft, C. Colditz, O. Deussen, Image Enhancement by Unsharp Masking the Depth
// Buffer, SIGGRAPH 2006, doi 10.1145/1141911.1142016. Deviations: the background has no depth instead of the
// far plane's, so that an object gets no bright rim against it (a normalised convolution over what is
// covered); the Gaussian runs on means of blocks of pixels, at a cost that hardly depends on its radius.

#include "core/effects/depth_unsharp.h"
#include "core/render_settings.h"
#include "core/view.h"
#include "render/frame_graph.h"
#include "render/gbuffer.h"
#include "render/post/surface_reader.h"
#include "render/shader_library.h"
#include "render/view_block.h"

namespace meniscus {

/// The Gaussian of a view on the grid of blocks.
struct UnsharpKernel {
  int block = 1;     ///< side of a block [pixels]
  double sigma = 0;  ///< of the Gaussian between blocks [blocks]; blocks and interpolation add the rest
  int taps = 1;      ///< from the middle to one side
};

/// Standard deviation of the Gaussian in pixels of the final picture.
double unsharpSigma(const DepthUnsharpSettings& settings, const View& view);
UnsharpKernel unsharpKernel(double sigmaPixels);

/// A buffer for the passes' uniforms, which outlives the frames.
class DepthUnsharpUniforms {
 public:
  /// Makes the block current for the next frames, which draw `tile`.
  void set(const UnsharpKernel& kernel, const Tile& tile);
  unsigned name() const { return buffer_.object.name(); }
  const effects::DepthUnsharpBlock& block() const { return block_; }

 private:
  gl::Buffer buffer_;
  effects::DepthUnsharpBlock block_{};
};

/// How far from a pixel lies what decides about it [pixels].
int reachOf(const DepthUnsharpSettings& settings, const View& view);

/// Adds four passes, or with a reader one for the processor. Returns, per pixel, how much nearer to the
/// viewer it lies than its surroundings, as a share of the scene's depth range (0 on the background). reader:
/// must outlive the graph.
TextureRef addDepthUnsharp(FrameGraph& graph, const UnsharpKernel& kernel,
                           const DepthUnsharpUniforms& uniforms, ShaderLibrary& shaders,
                           const GBufferRefs& gbuffer, const Tile& tile, SurfaceReader* reader = nullptr);

}  // namespace meniscus

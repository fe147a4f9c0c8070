#pragma once
// Shadows of the key light. W. Reeves, D. Salesin, R. Cook, Rendering Antialiased Shadows with Depth Maps,
// SIGGRAPH 1987, doi 10.1145/37402.37435; adaptive number of samples after Sigg et al. 2006, §4. The bias is
// not a constant: see shaders/post/shadow.frag.

#include <memory>
#include <vector>

#include "core/effects/shadow_lookup.h"
#include "core/render_settings.h"
#include "core/view.h"
#include "render/frame_graph.h"
#include "render/gbuffer.h"
#include "render/post/surface_reader.h"
#include "render/shader_library.h"

namespace meniscus {

/// A drawn shadow map and the view it was drawn with.
struct ShadowMap {
  View light;
  const gl::Texture* depth = nullptr;
  std::shared_ptr<const std::vector<float>> heights = {};  ///< the same in main memory, for a SurfaceReader
  bool drawn() const { return depth != nullptr || heights != nullptr; }
};

/// Side of the largest map that suits a picture [texels]. A context must be current.
int largestShadowMap(ImageSize picture);

/// A buffer for the pass's uniforms, which outlives the frames.
class ShadowUniforms {
 public:
  /// Makes the block current for the next frames. `sample` of `sampleCount` rays per pixel turns the pattern,
  /// so that all of them together see different texels.
  void set(const ShadowSettings& settings, const View& camera, const ShadowMap& map, int sample,
           int sampleCount);
  unsigned name() const { return buffer_.object.name(); }
  const effects::ShadowFilter& filter() const { return filter_; }

 private:
  gl::Buffer buffer_;
  effects::ShadowFilter filter_{};
};

/// Adds the pass. Returns the share of the key light that arrives, per pixel (0 on the background). reader:
/// if the processor computes it; must outlive the graph.
TextureRef addShadow(FrameGraph& graph, const ShadowSettings& settings, const ShadowMap& map,
                     const ShadowUniforms& uniforms, ShaderLibrary& shaders, const GBufferRefs& gbuffer,
                     int width, int height, SurfaceReader* reader = nullptr);

}  // namespace meniscus

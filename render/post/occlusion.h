#pragma once
// Ambient occlusion: the share of the sky, weighted by the cosine to the normal, that a point sees, by
// looking up what lies above it along many directions (core/occlusion_maps.h). After S. Zhukov, A. Iones, G.
// Kronin, An Ambient Light Illumination Model, EGWR 1998, doi 10.1007/978-3-7091-6453-2_5 (occluders count by
// distance); accumulated shadow maps as M. Tarini, P. Cignoni, C. Montani, Ambient Occlusion and Edge Cueing
// to Enhance Real Time Molecular Visualization, TVCG 12(5), 2006, doi 10.1109/TVCG.2006.115. Departure: the
// maps hold slabs, so that an occluder close by is found behind one far away, and each is compared with the
// tangent plane.

#include <functional>
#include <glm/vec4.hpp>
#include <vector>

#include "core/effects/occlusion_lookup.h"
#include "core/occlusion_maps.h"
#include "render/frame_graph.h"
#include "render/gbuffer.h"
#include "render/post/surface_reader.h"
#include "render/shader_library.h"
#include "render/view_block.h"

namespace meniscus {

/// How a frame that is one of several samples of a picture deals its directions out.
struct OcclusionShare {
  int directions = 0;  ///< that the frame uses
  int parts = 1;       ///< into which neighbouring pixels divide them; 1 = each pixel uses all
};
OcclusionShare occlusionShare(int directions, int sampleCount);

/// The maps and how a frame looks them up, on the GPU or in main memory.
class OcclusionBuffers {
 public:
  /// Takes the maps of one picture, which `camera` sees.
  void set(const View& camera, OcclusionMaps maps, bool onProcessor);
  /// Which of the directions the next frame's pixels use: all, or for one of several samples its part.
  void chooseDirections(int sample, int sampleCount, const Tile& tile);
  void clear();
  std::uint64_t bytes() const;
  /// As the processor takes it, if it was asked for.
  const effects::OcclusionLook& look() const { return look_; }

  /// Into how many parts the next frame's target is divided.
  int parts() const { return static_cast<int>(draws_.size()); }
  /// Draws them; the G-buffer is bound to units 0 and 1.
  void draw(ShaderLibrary& shaders) const;
  /// The G-buffer's depth as the parts see it.
  void divideDepth(ShaderLibrary& shaders) const;
  /// Makes a block of uniforms current that says how the parts lie.
  void bindFirst() const;

 private:
  struct Draw {
    int x, y, width, height;
    int groups;  // of directions, added up
  };
  std::vector<effects::OcclusionDirection> directions_;
  effects::OcclusionLook look_;
  bool onProcessor_ = false;
  std::vector<OcclusionTexel> heights_;
  std::vector<Draw> draws_;
  gl::Buffer uniforms_;
  gl::Texture texels_;

  void upload(const std::vector<OcclusionTexel>& texels);
  void setUniforms(const Tile& tile);
  void eachDraw(const std::function<void(bool first)>& call) const;
};

/// How far a pixel looks [pixels].
int reachOf(const OcclusionSettings& settings, int sampleCount);

/// Adds the passes. Returns per pixel what is hidden of the sky and the sky itself, in one unit (both 0 on
/// the background). reader: if the processor computes it; must outlive the graph.
TextureRef addOcclusion(FrameGraph& graph, const OcclusionBuffers& buffers, ShaderLibrary& shaders,
                        const GBufferRefs& gbuffer, int width, int height, SurfaceReader* reader = nullptr);

}  // namespace meniscus

#pragma once
// Ambient occlusion: the share of the sky, weighted by the cosine to the normal, that a point sees, by
// looking up what lies above it along many directions (core/occlusion_maps.h). After S. Zhukov, A. Iones, G.
// Kronin, An Ambient Light Illumination Model, EGWR 1998, doi 10.1007/978-3-7091-6453-2_5 (occluders count by
// distance); accumulated shadow maps as M. Tarini, P. Cignoni, C. Montani, Ambient Occlusion and Edge Cueing
// to Enhance Real Time Molecular Visualization, TVCG 12(5), 2006, doi 10.1109/TVCG.2006.115. Departure: the
// maps hold slabs, so that an occluder close by is found behind one far away, and each is compared with the
// tangent plane.

#include "core/occlusion_maps.h"
#include "render/frame_graph.h"
#include "render/gbuffer.h"
#include "render/shader_library.h"

namespace meniscus {

/// The maps and the pass's uniforms on the GPU.
class OcclusionBuffers {
 public:
  /// Takes the maps of one picture, which `camera` sees.
  void set(const View& camera, const OcclusionMaps& maps);
  /// Which of the directions the next frame uses: all, or for one of several samples its part.
  void chooseDirections(int sample, int sampleCount);
  void clear() { texels_ = {}; }
  std::uint64_t bytes() const { return texels_.bytes(); }

 private:
  friend TextureRef addOcclusion(FrameGraph&, const OcclusionBuffers&, ShaderLibrary&, const GBufferRefs&,
                                 int, int);
  int groups_ = 0;             // of eight directions
  int first_ = 0, count_ = 0;  // groups that the next frame uses
  gl::Buffer uniforms_;
  gl::Texture texels_;

  void upload(const std::vector<std::uint32_t>& texels);
};

/// Adds the pass. Returns per pixel what is hidden of the sky and the sky itself, in one unit (both 0 on the
/// background).
TextureRef addOcclusion(FrameGraph& graph, const OcclusionBuffers& buffers, ShaderLibrary& shaders,
                        const GBufferRefs& gbuffer, int width, int height);

}  // namespace meniscus

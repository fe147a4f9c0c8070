#pragma once
// Spheres, cylinders and ellipsoids as ray-cast quadrics: a rectangle per primitive, a ray per fragment.
// Sigg, Weyrich, Botsch, Gross, GPU-Based Ray-Casting of Quadratic Surfaces, PBG 2006,
// doi 10.2312/SPBG/SPBG06/059-065. Deviations: rectangles instead of point sprites, whose size drivers limit
// (255 px on llvmpipe); intersection relative to each primitive's centre instead of in window space
// (shaders/shared/).

#include <vector>

#include "core/primitives.h"
#include "render/frame_graph.h"
#include "render/gbuffer.h"
#include "render/shader_library.h"

namespace meniscus {

/// The GPU's copy of Primitives. A kind that a scene does not have has no buffer.
class QuadricBuffers {
 public:
  /// Uploads what is not there yet.
  void upload(const Primitives& primitives);
  void clear();
  std::vector<ResourceStats> buffers() const;

  struct Kind {
    gl::Object vertexArray;
    gl::Buffer instances;
    int count = 0;
  };
  const Kind& spheres() const { return spheres_; }
  const Kind& cylinders() const { return cylinders_; }
  const Kind& ellipsoids() const { return ellipsoids_; }

 private:
  Kind spheres_, cylinders_, ellipsoids_;
};

/// Adds a pass for each kind of quadric there is. The view's uniform block must be bound
/// (render/renderer_frame.cpp). Channels of `gbuffer` that are not valid are not written; `prefix` goes
/// before the passes' names.
void addQuadrics(FrameGraph& graph, const QuadricBuffers& quadrics, ShaderLibrary& shaders,
                 const GBufferRefs& gbuffer, const std::string& prefix = {});

}  // namespace meniscus

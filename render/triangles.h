#pragma once
// Triangles with the normals of the surface that they stand for, into the G-buffer.

#include <string>
#include <vector>

#include "core/triangle_mesh.h"
#include "render/frame_graph.h"
#include "render/gbuffer.h"
#include "render/shader_library.h"

namespace meniscus {

/// The GPU's copy of a mesh; an empty one has no buffers.
class TriangleBuffers {
 public:
  /// Uploads what is not there yet.
  void upload(const TriangleMesh& mesh);
  void clear();
  std::vector<ResourceStats> buffers() const;

  bool empty() const { return indexCount_ == 0; }
  int indexCount() const { return indexCount_; }
  unsigned vertexArray() const { return vertexArray_.name(); }
  unsigned surfaces() const { return surfaces_.object.name(); }

 private:
  gl::Object vertexArray_;
  gl::Buffer vertices_, indices_, surfaces_;
  int indexCount_ = 0;
};

/// Adds the pass, or notes that the scene has no triangles. The view's uniform block must be bound
/// (render/renderer.cpp). `prefix` goes before the pass's name. Into a shadow map go the sides that face away
/// from the light: the mesh is closed, so that they cast the same shadow, and none onto the sides in front of
/// them.
void addTriangles(FrameGraph& graph, const TriangleBuffers& triangles, ShaderLibrary& shaders,
                  const GBufferRefs& gbuffer, const std::string& prefix = {});

}  // namespace meniscus

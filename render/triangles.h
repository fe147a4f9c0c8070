#pragma once
// Triangles with the normals of the surface that they stand for, into the G-buffer.

#include <cstdint>
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
  /// Uploads what is not there yet. Shaders see at most so many bytes of it at once; 0: as the driver allows.
  void upload(const TriangleMesh& mesh, std::int64_t blockBytes = 0);
  void clear();
  /// With the program that is in use.
  void draw() const;
  std::vector<ResourceStats> buffers() const;

  bool empty() const { return count_ == 0; }

 private:
  gl::Object vertexArray_;
  gl::Buffer vertices_, indices_, surfaces_;
  int count_ = 0, perDraw_ = 0;  // triangles
};

/// Adds the pass, or notes that the scene has no triangles. The view's uniform block must be bound
/// (render/renderer_frame.cpp). `prefix` goes before the pass's name. Into a shadow map go the sides that
/// face away from the light: the mesh is closed, so that they cast the same shadow, and none onto the sides
/// in front of them.
void addTriangles(FrameGraph& graph, const TriangleBuffers& triangles, ShaderLibrary& shaders,
                  const GBufferRefs& gbuffer, const std::string& prefix = {});

}  // namespace meniscus

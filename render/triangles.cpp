#include "render/triangles.h"

#include <glad/gl.h>

#include <cstddef>
#include <limits>

#include "core/error.h"

namespace meniscus {

void TriangleBuffers::upload(const TriangleMesh& mesh) {
  if (mesh.empty() || !empty()) return;
  if (mesh.triangles.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()) / 3)
    throw InputError("the scene has more than 715,827,882 triangles; draw a part of it (--select)");
  indexCount_ = static_cast<int>(3 * mesh.triangles.size());
  vertices_ = gl::Buffer::fromData(mesh.vertices.data(), mesh.vertices.size() * sizeof(TriangleVertex));
  indices_ = gl::Buffer::fromData(mesh.triangles.data(), mesh.triangles.size() * sizeof(TriangleCorners));
  surfaces_ = gl::Buffer::fromData(mesh.surfaces.data(), mesh.surfaces.size() * sizeof(TriangleSurface));
  GLuint vertexArray = 0;
  glCreateVertexArrays(1, &vertexArray);
  vertexArray_ = gl::Object(gl::ObjectKind::vertexArray, vertexArray);
  glVertexArrayVertexBuffer(vertexArray, 0, vertices_.object.name(), 0, sizeof(TriangleVertex));
  glVertexArrayElementBuffer(vertexArray, indices_.object.name());
  for (const auto& [location, offset] :
       {std::pair{0u, offsetof(TriangleVertex, position)}, std::pair{1u, offsetof(TriangleVertex, normal)}}) {
    glEnableVertexArrayAttrib(vertexArray, location);
    glVertexArrayAttribFormat(vertexArray, location, 3, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
    glVertexArrayAttribBinding(vertexArray, location, 0);
  }
}

void TriangleBuffers::clear() {
  *this = TriangleBuffers{};
}

std::vector<ResourceStats> TriangleBuffers::buffers() const {
  if (empty()) return {};
  return {{"triangles", vertices_.bytes + indices_.bytes + surfaces_.bytes}};
}

void addTriangles(FrameGraph& graph, const TriangleBuffers& triangles, ShaderLibrary& shaders,
                  const GBufferRefs& g, const std::string& prefix) {
  if (triangles.empty()) {
    graph.leaveOut("pass " + prefix + "triangles", "the scene has none");
    return;
  }
  std::vector<FrameGraph::Attachment> writes{{g.depth, FrameGraph::kDepth}};
  for (const auto& [channel, location] :
       {std::pair{g.albedo, 0}, std::pair{g.normal, 1}, std::pair{g.id, 2}, std::pair{g.distance, 3}}) {
    if (channel.valid()) writes.push_back({channel, location});
  }
  graph.addPass(prefix + "triangles", {g.depth}, writes,
                [&triangles, &shaders, g, shadow = !prefix.empty()](const PassContext& context) {
                  ShaderFlags flags;
                  if (context.isLive(g.albedo)) flags.insert("ALBEDO");
                  if (context.isLive(g.normal)) flags.insert("NORMAL");
                  if (context.isLive(g.id)) flags.insert("ID");
                  if (context.isLive(g.distance)) flags.insert("DISTANCE");
                  glUseProgram(shaders.program("triangles/mesh.vert", "triangles/mesh.frag", flags));
                  glBindVertexArray(triangles.vertexArray());
                  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, triangles.surfaces());
                  glEnable(GL_DEPTH_TEST);
                  glDepthFunc(GL_GREATER);
                  if (shadow) {
                    glEnable(GL_CULL_FACE);
                    glCullFace(GL_FRONT);
                  }
                  glDrawElements(GL_TRIANGLES, triangles.indexCount(), GL_UNSIGNED_INT, nullptr);
                  glDisable(GL_CULL_FACE);
                  glCullFace(GL_BACK);
                  glDisable(GL_DEPTH_TEST);
                });
}

}  // namespace meniscus

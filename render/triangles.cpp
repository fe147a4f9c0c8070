#include "render/triangles.h"

#include <glad/gl.h>

#include <algorithm>
#include <cstddef>
#include <limits>

#include "core/error.h"

namespace meniscus {

namespace {

// Parts of a storage buffer begin at multiples of what the driver says, which is at most 256 bytes
// (SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT, OpenGL 4.5).
constexpr std::int64_t kPartStep = 256 / sizeof(TriangleSurface);

int trianglesPerDraw(std::int64_t blockBytes, int all) {
  const std::int64_t fit = blockBytes / static_cast<std::int64_t>(sizeof(TriangleSurface));
  return static_cast<int>(std::clamp<std::int64_t>(fit / kPartStep * kPartStep, kPartStep,
                                                   std::max<std::int64_t>(all, kPartStep)));
}

}  // namespace

void TriangleBuffers::upload(const TriangleMesh& mesh, std::int64_t blockBytes) {
  if (mesh.empty() || !empty()) return;
  if (mesh.triangles.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()) / 3)
    throw InputError("the scene has more than 715,827,882 triangles; draw a part of it (--select)");
  count_ = static_cast<int>(mesh.triangles.size());
  perDraw_ = trianglesPerDraw(blockBytes > 0 ? blockBytes : gl::queryLimits().storageBlock, count_);
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

void TriangleBuffers::draw() const {
  glBindVertexArray(vertexArray_.name());
  for (int first = 0; first < count_; first += perDraw_) {
    const int count = std::min(perDraw_, count_ - first);
    const auto from = static_cast<std::size_t>(first);
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, 0, surfaces_.object.name(),
                      static_cast<GLintptr>(from * sizeof(TriangleSurface)),
                      static_cast<GLsizeiptr>(static_cast<std::size_t>(count) * sizeof(TriangleSurface)));
    // OpenGL takes offsets as pointers. NOLINTNEXTLINE(performance-no-int-to-ptr)
    const auto* corners = reinterpret_cast<const void*>(from * sizeof(TriangleCorners));
    glDrawElements(GL_TRIANGLES, 3 * count, GL_UNSIGNED_INT, corners);
  }
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
  graph.addPass(
      prefix + "triangles", {g.depth}, attachmentsOf(g),
      [&triangles, &shaders, g, shadow = !prefix.empty()](const PassContext& context) {
        glUseProgram(shaders.program("triangles/mesh.vert", "triangles/mesh.frag", channelFlags(context, g)));
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_GREATER);
        if (shadow) {
          glEnable(GL_CULL_FACE);
          glCullFace(GL_FRONT);
        }
        triangles.draw();
        glDisable(GL_CULL_FACE);
        glCullFace(GL_BACK);
        glDisable(GL_DEPTH_TEST);
      });
}

}  // namespace meniscus

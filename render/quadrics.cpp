#include "render/quadrics.h"

#include <glad/gl.h>

#include <cstddef>
#include <limits>
#include <string_view>

#include "core/error.h"

namespace meniscus {

namespace {

constexpr int kCornersPerQuad = 4;

int instanceCount(std::size_t count) {
  if (count > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw InputError(
        "the scene has more than 2,147,483,647 primitives; draw a part of it (--select, fewer copies)");
  }
  return static_cast<int>(count);
}

// One attribute of an instance: `components` floats, or unsigned integers kept as integers (llvmpipe flushes
// denormals: an id carried as a float's bits would become 0).
void attribute(GLuint vertexArray, GLuint location, GLint components, GLenum type, std::size_t offset) {
  glEnableVertexArrayAttrib(vertexArray, location);
  if (type == GL_FLOAT) {
    glVertexArrayAttribFormat(vertexArray, location, components, type, GL_FALSE, static_cast<GLuint>(offset));
  } else {
    glVertexArrayAttribIFormat(vertexArray, location, components, type, static_cast<GLuint>(offset));
  }
  glVertexArrayAttribBinding(vertexArray, location, 0);
}

template <typename T>
QuadricBuffers::Kind uploadInstances(const std::vector<T>& instances) {
  QuadricBuffers::Kind kind;
  kind.count = instanceCount(instances.size());
  kind.instances = gl::Buffer::fromData(instances.data(), instances.size() * sizeof(T));
  GLuint vertexArray = 0;
  glCreateVertexArrays(1, &vertexArray);
  kind.vertexArray = gl::Object(gl::ObjectKind::vertexArray, vertexArray);
  glVertexArrayVertexBuffer(vertexArray, 0, kind.instances.object.name(), 0, sizeof(T));
  glVertexArrayBindingDivisor(vertexArray, 0, 1);
  return kind;
}

void addKind(FrameGraph& graph, const QuadricBuffers::Kind& kind, std::string_view shape,
             const std::string& passName, ShaderLibrary& shaders, const GBufferRefs& g) {
  graph.addPass(passName, {g.depth}, attachmentsOf(g),
                [&kind, &shaders, g, stem = "quadrics/" + std::string(shape)](const PassContext& context) {
                  glUseProgram(shaders.program(stem + ".vert", stem + ".frag", channelFlags(context, g)));
                  glBindVertexArray(kind.vertexArray.name());
                  glEnable(GL_DEPTH_TEST);
                  glDepthFunc(GL_GREATER);
                  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, kCornersPerQuad, kind.count);
                  glDisable(GL_DEPTH_TEST);
                });
}

}  // namespace

void QuadricBuffers::upload(const Primitives& primitives) {
  if (!spheres_.instances.object && !primitives.spheres.empty()) {
    spheres_ = uploadInstances(primitives.spheres);
    const GLuint vertexArray = spheres_.vertexArray.name();
    attribute(vertexArray, 0, 4, GL_FLOAT, offsetof(SpherePrimitive, center));
    attribute(vertexArray, 1, 2, GL_UNSIGNED_INT, offsetof(SpherePrimitive, color));
  }
  if (!cylinders_.instances.object && !primitives.cylinders.empty()) {
    cylinders_ = uploadInstances(primitives.cylinders);
    const GLuint vertexArray = cylinders_.vertexArray.name();
    attribute(vertexArray, 0, 4, GL_FLOAT, offsetof(CylinderPrimitive, a));
    attribute(vertexArray, 1, 3, GL_FLOAT, offsetof(CylinderPrimitive, b));
    attribute(vertexArray, 2, 4, GL_UNSIGNED_INT, offsetof(CylinderPrimitive, colorA));
  }
  if (!ellipsoids_.instances.object && !primitives.ellipsoids.empty()) {
    ellipsoids_ = uploadInstances(primitives.ellipsoids);
    const GLuint vertexArray = ellipsoids_.vertexArray.name();
    attribute(vertexArray, 0, 4, GL_FLOAT, offsetof(EllipsoidPrimitive, center));
    attribute(vertexArray, 1, 3, GL_FLOAT, offsetof(EllipsoidPrimitive, axisA));
    attribute(vertexArray, 2, 3, GL_FLOAT, offsetof(EllipsoidPrimitive, axisB));
    attribute(vertexArray, 3, 2, GL_UNSIGNED_INT, offsetof(EllipsoidPrimitive, color));
  }
}

void QuadricBuffers::clear() {
  spheres_ = Kind{};
  cylinders_ = Kind{};
  ellipsoids_ = Kind{};
}

std::vector<ResourceStats> QuadricBuffers::buffers() const {
  std::vector<ResourceStats> out;
  if (spheres_.instances.object) out.push_back({"spheres", spheres_.instances.bytes});
  if (cylinders_.instances.object) out.push_back({"cylinders", cylinders_.instances.bytes});
  if (ellipsoids_.instances.object) out.push_back({"ellipsoids", ellipsoids_.instances.bytes});
  return out;
}

void addQuadrics(FrameGraph& graph, const QuadricBuffers& quadrics, ShaderLibrary& shaders,
                 const GBufferRefs& gbuffer, const std::string& prefix) {
  const auto add = [&](const QuadricBuffers::Kind& kind, std::string_view shape) {
    const std::string name = prefix + std::string(shape) + "s";
    if (kind.count > 0) {
      addKind(graph, kind, shape, name, shaders, gbuffer);
    } else {
      graph.leaveOut("pass " + name, "the scene has none");
    }
  };
  add(quadrics.spheres(), "sphere");
  add(quadrics.cylinders(), "cylinder");
  add(quadrics.ellipsoids(), "ellipsoid");
}

}  // namespace meniscus

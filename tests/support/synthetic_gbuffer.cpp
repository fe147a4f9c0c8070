#include "tests/support/synthetic_gbuffer.h"

#include <glad/gl.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/shared_math.h"
#include "render/view_block.h"

namespace meniscus::test {

View orthographicView(ImageSize size, double pixelSize, double nearZ, double farZ) {
  View view;
  view.projection = Projection::orthographic;
  view.pixelSize = pixelSize;
  view.size = size;
  view.center = glm::dvec2(size.width, size.height) * 0.5;
  view.nearZ = nearZ;
  view.farZ = farZ;
  return view;
}

View perspectiveView(ImageSize size, double pixelSize, double distance, double nearZ, double farZ) {
  View view = orthographicView(size, pixelSize, nearZ, farZ);
  view.projection = Projection::perspective;
  view.distance = distance;
  return view;
}

SurfaceFunction planeThrough(const glm::dvec3& point, const glm::dvec3& normal) {
  const glm::dvec3 n = glm::normalize(normal);
  return [=](const Ray& ray) -> std::optional<SurfaceSample> {
    const double towards = glm::dot(n, ray.direction);
    if (towards >= 0) return std::nullopt;
    const double t = glm::dot(n, point - ray.origin) / towards;
    return SurfaceSample{ray.origin.z + t * ray.direction.z, n, 1};
  };
}

SurfaceFunction sphereAt(const glm::dvec3& center, double radius) {
  return [=](const Ray& ray) -> std::optional<SurfaceSample> {
    const glm::dvec3 from = ray.origin - center;
    const double along = glm::dot(from, ray.direction);
    const double squared = along * along - glm::dot(from, from) + radius * radius;
    if (squared < 0) return std::nullopt;
    const glm::dvec3 hit = ray.origin + (-along - std::sqrt(squared)) * ray.direction;
    return SurfaceSample{hit.z, (hit - center) / radius, 1};
  };
}

SyntheticGBuffer::SyntheticGBuffer(const View& view, const SurfaceFunction& surface) {
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);  // as the renderer
  const int width = view.size.width, height = view.size.height;
  const f32::ViewBlock block = makeViewBlock(view, view.pivot, {0, 0, width, height}, {0, 0});
  std::vector<float> depths;
  std::vector<std::uint16_t> normals;
  std::vector<std::uint32_t> ids, colors;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::optional<SurfaceSample> s = surface(rayThrough(view, {x + 0.5, y + 0.5}));
      const glm::vec2 normal = s ? f32::encodeNormal(glm::vec3(s->normal)) : glm::vec2(0.0f);
      depths.push_back(s ? f32::depthValue(block, static_cast<float>(s->z)) : 0.0f);
      for (const float part : {normal.x, normal.y})
        normals.push_back(static_cast<std::uint16_t>(std::lround(part * 65535.0f)));
      ids.push_back(s ? s->id : 0);
      colors.push_back(s ? 0xFFFFFFFFu : 0);
    }
  }
  depth_ = gl::Texture::make({gl::TextureFormat::depth32f, width, height});
  normal_ = gl::Texture::make({gl::TextureFormat::rg16, width, height});
  id_ = gl::Texture::make({gl::TextureFormat::r32ui, width, height});
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(depth_.object.name(), 0, 0, 0, width, height, GL_DEPTH_COMPONENT, GL_FLOAT,
                      depths.data());
  glTextureSubImage2D(normal_.object.name(), 0, 0, 0, width, height, GL_RG, GL_UNSIGNED_SHORT,
                      normals.data());
  glTextureSubImage2D(id_.object.name(), 0, 0, 0, width, height, GL_RED_INTEGER, GL_UNSIGNED_INT, ids.data());
  albedo_ = gl::Texture::make({gl::TextureFormat::rgba8, width, height});
  glTextureSubImage2D(albedo_.object.name(), 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE,
                      colors.data());
  view_ = gl::Buffer::fromData(&block, sizeof(block));
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, view_.object.name());
}

GBufferRefs SyntheticGBuffer::import(FrameGraph& graph) const {
  GBufferRefs refs;
  refs.depth = graph.import("depth", depth_, Clear::none);
  refs.normal = graph.import("normal", normal_, Clear::none);
  refs.id = graph.import("id", id_, Clear::none);
  refs.albedo = graph.import("albedo", albedo_, Clear::none);
  return refs;
}

std::vector<double> run(FrameGraph& graph, TextureRef wanted) {
  graph.want(wanted);
  RenderStats stats;
  graph.execute(stats, false);
  const gl::Texture& texture = graph.texture(wanted);
  const int width = texture.desc.width, height = texture.desc.height;
  const gl::TextureFormat format = texture.desc.format;
  const std::size_t channels = format == gl::TextureFormat::rgba32f ? 4
                               : format == gl::TextureFormat::rg16  ? 2
                                                                    : 1;
  const std::size_t count = channels * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (format == gl::TextureFormat::r32f || format == gl::TextureFormat::rgba32f) {
    std::vector<float> values(count);
    texture.read(width, height, width, values.data());
    return {values.begin(), values.end()};
  }
  std::vector<std::uint16_t> values(count);
  texture.read(width, height, width, values.data());
  std::vector<double> out;
  for (const std::uint16_t value : values) out.push_back(value / 65535.0);
  return out;
}

}  // namespace meniscus::test

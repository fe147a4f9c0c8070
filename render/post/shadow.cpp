#include "render/post/shadow.h"

#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/packing.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "core/sampling.h"
#include "render/post/fullscreen.h"

namespace meniscus {

namespace {

constexpr double kPi = 3.141592653589793;
constexpr double kGoldenAngle = 2.399963229728653;

// Side of the largest shadow map [texels]. As a picture from outside its scene needs about two texels a
// pixel, it is no larger than this multiple of the picture either: a close-up's frustum, seen from the side,
// is wide.
constexpr int kShadowMapSize = 8192;
constexpr double kShadowTexelsPerPixel = 8;
constexpr int kLeastShadowMapSize = 2048;

// Where the probes lie; measured: docs/measured/shadow_error.md.
constexpr int kProbesPerInnerOne = 3;
constexpr double kInnerRing = 0.45, kOuterRing = 0.92;

// Spread over the unit disc: equal areas between the radii, a golden angle between neighbours.
std::vector<glm::dvec2> discPattern(int count, double turn) {
  std::vector<glm::dvec2> points;
  for (int i = 0; i < count; ++i) {
    const double radius = std::sqrt(std::fmod(radicalInverse2(static_cast<unsigned>(i)) + 0.5 / count, 1.0));
    const double angle = i * kGoldenAngle + turn;
    points.push_back(glm::dvec2(std::cos(angle), std::sin(angle)) * radius);
  }
  return points;
}

// Brings the probes to the front: what they miss, the filter misses. Most of them lie near the rim, where the
// edge of a shadow comes in, the others inside, where thin shadows pass between.
void probesFirst(std::vector<glm::dvec2>& points, int probes, double turn) {
  const int count = std::min(probes, static_cast<int>(points.size()));
  const int inside = count / kProbesPerInnerOne;
  for (int i = 0; i < count; ++i) {
    const bool inner = i < inside;
    const int place = inner ? i : i - inside, places = inner ? inside : count - inside;
    const double radius = inner ? (inside > 1 ? kInnerRing : 0.0) : kOuterRing;
    const double angle = turn + 2 * kPi * place / places;
    const glm::dvec2 ideal = glm::dvec2(std::cos(angle), std::sin(angle)) * radius;
    const auto nearer = [&](const glm::dvec2& a, const glm::dvec2& b) {
      return glm::distance(a, ideal) < glm::distance(b, ideal);
    };
    std::iter_swap(points.begin() + i, std::min_element(points.begin() + i, points.end(), nearer));
  }
}

}  // namespace

int largestShadowMap(ImageSize picture) {
  const gl::Limits limits = gl::queryLimits();
  const double side = std::sqrt(kShadowTexelsPerPixel * static_cast<double>(picture.width) * picture.height);
  const int wanted = static_cast<int>(std::clamp<double>(side, kLeastShadowMapSize, kShadowMapSize));
  return std::min({wanted, limits.textureSize, limits.viewportWidth, limits.viewportHeight});
}

void ShadowUniforms::set(const ShadowSettings& settings, const View& camera, const ShadowMap& map, int sample,
                         int sampleCount) {
  if (!buffer_.object) buffer_ = gl::Buffer::updatable(sizeof(effects::ShadowFilter));
  const View& light = map.light;
  const glm::dmat3 rotation = light.rotation * glm::transpose(camera.rotation);
  const glm::dvec3 shift = light.rotation * (camera.pivot - light.pivot);
  const glm::dmat3 rows = glm::transpose(rotation);
  const double perTexel = 1.0 / light.pixelSize;

  effects::ShadowFilter& block = filter_;
  block = {};
  block.rowX = glm::vec4(glm::dvec4(rows[0], shift.x) * perTexel + glm::dvec4(0, 0, 0, light.center.x));
  block.rowY = glm::vec4(glm::dvec4(rows[1], shift.y) * perTexel + glm::dvec4(0, 0, 0, light.center.y));
  block.rowZ = glm::vec4(glm::dvec4(rows[2], shift.z - light.farZ));
  block.map =
      glm::vec4(glm::dvec4(light.size.width, light.size.height, light.nearZ - light.farZ, light.pixelSize));
  // At least a texel: a narrower filter would show the map's steps.
  const double radius = std::max(0.5 * settings.penumbra * perTexel, 1.0);
  const int probes = std::min((settings.probes + 3) / 4 * 4, settings.samples);
  block.filter = glm::vec4(glm::dvec4(radius, settings.samples, probes, 0.0));
  const double turn =
      sampleCount > 1 ? sample * kGoldenAngle / std::sqrt(static_cast<double>(sampleCount)) : 0;
  std::vector<glm::dvec2> points = discPattern(settings.samples, turn);
  probesFirst(points, probes, turn);
  std::transform(points.begin(), points.end(), block.offsets.begin(),
                 [](const glm::dvec2& p) { return glm::packSnorm2x16(glm::vec2(p)); });
  buffer_.update(&block);
}

TextureRef addShadow(FrameGraph& graph, const ShadowSettings& settings, const ShadowMap& map,
                     const ShadowUniforms& uniforms, ShaderLibrary& shaders, const GBufferRefs& gbuffer,
                     int width, int height, SurfaceReader* reader) {
  const bool soft = settings.mode == ShadowMode::soft;
  if (reader != nullptr) {
    const TextureRef result = reader->createResult(graph, "visibility", gl::TextureFormat::r16);
    graph.addPass(
        "shadow", surfaceOf(gbuffer), {reader->attachment(result)},
        [&uniforms, reader, gbuffer, heights = map.heights, result, soft](const PassContext& context) {
          lookUpShadow(reader->read(context, gbuffer), uniforms.filter(), *heights, soft, reader->visibility);
          reader->write(context, result, reader->visibility);
        });
    return result;
  }
  const TextureRef visibility = graph.create("visibility", {gl::TextureFormat::r16, width, height});
  const TextureRef mapRef = graph.import("shadow map", *map.depth, Clear::none);
  graph.addPass("shadow", {gbuffer.depth, gbuffer.normal, mapRef},
                {{visibility, 0}, {gbuffer.depth, FrameGraph::kTestedDepth}},
                [&uniforms, &shaders, gbuffer, mapRef, soft](const PassContext& context) {
                  glBindTextureUnit(0, context.texture(gbuffer.depth).object.name());
                  glBindTextureUnit(1, context.texture(gbuffer.normal).object.name());
                  glBindTextureUnit(2, context.texture(mapRef).object.name());
                  glBindBufferBase(GL_UNIFORM_BUFFER, 1, uniforms.name());
                  ShaderFlags flags;
                  if (soft) flags.insert("SOFT");
                  drawOverSurface(shaders.program("post/fullscreen.vert", "post/shadow.frag", flags));
                });
  return visibility;
}

}  // namespace meniscus

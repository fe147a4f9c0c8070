#include "render/post/silhouette.h"

#include <glad/gl.h>

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <glm/vec4.hpp>

#include "core/error.h"
#include "render/post/fullscreen.h"

namespace meniscus {

namespace {

// Twice what a sphere's own surface can amount to (shaders/include/outline.glsl).
constexpr double kLeastStep = 2;

// Of the scene's depth range: float32 depths, twice over, and the tangent planes they are measured from.
constexpr double kRounding = 1e-6;

// The largest offset between a pixel of a line and one with its border (silhouette_line.frag):
// along the border, half a pixel off.
double lineReach(double width) {
  return std::ceil(std::sqrt((width + 0.5) * (width + 0.5) - 0.25) - 1);
}

}  // namespace

void SilhouetteUniforms::set(const SilhouetteSettings& settings, const View& view) {
  MENISCUS_CHECK(settings.width > 0 && settings.width <= kMaxLineWidth);
  if (!buffer_.object) buffer_ = gl::Buffer::updatable(sizeof(effects::OutlineBlock));
  const double angle = glm::radians(settings.creaseAngleDeg);
  block_ = {
      glm::vec4(glm::dvec4(kLeastStep, settings.gap, kRounding * (view.nearZ - view.farZ),
                           settings.silhouettes ? 1.0 : 0.0)),
      glm::vec4(glm::dvec4(std::sin(angle), std::cos(angle), settings.width, lineReach(settings.width)))};
  buffer_.update(&block_);
}

void SilhouetteUniforms::setGroups(const std::vector<std::uint32_t>& groups) {
  byId_ = groups;
  if (groups_.object || groups.empty()) return;
  groups_ = gl::Buffer::fromData(groups.data(), groups.size() * sizeof(std::uint32_t));
}

int reachOf(const SilhouetteSettings& settings) {
  // A pixel looks at borders this far away, which look at the pixel beyond them and at the next one.
  return settings.any() ? static_cast<int>(lineReach(settings.width)) + 2 : 0;
}

TextureRef addSilhouette(FrameGraph& graph, const SilhouetteSettings& settings,
                         const SilhouetteUniforms& uniforms, ShaderLibrary& shaders,
                         const GBufferRefs& gbuffer, int width, int height, SurfaceReader* reader) {
  ShaderFlags flags;
  if (settings.creases) flags.insert("CREASES");
  std::vector<TextureRef> reads{gbuffer.depth, gbuffer.normal};
  if (settings.groups != LineGroups::none) {
    flags.insert("IDS");
    if (settings.groups != LineGroups::atoms && uniforms.groups().object) flags.insert("GROUPS");
    reads.push_back(gbuffer.id);
  }
  if (reader != nullptr) {
    if (gbuffer.planes.valid()) reads = {gbuffer.planes};
    const TextureRef lines = reader->createResult(graph, "lines", gl::TextureFormat::r16);
    graph.addPass("silhouette", reads, {reader->attachment(lines)},
                  [&uniforms, reader, gbuffer, lines, groups = settings.groups,
                   creases = settings.creases](const PassContext& context) {
                    const bool ids = groups != LineGroups::none;
                    const effects::OutlineGroups byGroup{ids, groups == LineGroups::atoms
                                                                  ? std::span<const std::uint32_t>()
                                                                  : uniforms.groupsById()};
                    drawOutlines(reader->read(context, gbuffer, {.id = ids}), uniforms.block(), byGroup,
                                 creases, reader->lines);
                    reader->write(context, lines, reader->lines);
                  });
    return lines;
  }
  const TextureRef lines = graph.create("lines", {gl::TextureFormat::r16, width, height});
  const TextureRef borders = graph.create("borders", {gl::TextureFormat::r16, width, height});
  const auto bindSurface = [&uniforms, gbuffer](const PassContext& context) {
    glBindTextureUnit(0, context.texture(gbuffer.depth).object.name());
    glBindTextureUnit(1, context.texture(gbuffer.normal).object.name());
    glBindBufferBase(GL_UNIFORM_BUFFER, 1, uniforms.name());
  };
  graph.addPass("silhouette", reads, {{borders, 0}, {gbuffer.depth, FrameGraph::kTestedDepth}},
                [&uniforms, &shaders, gbuffer, bindSurface, flags](const PassContext& context) {
                  bindSurface(context);
                  if (flags.contains("IDS")) glBindTextureUnit(2, context.texture(gbuffer.id).object.name());
                  if (flags.contains("GROUPS")) {
                    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, uniforms.groups().object.name());
                  }
                  drawOverSurface(shaders.program("post/fullscreen.vert", "post/silhouette.frag", flags));
                });
  graph.addPass("silhouette line", {gbuffer.depth, gbuffer.normal, borders},
                {{lines, 0}, {gbuffer.depth, FrameGraph::kTestedDepth}},
                [&shaders, bindSurface, borders](const PassContext& context) {
                  bindSurface(context);
                  glBindTextureUnit(2, context.texture(borders).object.name());
                  drawOverSurface(shaders.program("post/fullscreen.vert", "post/silhouette_line.frag", {}));
                });
  return lines;
}

}  // namespace meniscus

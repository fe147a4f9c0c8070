#include "render/post/shade.h"

#include <glad/gl.h>

#include <array>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include "core/error.h"
#include "render/post/fullscreen.h"
#include "render/srgb.h"

namespace meniscus {

namespace {

glm::vec4 towardsLight(const DirectionalLight& light) {
  const double length = glm::length(light.direction);
  const glm::dvec3 towards = length > 0 ? -light.direction / length : glm::dvec3(0, 0, 1);
  return glm::vec4(glm::dvec4(towards, light.intensity));
}

std::array<glm::vec4, 256> linearTable() {
  std::array<glm::vec4, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) table[i].x = static_cast<float>(linearOfBytes()[i]);
  return table;
}

glm::vec4 fogOf(const FogSettings& fog) {
  MENISCUS_CHECK(fog.start < fog.end);
  return glm::vec4(glm::dvec4(fog.strength, fog.start, 1.0 / (fog.end - fog.start), 0.0));
}

glm::vec4 unsharpOf(const ShadeSettings& settings) {
  constexpr double kUnlimited = 1e6;
  const DepthUnsharpSettings& unsharp = settings.depthUnsharp;
  return glm::vec4(glm::dvec4(unsharp.strength, unsharp.mode == UnsharpMode::halo ? 0.0 : kUnlimited,
                              settings.surfaceOpacity, settings.traced ? 1.0 : 0.0));
}

// The bound picture becomes its background: what the shader would compute of no light, and a stored colour
// is exact.
void clearTo(const ShadeSettings& settings) {
  glm::vec4 color = backdrop(settings.background);
  if (settings.encodeSrgb && !settings.background.transparent) {
    const Rgb stored = settings.background.color;
    color = glm::vec4(stored >> 16 & 0xFFu, stored >> 8 & 0xFFu, stored & 0xFFu, 255u) / 255.0f;
  }
  const float values[] = {color.r, color.g, color.b, color.a};
  glClearBufferfv(GL_COLOR, 0, values);
}

std::vector<TextureRef> with(const LightRefs& light, std::vector<TextureRef> reads) {
  for (const TextureRef ref :
       {light.visibility, light.occlusion, light.difference, light.lines, light.labels, light.traced}) {
    if (ref.valid()) reads.push_back(ref);
  }
  return reads;
}

}  // namespace

glm::vec4 backdrop(const Background& background) {
  return background.transparent ? glm::vec4(0.0f) : linearColor(background.color, 1.0);
}

void ShadeUniforms::set(const ShadeSettings& settings) {
  if (!buffer_.object) buffer_ = gl::Buffer::updatable(sizeof(effects::ShadeBlock));
  const Lighting& l = settings.lighting;
  block_ = {towardsLight(l.key),
            towardsLight(l.fill),
            glm::vec4(glm::dvec4(l.ambient, l.specular, l.shininess, settings.occlusion.strength)),
            backdrop(settings.background),
            fogOf(settings.fog),
            linearColor(settings.lines.color, settings.lines.strength),
            unsharpOf(settings),
            linearTable()};
  buffer_.update(&block_);
}

void addShade(FrameGraph& graph, const ShadeSettings& settings, const ShadeUniforms& uniforms,
              ShaderLibrary& shaders, const GBufferRefs& gbuffer, const LightRefs& light, TextureRef target) {
  const std::vector<TextureRef> reads = with(light, {gbuffer.albedo, gbuffer.normal, gbuffer.depth});
  const bool fog = settings.fog.strength > 0;
  graph.addPass("shade", reads, {{target, 0}, {gbuffer.depth, FrameGraph::kTestedDepth}},
                [settings, fog, &uniforms, &shaders, gbuffer, light](const PassContext& context) {
                  ShaderFlags flags;
                  if (settings.final) flags.insert("FINAL");
                  if (settings.final && settings.encodeSrgb) flags.insert("ENCODE_SRGB");
                  if (light.visibility.valid()) {
                    flags.insert("SHADOW");
                    glBindTextureUnit(2, context.texture(light.visibility).object.name());
                  }
                  if (light.occlusion.valid()) {
                    flags.insert("OCCLUSION");
                    glBindTextureUnit(3, context.texture(light.occlusion).object.name());
                  }
                  if (light.difference.valid()) {
                    flags.insert("UNSHARP");
                    glBindTextureUnit(4, context.texture(light.difference).object.name());
                  }
                  if (fog) {
                    flags.insert("FOG");
                    glBindTextureUnit(5, context.texture(gbuffer.depth).object.name());
                  }
                  if (light.lines.valid()) {
                    flags.insert("LINES");
                    glBindTextureUnit(6, context.texture(light.lines).object.name());
                  }
                  if (light.labels.valid()) {
                    flags.insert("LABELS");
                    glBindTextureUnit(7, context.texture(light.labels).object.name());
                  }
                  if (light.traced.valid()) {
                    glBindTextureUnit(8, context.texture(light.traced).object.name());
                  }
                  glBindTextureUnit(0, context.texture(gbuffer.albedo).object.name());
                  glBindTextureUnit(1, context.texture(gbuffer.normal).object.name());
                  glBindBufferBase(GL_UNIFORM_BUFFER, 1, uniforms.name());
                  const unsigned program = shaders.program("post/fullscreen.vert", "post/shade.frag", flags);
                  if (light.labels.valid()) {  // on the background, too
                    drawFullscreen(program, !settings.final);
                    return;
                  }
                  if (settings.final) clearTo(settings);
                  drawOverSurface(program, !settings.final);
                });
}

TextureRef addProcessorShade(FrameGraph& graph, const ShadeUniforms& uniforms, SurfaceReader& reader,
                             const GBufferRefs& gbuffer, const LightRefs& light,
                             const ProcessorShadeTarget& target) {
  const TextureRef result = graph.createInMemory("light");
  std::vector<TextureRef> reads = with(light, surfaceOf(gbuffer));
  if (!gbuffer.planes.valid()) reads.push_back(gbuffer.albedo);
  graph.addPass("shade", std::move(reads), {{result, FrameGraph::kInMemory}},
                [&uniforms, &reader, gbuffer, light, target](const PassContext& context) {
                  const effects::LightPlanes planes{
                      reader.fetch(context, light.visibility, reader.visibility),
                      reader.fetch(context, light.occlusion, reader.occlusion),
                      reader.fetch(context, light.difference, reader.difference),
                      reader.fetch(context, light.lines, reader.lines),
                      reader.fetch(context, light.traced, reader.traced),
                      reader.fetch(context, light.labels, reader.labels)};
                  const effects::SurfacePlanes& surface = reader.read(context, gbuffer, {.albedo = true});
                  if (target.picture) {
                    shadePicture(surface, uniforms.block(), planes, *target.picture);
                  } else {
                    addLight(surface, uniforms.block(), planes, target.sample == 0, *target.sum);
                  }
                });
  return result;
}

}  // namespace meniscus

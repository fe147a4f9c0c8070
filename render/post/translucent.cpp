#include "render/post/translucent.h"

#include <glad/gl.h>

#include "render/post/fullscreen.h"

namespace meniscus {

void addTranslucent(FrameGraph& graph, const ShadeSettings& settings, const ShadeUniforms& uniforms,
                    ShaderLibrary& shaders, const SurfaceLayerRefs& layers, TextureRef light,
                    TextureRef labels, TextureRef target) {
  std::vector<TextureRef> reads{light};
  reads.insert(reads.end(), layers.of.begin(), layers.of.end());
  if (labels.valid()) reads.push_back(labels);
  graph.addPass("translucent", std::move(reads), {{target, 0}},
                [settings, &uniforms, &shaders, layers, light, labels](const PassContext& context) {
                  ShaderFlags flags;
                  if (settings.final) flags.insert("FINAL");
                  if (settings.final && settings.encodeSrgb) flags.insert("ENCODE_SRGB");
                  if (settings.fog.strength > 0) flags.insert("FOG");
                  glBindTextureUnit(0, context.texture(light).object.name());
                  for (std::size_t i = 0; i < layers.of.size(); ++i)
                    glBindTextureUnit(1 + static_cast<GLuint>(i),
                                      context.texture(layers.of[i]).object.name());
                  if (labels.valid()) {
                    flags.insert("LABELS");
                    glBindTextureUnit(6, context.texture(labels).object.name());
                  }
                  glBindBufferBase(GL_UNIFORM_BUFFER, 1, uniforms.name());
                  drawFullscreen(shaders.program("post/fullscreen.vert", "post/translucent.frag", flags),
                                 !settings.final);
                });
}

}  // namespace meniscus

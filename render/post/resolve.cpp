#include "render/post/resolve.h"

#include <glad/gl.h>

#include "render/post/fullscreen.h"

namespace meniscus {

namespace {

// Layout of ResolveUniforms in shaders/post/resolve.frag.
struct ResolveBlock {
  glm::vec4 count, backdrop;
};

}  // namespace

void addResolve(FrameGraph& graph, const ResolveSettings& settings, ShaderLibrary& shaders, TextureRef sum,
                TextureRef target) {
  graph.addPass("resolve", {sum}, {{target, 0}}, [settings, &shaders, sum](const PassContext& context) {
    const ResolveBlock block{{static_cast<float>(settings.samples), 0, 0, 0}, settings.backdrop};
    const gl::Buffer uniforms = gl::Buffer::fromData(&block, sizeof(block));
    glBindTextureUnit(0, context.texture(sum).object.name());
    glBindBufferBase(GL_UNIFORM_BUFFER, 1, uniforms.object.name());
    ShaderFlags flags;
    if (settings.encodeSrgb) flags.insert("ENCODE_SRGB");
    drawFullscreen(shaders.program("post/fullscreen.vert", "post/resolve.frag", flags));
  });
}

}  // namespace meniscus

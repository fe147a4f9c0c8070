#pragma once
// Deferred shading: from the G-buffer to light.

#include "core/scene.h"
#include "render/frame_graph.h"
#include "render/gbuffer.h"
#include "render/shader_library.h"

namespace meniscus {

/// What the shading pass is told, beside the G-buffer.
struct ShadeSettings {
  Lighting lighting;
  Background background;
  bool final = false;       ///< writes the picture itself; otherwise adds a sample to a sum (resolve.h)
  bool encodeSrgb = false;  ///< of the picture
};

/// A buffer for the pass's uniforms, which outlives the frames.
class ShadeUniforms {
 public:
  /// Makes the block current for the next frames.
  void set(const ShadeSettings& settings);
  unsigned name() const { return buffer_.object.name(); }

 private:
  gl::Buffer buffer_;
};

/// What other passes found out about the light, per pixel; those that are not valid take no part.
struct LightRefs {
  TextureRef visibility;  ///< share of the key light that arrives (shadow.h)
};

/// Adds the pass; it draws into `target`, an imported texture.
void addShade(FrameGraph& graph, const ShadeSettings& settings, const ShadeUniforms& uniforms,
              ShaderLibrary& shaders, const GBufferRefs& gbuffer, const LightRefs& light, TextureRef target);

/// Background as the shaders take it: premultiplied linear light, transparent = all zero.
glm::vec4 backdrop(const Background& background);

}  // namespace meniscus

#pragma once
// Deferred shading: from the G-buffer to light.

#include <optional>

#include "core/effects/shading.h"
#include "core/render_settings.h"
#include "core/scene.h"
#include "render/frame_graph.h"
#include "render/gbuffer.h"
#include "render/post/surface_reader.h"
#include "render/shader_library.h"

namespace meniscus {

/// What the shading pass is told, beside the G-buffer.
struct ShadeSettings {
  Lighting lighting;
  Background background;
  OcclusionSettings occlusion;
  FogSettings fog;
  DepthUnsharpSettings depthUnsharp;
  SilhouetteSettings lines;
  double surfaceOpacity = 1;  ///< of translucent surfaces (translucent.h)
  bool traced = false;        ///< there are mirrors or glass (traced_light.h)
  bool final = false;         ///< writes the picture itself; otherwise adds a sample to a sum (resolve.h)
  bool encodeSrgb = false;    ///< of the picture
};

/// A buffer for the pass's uniforms, which outlives the frames.
class ShadeUniforms {
 public:
  /// Makes the block current for the next frames.
  void set(const ShadeSettings& settings);
  unsigned name() const { return buffer_.object.name(); }
  const effects::ShadeBlock& block() const { return block_; }

 private:
  gl::Buffer buffer_;
  effects::ShadeBlock block_{};
};

/// What other passes found out, per pixel; those that are not valid take no part.
struct LightRefs {
  TextureRef visibility;  ///< share of the key light that arrives (shadow.h)
  TextureRef occlusion;   ///< what is hidden of the sky, and the sky (occlusion.h)
  TextureRef difference;  ///< in depth from the surroundings (depth_unsharp.h)
  TextureRef labels;      ///< over everything, and how much they cover (labels.h)
  TextureRef lines;       ///< share of the pixel that is line (silhouette.h)
  TextureRef traced;      ///< light of mirrors and glass, and the share left of the rest (traced_light.h)
};

/// Adds the pass; it draws into `target`.
void addShade(FrameGraph& graph, const ShadeSettings& settings, const ShadeUniforms& uniforms,
              ShaderLibrary& shaders, const GBufferRefs& gbuffer, const LightRefs& light, TextureRef target);

/// Where light goes that the processor computes: to a sum of samples or, as the only one, to the picture.
struct ProcessorShadeTarget {
  effects::LightSum* sum = nullptr;
  int sample = 0;
  std::optional<effects::PictureRows> picture = {};
};

/// Adds the same by the processor (core/effects/shading.h). Returns what to want.
TextureRef addProcessorShade(FrameGraph& graph, const ShadeUniforms& uniforms, SurfaceReader& reader,
                             const GBufferRefs& gbuffer, const LightRefs& light,
                             const ProcessorShadeTarget& target);

/// Background as the shaders take it: premultiplied linear light, transparent = all zero.
glm::vec4 backdrop(const Background& background);

}  // namespace meniscus

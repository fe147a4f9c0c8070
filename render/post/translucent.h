#pragma once
// Translucent surfaces over what is opaque.

#include "render/post/shade.h"
#include "render/surface_method.h"

namespace meniscus {

/// Lays `layers` over `light`, what addShade() wrote without `settings.final`, and writes or adds the result
/// to `target` as addShade() does. Layers are lit as if nothing stood between them and the light. `labels`,
/// if valid, go over everything.
void addTranslucent(FrameGraph& graph, const ShadeSettings& settings, const ShadeUniforms& uniforms,
                    ShaderLibrary& shaders, const SurfaceLayerRefs& layers, TextureRef light,
                    TextureRef labels, TextureRef target);

}  // namespace meniscus

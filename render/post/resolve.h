#pragma once
// The mean of several samples per pixel.

#include <glm/vec4.hpp>

#include "render/frame_graph.h"
#include "render/shader_library.h"

namespace meniscus {

struct ResolveSettings {
  int samples = 1;
  glm::vec4 backdrop{0.0f};  ///< premultiplied linear light
  bool encodeSrgb = false;
};

/// Adds the pass: `target` becomes the mean of the `sum` of premultiplied linear samples, over the backdrop.
void addResolve(FrameGraph& graph, const ResolveSettings& settings, ShaderLibrary& shaders, TextureRef sum,
                TextureRef target);

}  // namespace meniscus

#pragma once
// Colours in linear light, as shaders take them.

#include <glm/vec4.hpp>

#include "core/scene.h"
#include "core/srgb.h"

namespace meniscus {

/// With an alpha, by which it is not multiplied.
inline glm::vec4 linearColor(Rgb color, double alpha) {
  const auto channel = [&](int shift) { return linearOfBytes()[color >> shift & 0xFFu]; };
  return glm::vec4(glm::dvec4(channel(16), channel(8), channel(0), alpha));
}

}  // namespace meniscus

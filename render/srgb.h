#pragma once
// From sRGB (IEC 61966-2-1) to linear light.

#include <cmath>
#include <glm/vec4.hpp>

#include "core/scene.h"

namespace meniscus {

/// Both from 0 to 1.
inline double linearFromSrgb(double c) {
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

/// With an alpha, by which it is not multiplied.
inline glm::vec4 linearColor(Rgb color, double alpha) {
  const auto channel = [&](int shift) { return linearFromSrgb(((color >> shift) & 0xFF) / 255.0); };
  return glm::vec4(glm::dvec4(channel(16), channel(8), channel(0), alpha));
}

}  // namespace meniscus

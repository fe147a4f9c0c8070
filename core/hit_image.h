#pragma once
// What a view meets, pixel by pixel; it does not say who found out.

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/image.h"

namespace meniscus {

/// Rows from the bottom, as pixel coordinates (core/view.h). Channels nobody asked for are empty.
struct HitImage {
  ImageSize size;
  std::vector<float> distance;    ///< along the unit ray from its origin [Å]; +infinity = miss
  std::vector<glm::vec3> normal;  ///< unit, view space, towards the viewer; zero = miss
  std::vector<std::uint32_t> id;  ///< 0 = miss
};

}  // namespace meniscus

#pragma once
// What the tests of formulas in float32 have in common.

#include <glm/vec3.hpp>

namespace meniscus::test {

inline constexpr double kEpsilon = 0x1p-24;  ///< of float32
inline constexpr glm::dvec3 kOrigin(12.25, -400.5, 77.0);

}  // namespace meniscus::test

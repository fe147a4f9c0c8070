#pragma once
// A turn and then a shift, in double precision.

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace meniscus {

struct RigidMotion {
  glm::dmat3 turn{1.0};   ///< orthonormal; may mirror
  glm::dvec3 shift{0.0};  ///< [Å]
  glm::dvec3 operator()(const glm::dvec3& p) const { return turn * p + shift; }
};

}  // namespace meniscus

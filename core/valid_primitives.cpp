#include "core/valid_primitives.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"

namespace meniscus {

namespace {

// Not finite times zero is not a number, and stays that in a sum.
float zeroIfFinite(const glm::vec3& v) {
  return v.x * 0.0f + v.y * 0.0f + v.z * 0.0f;
}

void require(float zero, const char* kind, std::uint32_t id) {
  if (zero != 0.0f)
    throw InputError(fmt::format("the {} of atom {} has a number that is not finite", kind, id));
}

void requireFiniteQuadrics(const Quadrics& quadrics) {
  for (const SpherePrimitive& s : quadrics.spheres)
    require(zeroIfFinite(s.center) + s.radius * 0.0f, "sphere", s.id);
  for (const CylinderPrimitive& c : quadrics.cylinders)
    require(zeroIfFinite(c.a) + zeroIfFinite(c.b) + c.radius * 0.0f, "bond", c.idA);
  for (const EllipsoidPrimitive& e : quadrics.ellipsoids)
    require(zeroIfFinite(e.center) + zeroIfFinite(e.axisA) + zeroIfFinite(e.axisB) + e.shortest * 0.0f,
            "ellipsoid", e.id);
}

}  // namespace

void requireFinite(const Primitives& primitives) {
  requireFiniteQuadrics(primitives);
  for (const QuadricUnit& unit : primitives.units) {
    requireFiniteQuadrics(unit);
    for (const QuadricCopy& copy : unit.copies) {
      double zero = 0;
      for (int column = 0; column < 3; ++column) {
        zero += copy.motion.shift[column] * 0;
        for (int row = 0; row < 3; ++row) zero += copy.motion.turn[column][row] * 0;
      }
      if (zero != 0) throw InputError("the place of a copy has a number that is not finite");
    }
  }
  for (const TriangleVertex& v : primitives.mesh.vertices)
    if (zeroIfFinite(v.position) + zeroIfFinite(v.normal) != 0.0f)
      throw InputError("a ribbon has a number that is not finite");
}

}  // namespace meniscus

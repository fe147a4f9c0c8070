#pragma once
// Metaballs along a ray in long double, written straight from the definition, and small views of them.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/metaball_field.h"
#include "tests/support/exact_rays.h"
#include "tests/support/random.h"

namespace meniscus::test {

inline Real exactKernel(const Kernel& kernel, Real w) {
  if (!(w > 0)) return 0;
  if (kernel.shape == KernelShape::sextic) return w * w * (5 + 4 * w) / 9;
  Real power = 1;
  for (int i = 0; i < (kernel.shape == KernelShape::quartic ? 2 : kernel.exponent); ++i) power *= w;
  return power;
}

/// F along one ray.
class ExactField {
 public:
  ExactField(const MetaballField& field, const glm::dvec3& origin, const View& view, glm::dvec2 pixel)
      : field_(field), ray_(exactRay(view, pixel)) {
    for (const Metaball& ball : field.balls) {
      const Vec3 center = exactViewPoint(view, origin, ball.center);
      const auto chord = exactSphere(ray_, center, Real(ball.support));
      if (!chord) continue;
      const Vec3 toCenter = center - ray_.origin;
      const Real middle = glm::dot(toCenter, ray_.direction);
      const Vec3 aside = toCenter - middle * ray_.direction;
      const Real square = Real(ball.support) * Real(ball.support);
      terms_.push_back({Real(ball.coefficient), middle, 1 - glm::dot(aside, aside) / square, square});
      first = std::min(first, chord->in);
      last = std::max(last, chord->out);
    }
  }

  Real operator()(Real t) const {
    Real sum = -Real(field_.level);
    for (const Term& term : terms_) {
      const Real x = t - term.middle;
      sum += term.coefficient * exactKernel(field_.kernel, term.most - x * x / term.square);
    }
    return sum;
  }

  Real first = 1e30L, last = -1e30L;  ///< of the supports that the ray meets

 private:
  struct Term {
    Real coefficient, middle, most, square;
  };
  const MetaballField& field_;
  ExactRay ray_;
  std::vector<Term> terms_;
};

/// Where `f` changes sign between two places, in either order.
template <class Function>
Real bisected(const Function& f, Real low, Real high) {
  const bool sign = f(low) > 0;
  for (int i = 0; i < 200; ++i) {
    const Real middle = low + (high - low) / 2;
    if (middle == low || middle == high) break;
    ((f(middle) > 0) == sign ? low : high) = middle;
  }
  return low + (high - low) / 2;
}

/// Orthographic, along -z, a pixel centre at (x, y) [Å] in view space, the near plane at `nearZ`.
inline View alongZ(double x, double y, double nearZ, double pixelSize = 0.01) {
  View view;
  view.projection = Projection::orthographic;
  view.size = {1, 1};
  view.pixelSize = pixelSize;
  view.center = glm::dvec2(0.5) - glm::dvec2(x, y) / pixelSize;
  view.nearZ = nearZ;
  view.farZ = -nearZ;
  return view;
}

/// Looks at a ball of `radius` Å about the world's `target`; perspective from three radii or orthographic.
inline View viewOfBall(Projection projection, ImageSize size, const glm::dvec3& target, double radius) {
  Camera camera;
  camera.projection = projection;
  camera.target = target;
  camera.orientation = glm::normalize(glm::dquat(0.8, 0.3, -0.5, 0.1));
  camera.distance = 3 * radius;
  camera.fovY = 2 * std::atan(1.1 / 3);
  return makeView(camera, size, {target, radius});
}

/// `count` balls of supports 1.5 to 4 Å within `half` Å; every `hollow`-th is negative (0: none).
inline MetaballField randomField(const Kernel& kernel, double level, int count, double half, int hollow,
                                 unsigned seed) {
  Random random(seed);
  MetaballField field;
  field.kernel = kernel;
  field.level = level;
  for (int i = 0; i < count; ++i) {
    const bool negative = hollow > 0 && i % hollow == hollow - 1;
    const double q = random.uniform(0.5, 1.5) * (negative ? -1 : 1);
    field.balls.push_back({glm::vec3(random.inBox(half)), static_cast<float>(random.uniform(1.5, 4)),
                           static_cast<float>(q), 0, static_cast<std::uint32_t>(i + 1)});
  }
  return field;
}

}  // namespace meniscus::test

#include "core/metaball_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "core/error.h"

namespace meniscus {

double kernelValue(const Kernel& kernel, double w) {
  if (!(w > 0)) return 0;
  switch (kernel.shape) {
    case KernelShape::sextic:
      return w * w * (5 + 4 * w) / 9;
    case KernelShape::quartic:
      return w * w;
    case KernelShape::power:
      return std::pow(w, kernel.exponent);
  }
  return 0;
}

double kernelSlope(const Kernel& kernel, double w) {
  if (!(w > 0)) return 0;
  switch (kernel.shape) {
    case KernelShape::sextic:
      return w * (10 + 12 * w) / 9;
    case KernelShape::quartic:
      return 2 * w;
    case KernelShape::power:
      return kernel.exponent * std::pow(w, kernel.exponent - 1);
  }
  return 0;
}

double kernelInverse(const Kernel& kernel, double value) {
  const double v = std::clamp(value, 0.0, 1.0);
  if (kernel.shape == KernelShape::quartic) return std::sqrt(v);
  if (kernel.shape == KernelShape::power) return std::pow(v, 1.0 / kernel.exponent);
  // Convex and increasing: Newton from above converges. f(w) >= 5/9 w^2.
  double w = std::min(std::sqrt(v * 9 / 5), 1.0);
  for (int i = 0; i < 60 && w > 0; ++i) {
    const double next = w - (kernelValue(kernel, w) - v) / kernelSlope(kernel, w);
    if (!(next < w)) break;
    w = std::max(next, 0.0);
  }
  return w;
}

int kernelDegree(const Kernel& kernel) {
  switch (kernel.shape) {
    case KernelShape::sextic:
      return 6;
    case KernelShape::quartic:
      return 4;
    case KernelShape::power:
      return 2 * kernel.exponent;
  }
  return 0;
}

bool MetaballField::allPositive() const {
  return std::all_of(balls.begin(), balls.end(), [](const Metaball& b) { return b.coefficient > 0; });
}

FieldBox supportBox(const MetaballField& field) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const Metaball& ball : field.balls) {
    low = glm::min(low, glm::dvec3(ball.center) - static_cast<double>(ball.support));
    high = glm::max(high, glm::dvec3(ball.center) + static_cast<double>(ball.support));
  }
  return {low, high};
}

double levelOfBlend(const Kernel& kernel, double blend) {
  return kernelValue(kernel, 1 - 1 / (blend * blend));
}

double coreShare(const Kernel& kernel, double level, double coefficient) {
  if (!(coefficient >= level)) return 0;
  return std::sqrt(std::max(1 - kernelInverse(kernel, level / coefficient), 0.0));
}

void requireValid(const MetaballField& field, const char* what) {
  const auto refuse = [&](const std::string& why) { throw InputError(fmt::format("{}: {}", what, why)); };
  if (!(std::isfinite(field.level) && field.level > 0))
    refuse(fmt::format("the level {} of the surface must be finite and positive", field.level));
  if (field.kernel.shape == KernelShape::power &&
      (field.kernel.exponent < kLeastKernelExponent || field.kernel.exponent > kMostKernelExponent))
    refuse(fmt::format("the kernel's exponent {} must be from {} to {}", field.kernel.exponent,
                       kLeastKernelExponent, kMostKernelExponent));
  for (const Metaball& ball : field.balls) {
    const bool finite = std::isfinite(ball.center.x) && std::isfinite(ball.center.y) &&
                        std::isfinite(ball.center.z) && std::isfinite(ball.support) &&
                        std::isfinite(ball.coefficient);
    if (!finite) refuse(fmt::format("metaball of atom {} has a number that is not finite", ball.id));
    if (!(ball.support > 0))
      refuse(fmt::format("metaball of atom {} has a support of {} A; it must be positive", ball.id,
                         ball.support));
  }
}

}  // namespace meniscus

#pragma once
// A field at a point, in double precision, and what its surface is like there.

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "core/metaball_field.h"

namespace meniscus::mesh {

struct WideBall {
  glm::dvec3 center;
  double support2, inverse2;  ///< R^2 and 1/R^2
  double coefficient;
  std::uint32_t color, id;
};

/// kernelValue() where it is called a hundred million times; w >= 0.
inline double fastKernel(const Kernel& kernel, double w) {
  if (kernel.shape == KernelShape::sextic) return w * w * (5 + 4 * w) * (1.0 / 9);
  double product = w * w;
  if (kernel.shape == KernelShape::power)
    for (int i = 2; i < kernel.exponent; ++i) product *= w;
  return product;
}

/// F at a point from the balls of `list` (indices into `balls`).
inline double fieldAt(const MetaballField& field, std::span<const WideBall> balls,
                      std::span<const std::uint32_t> list, const glm::dvec3& at) {
  double sum = -field.level;
  for (const std::uint32_t i : list) {
    const glm::dvec3 v = at - balls[i].center;
    const double w = std::max(1 - glm::dot(v, v) * balls[i].inverse2, 0.0);
    sum += balls[i].coefficient * fastKernel(field.kernel, w);
  }
  return sum;
}

struct SurfacePoint {
  glm::dvec3 outward{0.0};  ///< -grad F, not normalized
  std::uint32_t color = 0, id = 0;
};

/// As shaders/include/field.glsl: colours are blended by the squares of what is stored, weighted by positive
/// shares; of equal shares the ball of the smaller id counts.
inline SurfacePoint surfaceAt(const MetaballField& field, std::span<const WideBall> balls,
                              std::span<const std::uint32_t> list, const glm::dvec3& at) {
  SurfacePoint s;
  glm::dvec3 squares(0.0);
  double weight = 0, most = 0;
  for (const std::uint32_t i : list) {
    const WideBall& ball = balls[i];
    const glm::dvec3 v = at - ball.center;
    const double w = 1 - glm::dot(v, v) * ball.inverse2;
    if (!(w > 0)) continue;
    s.outward += 2 * ball.coefficient * kernelSlope(field.kernel, w) * ball.inverse2 * v;
    const double share = ball.coefficient * fastKernel(field.kernel, w);
    if (share > most || s.id == 0 || (share == most && ball.id < s.id)) {
      s.color = ball.color;
      s.id = ball.id;
    }
    if (!(share > 0)) continue;
    most = std::max(most, share);
    weight += share;
    const glm::dvec3 bytes(ball.color >> 16 & 255u, ball.color >> 8 & 255u, ball.color & 255u);
    squares += share * bytes * bytes;
  }
  if (weight > 0) {
    const auto byte = [&](double square) {
      return static_cast<std::uint32_t>(std::min(std::sqrt(square / weight), 255.0) + 0.5);
    };
    s.color = byte(squares.x) << 16 | byte(squares.y) << 8 | byte(squares.z);
  }
  return s;
}

}  // namespace meniscus::mesh

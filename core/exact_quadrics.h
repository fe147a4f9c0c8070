#pragma once
// Rays against spheres, capped cylinders and ellipsoids in long double, written straight from the definitions
// and sharing nothing with shaders/shared/: the truth for quadrics (core/quadric_tracer.h).

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "core/primitives.h"
#include "core/view.h"

namespace meniscus::exact {

using Real = long double;
using Vec3 = glm::vec<3, Real, glm::defaultp>;

struct ExactRay {
  Vec3 origin, direction;  // direction: unit
};

/// The ray of rayThrough(), in extended precision.
inline ExactRay exactRay(const View& view, glm::dvec2 pixel) {
  const Real x = (Real(pixel.x) - Real(view.center.x)) * Real(view.pixelSize);
  const Real y = (Real(pixel.y) - Real(view.center.y)) * Real(view.pixelSize);
  if (view.projection == Projection::orthographic) return {{x, y, Real(view.nearZ)}, {0, 0, -1}};
  return {{0, 0, Real(view.distance)}, glm::normalize(Vec3(x, y, -1))};
}

/// View-space position of a point given relative to the primitives' origin.
inline Vec3 exactViewPoint(const View& view, const glm::dvec3& origin, const glm::vec3& point) {
  const Vec3 offset = Vec3(origin) - Vec3(view.pivot) + Vec3(point);
  Vec3 out(0);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) out[row] += Real(view.rotation[column][row]) * offset[column];
  }
  return out;
}

/// A direction in view space.
inline Vec3 exactViewDirection(const View& view, const glm::vec3& direction) {
  Vec3 out(0);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      out[row] += Real(view.rotation[column][row]) * Real(direction[column]);
  }
  return out;
}

/// Parameters at which a ray enters and leaves a convex solid.
struct ExactChord {
  Real in, out;
};

inline std::optional<ExactChord> exactSphere(const ExactRay& ray, const Vec3& center, Real radius) {
  const Vec3 toCenter = center - ray.origin;
  const Real along = glm::dot(toCenter, ray.direction);
  const Vec3 nearest = toCenter - along * ray.direction;
  const Real square = radius * radius - glm::dot(nearest, nearest);
  if (square < 0) return std::nullopt;
  return ExactChord{along - std::sqrt(square), along + std::sqrt(square)};
}

inline std::optional<ExactChord> exactCylinder(const ExactRay& ray, const Vec3& a, const Vec3& b,
                                               Real radius) {
  const Vec3 axis = glm::normalize(b - a);
  const Vec3 offset = ray.origin - a;
  const Vec3 side = offset - glm::dot(offset, axis) * axis;
  const Vec3 slope = ray.direction - glm::dot(ray.direction, axis) * axis;
  const Real q2 = glm::dot(slope, slope), q1 = glm::dot(side, slope),
             q0 = glm::dot(side, side) - radius * radius;
  const Real huge = 1e30L;
  ExactChord chord{-huge, huge};
  if (q2 > 1e-30L) {
    const Real square = q1 * q1 - q2 * q0;
    if (square < 0) return std::nullopt;
    chord = {(-q1 - std::sqrt(square)) / q2, (-q1 + std::sqrt(square)) / q2};
  } else if (q0 > 0) {
    return std::nullopt;
  }
  const Real climb = glm::dot(ray.direction, axis), height = glm::dot(offset, axis),
             length = glm::length(b - a);
  if (std::abs(climb) > 1e-25L) {
    const Real t0 = -height / climb, t1 = (length - height) / climb;
    chord.in = std::max(chord.in, std::min(t0, t1));
    chord.out = std::min(chord.out, std::max(t0, t1));
  } else if (height < 0 || height > length) {
    return std::nullopt;
  }
  if (chord.in > chord.out) return std::nullopt;
  return chord;
}

/// An ellipsoid by its unit axes and half lengths.
struct ExactEllipsoid {
  Vec3 center, axes[3], radii;

  Vec3 local(const Vec3& v) const {
    return {glm::dot(v, axes[0]), glm::dot(v, axes[1]), glm::dot(v, axes[2])};
  }
};

/// In view space; the axes as stored are perpendicular to float32's precision only.
inline ExactEllipsoid exactEllipsoid(const View& view, const glm::dvec3& origin,
                                     const EllipsoidPrimitive& e) {
  const Vec3 a = exactViewDirection(view, e.axisA), b = exactViewDirection(view, e.axisB);
  const Vec3 u = glm::normalize(a), w = glm::normalize(glm::cross(a, b));
  return {exactViewPoint(view, origin, e.center),
          {u, glm::cross(w, u), w},
          {glm::length(a), glm::length(b), Real(e.shortest)}};
}

inline std::optional<ExactChord> exactEllipsoidChord(const ExactRay& ray, const ExactEllipsoid& e) {
  const Real middle = glm::dot(e.center - ray.origin, ray.direction);
  const Vec3 from = e.local(ray.origin + middle * ray.direction - e.center) / e.radii;
  const Vec3 along = e.local(ray.direction) / e.radii;
  const Real q2 = glm::dot(along, along), q1 = glm::dot(from, along), q0 = glm::dot(from, from) - 1;
  const Real square = q1 * q1 - q2 * q0;
  if (!(square >= 0)) return std::nullopt;
  return ExactChord{middle + (-q1 - std::sqrt(square)) / q2, middle + (-q1 + std::sqrt(square)) / q2};
}

/// Distance of a point from an ellipsoid's surface, inside or outside: the nearest surface point is
/// radii^2 p / (radii^2 + t) for the one t > -shortest^2 that puts it on the surface.
inline Real ellipsoidDistance(const Vec3& point, const ExactEllipsoid& e) {
  const Vec3 p = e.local(point - e.center), squares = e.radii * e.radii;
  const Real shortest = std::min({e.radii.x, e.radii.y, e.radii.z});
  const auto foot = [&](Real t) { return squares * p / (squares + t); };
  const auto excess = [&](Real t) {
    const Vec3 q = foot(t) / e.radii;
    return glm::dot(q, q) - 1;
  };
  Real low = -shortest * shortest, high = glm::dot(p, p) + glm::dot(squares, squares) + shortest;
  while (excess(high) > 0) high *= 2;
  for (int i = 0; i < 200; ++i) {
    const Real t = (low + high) / 2;
    if (!(t > low && t < high)) break;
    (excess(t) > 0 ? low : high) = t;
  }
  return glm::length(foot(high) - p);
}

/// Signed distance of a point from a capped cylinder's surface, negative inside.
inline Real cylinderDistance(const Vec3& p, const Vec3& a, const Vec3& b, Real radius) {
  const Vec3 axis = glm::normalize(b - a);
  const Vec3 offset = p - a;
  const Real height = glm::dot(offset, axis);
  const Real side = glm::length(offset - height * axis) - radius;
  const Real cap = std::max(-height, height - glm::length(b - a));
  if (side <= 0 || cap <= 0) return std::max(side, cap);
  return std::hypot(side, cap);
}

}  // namespace meniscus::exact

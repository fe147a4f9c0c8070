// What Primitives hold when every copy of their units is counted: how many, how large, and each by itself.

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <limits>

#include "core/primitives.h"

namespace meniscus {

namespace {

// Calls f(point, reach) such that the balls about these points hold all quadrics.
template <typename F>
void forBalls(const Quadrics& quadrics, F f) {
  for (const SpherePrimitive& s : quadrics.spheres) f(s.center, s.radius);
  for (const CylinderPrimitive& c : quadrics.cylinders) {
    f(c.a, c.radius);
    f(c.b, c.radius);
  }
  for (const EllipsoidPrimitive& e : quadrics.ellipsoids) f(e.center, glm::length(e.axisA));
}

class ReachBox {
 public:
  void grow(const glm::vec3& p, float r) {
    low_ = glm::min(low_, p - r);
    high_ = glm::max(high_, p + r);
  }
  bool holds(const glm::vec3& p, float r) const {
    return glm::all(glm::lessThanEqual(low_, p - r)) && glm::all(glm::greaterThanEqual(high_, p + r));
  }
  glm::vec3 middle() const { return (low_ + high_) * 0.5f; }

 private:
  glm::vec3 low_{std::numeric_limits<float>::infinity()}, high_{-std::numeric_limits<float>::infinity()};
};

struct UnitBall {
  glm::vec3 center;
  float radius;
};

// Of a unit, a little larger, so that rounding brings nothing out of it in any copy.
UnitBall ballAroundUnit(const QuadricUnit& unit) {
  ReachBox box;
  forBalls(unit, [&](const glm::vec3& p, float r) { box.grow(p, r); });
  UnitBall ball{box.middle(), 0};
  forBalls(unit, [&](const glm::vec3& p, float r) {
    ball.radius = std::max(ball.radius, glm::distance(p, ball.center) + r);
  });
  ball.radius *= 1 + 1e-4f;
  return ball;
}

glm::vec3 placed(const QuadricCopy& copy, const glm::vec3& p) {
  return glm::vec3(copy.motion(glm::dvec3(p)));
}

// Calls f(point, reach) for the balls of all copies of units, but for copies that a ball says `without` to.
template <typename Without, typename F>
void forCopies(const Primitives& primitives, const std::vector<UnitBall>& balls, Without without, F f) {
  for (std::size_t i = 0; i < primitives.units.size(); ++i) {
    const QuadricUnit& unit = primitives.units[i];
    for (const QuadricCopy& copy : unit.copies) {
      const glm::vec3 center = placed(copy, balls[i].center);
      // As much as float32 may round the sums below.
      const float spare = 1e-6f * (std::abs(center.x) + std::abs(center.y) + std::abs(center.z));
      if (without(center, balls[i].radius + spare)) continue;
      forBalls(unit, [&](const glm::vec3& p, float r) { f(placed(copy, p), r); });
    }
  }
}

}  // namespace

QuadricCounts Primitives::counts() const {
  QuadricCounts sum{spheres.size(), cylinders.size(), ellipsoids.size()};
  for (const QuadricUnit& unit : units) {
    sum.spheres += unit.spheres.size() * unit.copies.size();
    sum.cylinders += unit.cylinders.size() * unit.copies.size();
    sum.ellipsoids += unit.ellipsoids.size() * unit.copies.size();
  }
  return sum;
}

std::uint64_t Primitives::quadricBytes() const {
  const auto bytesOf = [](const Quadrics& q) {
    return sizeof(SpherePrimitive) * q.spheres.capacity() +
           sizeof(CylinderPrimitive) * q.cylinders.capacity() +
           sizeof(EllipsoidPrimitive) * q.ellipsoids.capacity();
  };
  std::uint64_t sum = bytesOf(*this);
  for (const QuadricUnit& unit : units) sum += bytesOf(unit) + sizeof(QuadricCopy) * unit.copies.capacity();
  return sum;
}

double Primitives::thinnestRadius() const {
  if (!mesh.empty()) return 0;
  float least = std::numeric_limits<float>::infinity();
  const auto add = [&](const Quadrics& quadrics) {
    for (const SpherePrimitive& s : quadrics.spheres) least = std::min(least, s.radius);
    for (const CylinderPrimitive& c : quadrics.cylinders) least = std::min(least, c.radius);
    for (const EllipsoidPrimitive& e : quadrics.ellipsoids) least = std::min(least, e.shortest);
  };
  add(*this);
  for (const QuadricUnit& unit : units) add(unit);
  for (const MetaballField& field : surfaces)
    for (const Metaball& b : field.balls) least = std::min(least, 0.5f * b.support);
  return static_cast<double>(least);
}

BoundingSphere Primitives::bounds() const {
  if (empty()) return {origin, 0.0};
  std::vector<UnitBall> balls;
  for (const QuadricUnit& unit : units) balls.push_back(ballAroundUnit(unit));
  ReachBox box;
  const auto grow = [&](const glm::vec3& p, float r) { box.grow(p, r); };
  forBalls(*this, grow);
  for (const TriangleVertex& v : mesh.vertices) grow(v.position, 0);
  for (const MetaballField& field : surfaces)
    for (const Metaball& b : field.balls) grow(b.center, b.support);
  forCopies(
      *this, balls, [&](const glm::vec3& p, float r) { return box.holds(p, r); }, grow);
  const glm::vec3 middle = box.middle();
  float radius = 0;
  const auto reach = [&](const glm::vec3& p, float r) {
    radius = std::max(radius, glm::length(p - middle) + r);
  };
  forBalls(*this, reach);
  for (const TriangleVertex& v : mesh.vertices) reach(v.position, 0);
  for (const MetaballField& field : surfaces)
    for (const Metaball& b : field.balls) reach(b.center, b.support);
  forCopies(
      *this, balls, [&](const glm::vec3& p, float r) { return glm::length(p - middle) + r <= radius; },
      reach);
  return {origin + glm::dvec3(middle), static_cast<double>(radius)};
}

Primitives copiesApart(const Primitives& primitives) {
  Primitives out = primitives;
  out.units.clear();
  const QuadricCounts all = primitives.counts();
  out.spheres.reserve(all.spheres);
  out.cylinders.reserve(all.cylinders);
  out.ellipsoids.reserve(all.ellipsoids);
  for (const QuadricUnit& unit : primitives.units) {
    for (const QuadricCopy& copy : unit.copies) {
      const std::uint32_t shift = copy.idShift;
      const auto turned = [&](const glm::vec3& axis) {
        return glm::vec3(copy.motion.turn * glm::dvec3(axis));
      };
      for (const SpherePrimitive& s : unit.spheres)
        out.spheres.push_back({placed(copy, s.center), s.radius, s.color, s.id + shift});
      for (const CylinderPrimitive& c : unit.cylinders) {
        out.cylinders.push_back({placed(copy, c.a), c.radius, placed(copy, c.b), c.colorA, c.colorB,
                                 c.idA + shift, c.idB + shift});
      }
      for (const EllipsoidPrimitive& e : unit.ellipsoids) {
        out.ellipsoids.push_back(
            {placed(copy, e.center), e.shortest, turned(e.axisA), turned(e.axisB), e.color, e.id + shift});
      }
    }
  }
  return out;
}

}  // namespace meniscus

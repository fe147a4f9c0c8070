#pragma once
// Rays from anywhere against the spheres, cylinders, ellipsoids and triangles of a scene, through a tree over
// their boxes, in double precision.

#include "core/bvh/field_ray.h"
#include "core/bvh/field_tracer.h"
#include "core/primitives.h"

namespace meniscus::bvh {

inline constexpr std::uint32_t kNoSolid = 0xFFFFFFFFu;

struct SolidHit {
  double distance = kInfinity;
  glm::dvec3 point{0.0};   ///< on a triangle: on the smooth surface that the mesh stands for
  glm::dvec3 normal{0.0};  ///< unit, outward
  bool fromInside = false;
  std::uint32_t color = 0, id = 0;
  std::uint32_t solid = kNoSolid;  ///< spheres, cylinders, ellipsoids, triangles are numbered through
  explicit operator bool() const { return distance < kInfinity; }
};

class SolidTracer {
 public:
  /// `primitives` must outlive it. What is no solid (a radius that is not positive) is left out.
  explicit SolidTracer(const Primitives& primitives);

  /// What the ray enters first at or after `from`, or, if it begins inside, the wall that it leaves by.
  /// `except`: the solid on whose surface the ray begins, outward: it is convex, and is not met again.
  SolidHit cast(const FieldRay& ray, std::uint32_t except, TraceCounts& counts) const;
  /// How far away the first of them is, no more.
  double distance(const FieldRay& ray, std::uint32_t except, TraceCounts& counts) const;
  /// Whether there is one: any.
  bool blocked(const FieldRay& ray, std::uint32_t except, TraceCounts& counts) const;

 private:
  struct Found {
    double distance = kInfinity;
    glm::dvec3 normal{0.0};
    bool fromInside = false;
  };
  double distance(const FieldRay& ray, std::uint32_t except, bool any, TraceCounts& counts) const;
  Found meet(std::uint32_t solid, const FieldRay& ray) const;
  Found meetTriangle(const TriangleCorners& corners, const FieldRay& ray) const;
  void describe(const FieldRay& ray, SolidHit& hit) const;
  void describeTriangle(const TriangleCorners& corners, SolidHit& hit) const;

  const Primitives& primitives_;
  std::uint32_t cylinders_, ellipsoids_, triangles_;  ///< the first of each
  std::vector<std::uint32_t> solids_;                 ///< of the tree's members
  Tree tree_;
};

}  // namespace meniscus::bvh

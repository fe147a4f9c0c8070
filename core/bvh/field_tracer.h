#pragma once
// Rays from anywhere against a field of metaballs, through a tree (core/bvh/field_tree.h), in double
// precision: primary and secondary rays, on the processor.

#include <optional>

#include "core/bvh/field_ray.h"
#include "core/bvh/field_tree.h"
#include "core/mesh/field_sum.h"

namespace meniscus::bvh {

enum class Search : std::uint8_t {
  guaranteed,  ///< firstCrossing()
  paper        ///< firstProjection()
};

/// Of all rays together: Gourmel et al. 2010, Table 3, and what roots cost.
struct TraceCounts {
  std::uint64_t rays = 0;
  std::uint64_t nodes = 0;   ///< whose boxes were met
  std::uint64_t leaves = 0;  ///< that were searched
  std::uint64_t balls = 0;   ///< in them
  RayEffort effort;
  void add(const TraceCounts& other);
};

struct FieldHit {
  double distance = kInfinity;  ///< from the ray's origin [Å]; infinite: none
  bool fromInside = false;
  std::uint32_t leaf = 0;  ///< of the tree's nodes, whose members are all that counts there
  explicit operator bool() const { return distance < kInfinity; }
};

class FieldTracer {
 public:
  /// Both must outlive it; the tree is the field's.
  FieldTracer(const MetaballField& field, const FieldTree& tree, Search search = Search::guaranteed);

  /// The first point on the ray at which the field changes its sign.
  FieldHit cast(const FieldRay& ray, RayScratch& scratch, TraceCounts& counts) const;
  /// Whether there is one: any.
  bool blocked(const FieldRay& ray, RayScratch& scratch, TraceCounts& counts) const;
  /// Whether F > 0.
  bool inside(const glm::dvec3& point, RayScratch& scratch) const;
  /// What the surface is like at a hit, which lies at `point`.
  mesh::SurfacePoint surfaceAt(const FieldHit& hit, const glm::dvec3& point, RayScratch& scratch) const;

 private:
  FieldHit cast(const FieldRay& ray, bool any, RayScratch& scratch, TraceCounts& counts) const;
  FieldHit castGathered(const FieldRay& ray, bool inside, RayScratch& scratch, TraceCounts& counts) const;
  void addChord(const FieldRay& ray, std::uint32_t ball, bool own, double from, double to,
                RayScratch& scratch) const;
  double search(const Stretch& stretch, RayScratch& scratch, TraceCounts& counts) const;

  const MetaballField& field_;
  const FieldTree& tree_;
  Search search_;
  std::vector<mesh::WideBall> balls_;
};

}  // namespace meniscus::bvh

#pragma once
// Spheres, cylinders and ellipsoids as the tile lists and the quadric caster take them.

#include <vector>

#include "core/primitives.h"
#include "core/tiles/tile_lists.h"
#include "core/tiles/tile_projection.h"

namespace meniscus::tiles {

enum class QuadricKind : std::uint32_t { sphere, cylinder, ellipsoid };

/// A primitive as seen from a view. Rays are given relative to its centre: in the plane across the view
/// through it they pass at perPixel * (pixel - projected centre), or they start at the eye.
struct QuadricRecord {
  double pixelX, pixelY;            ///< projected centre, pixels of the whole picture
  float perPixel;                   ///< [Å] in the centre's plane
  float centerX, centerY, centerZ;  ///< view space
  float eyeAbove;                   ///< z of the eye above the centre
  float radius;                     ///< sphere, cylinder
  float lowY, highY;                ///< no ray farther from pixelY meets it [pixels]; rounding included
  float front;                      ///< largest z of its points in view space; rounding included
  float rangeHi, rangeLo;           ///< distance of the centre along its ray
  QuadricKind kind;
  std::uint32_t fromEye;               ///< take the rays from the eye
  std::uint32_t meetsNear;             ///< its front may lie before the near plane
  std::uint32_t albedo[2], id[2];      ///< a cylinder's halves; else the first counts
  float axisU[3], axisV[3], axisW[3];  ///< cylinder: its axis is u, its half length radii[0]
  float radii[3];
};

/// Groups of neighbouring quadrics: a set for each call of forSets().
Clusters clustersOf(const Primitives& primitives);

/// Calls f(quadrics, copies) for those in one place, if there are any, and for each unit that is not empty.
template <typename F>
void forSets(const Primitives& primitives, F f) {
  static const QuadricCopy kOnce{};
  if (primitives.quadricCount() > 0) f(primitives, std::span<const QuadricCopy>(&kOnce, 1));
  for (const QuadricUnit& unit : primitives.units)
    if (unit.quadricCount() > 0) f(unit, std::span<const QuadricCopy>(unit.copies));
}

/// Quadrics in one place, and units in each of theirs, are numbered through: set after set, copy after copy.
class QuadricSource : public TileSource {
 public:
  /// Both must outlive it.
  QuadricSource(const Primitives& primitives, const TileTarget& target);

  std::size_t size() const override { return size_; }
  Placement place(std::size_t index) const override;
  void prefetch(std::size_t index) const override;
  bool isBall(std::size_t index) const override;
  Placement placeBall(const RigidMotion& motion, const glm::vec3& center, float radius) const override {
    return projection_.placeSphere(motion(center), static_cast<double>(radius));
  }
  void placeBalls(const RigidMotion& motion, const Cluster& cluster, std::span<const Clusters::Ball> balls,
                  Placement* out) const override {
    projection_.placeBalls(motion, cluster, balls, out);
  }
  Occluder occluder(std::size_t index) const override;
  void record(std::size_t index, QuadricRecord& out) const;

 private:
  struct Set {
    const Quadrics* quadrics;
    std::span<const QuadricCopy> copies;
    std::size_t first;  // number of its first quadric
  };
  // A quadric in one of its places; one of the pointers is set.
  struct Placed {
    const SpherePrimitive* sphere = nullptr;
    const CylinderPrimitive* cylinder = nullptr;
    const EllipsoidPrimitive* ellipsoid = nullptr;
    const QuadricCopy* copy;
  };
  Placed at(std::size_t index) const;
  const Set& setOf(std::size_t index) const;

  std::vector<Set> sets_;
  std::size_t size_ = 0;
  TileProjection projection_;
};

}  // namespace meniscus::tiles

#pragma once
// A metaball field as the tile lists and the field caster take it.

#include <hwy/cache_control.h>

#include <span>
#include <vector>

#include "core/metaball_field.h"
#include "core/tiles/tile_lists.h"
#include "core/tiles/tile_projection.h"

namespace meniscus::tiles {

/// A ball as seen from a view; rays as in QuadricRecord.
struct BallRecord {
  double pixelX, pixelY;            ///< projected centre, pixels of the whole picture
  double centerZ;                   ///< view space
  float perPixel;                   ///< [Å] in the centre's plane
  float centerX, centerY;           ///< view space
  float eyeAbove;                   ///< z of the eye above the centre
  float support2, inverseSupport2;  ///< R^2, 1 / R^2
  float core2;                      ///< squared radius of the core in which it alone reaches the level
  float coefficient;                ///< q
  float front;                      ///< largest z of its support in view space
  std::uint32_t fromEye;            ///< take the rays from the eye
  float colorSquared[3];            ///< stored channels 0..1, squared
  std::uint32_t id;
};

/// Groups of neighbouring balls.
Clusters clustersOf(const MetaballField& field);

class MetaballSource : public TileSource {
 public:
  /// The field must outlive it.
  MetaballSource(const MetaballField& field, const TileTarget& target);

  std::size_t size() const override { return field_.balls.size(); }
  Placement place(std::size_t index) const override;
  void prefetch(std::size_t index) const override { hwy::Prefetch(&field_.balls[index]); }
  bool isBall(std::size_t) const override { return true; }
  Placement placeBall(const RigidMotion& motion, const glm::vec3& center, float radius) const override {
    return projection_.placeSphere(motion(center), static_cast<double>(radius));
  }
  void placeBalls(const RigidMotion& motion, const Cluster& cluster, std::span<const Clusters::Ball> balls,
                  Placement* out) const override {
    projection_.placeBalls(motion, cluster, balls, out);
  }
  /// Discs of the cores in which one ball alone reaches the level, if no ball takes anything away. They hide
  /// what lies behind from rays that begin outside of the surface.
  Occluder occluder(std::size_t index) const override;
  void record(std::size_t index, BallRecord& out) const;
  bool coresHide() const { return coresHide_; }
  double largestSupport() const { return largestSupport_; }

 private:
  double coreRadius(const Metaball& ball) const;

  const MetaballField& field_;
  TileProjection projection_;
  double largestSupport_ = 0;
  bool coresHide_;
  float lastCoefficient_ = 0;  // of the share below: most fields have one coefficient
  double lastShare_ = 0;
};

}  // namespace meniscus::tiles

#pragma once
// From a primitive to the tiles that it can touch. Double precision up to the pixel grid; what is handed to
// the casters is relative to a primitive's own centre or to a tile's own corner, so that float32 loses
// nothing however far away the camera stands (docs/methods.md, "Tiles").

#include <glm/mat3x3.hpp>

#include "core/shared_math.h"
#include "core/tiles/ball_placer.h"
#include "core/tiles/tile_lists.h"
#include "core/tiles/tile_target.h"

namespace meniscus::tiles {

struct ProjectedPoint {
  glm::dvec3 view;   ///< view space [Å]
  double depth;      ///< in front of the eye plane [Å]; 1 for orthographic views
  glm::dvec2 pixel;  ///< of the whole picture; meaningless where depth is not positive
};

class TileProjection {
 public:
  explicit TileProjection(const TileTarget& target);

  /// center: relative to Primitives::origin.
  ProjectedPoint project(const glm::dvec3& center) const;
  /// A direction in view space.
  glm::dvec3 turn(const glm::dvec3& v) const { return rotation_ * v; }
  /// Size of a pixel in the plane of a point [Å].
  double perPixel(const ProjectedPoint& p) const { return p.depth * pixelSize_; }
  /// Perspective: distance from the eye. Orthographic: distance behind the near plane.
  double range(const ProjectedPoint& p) const;
  /// As in shaders/shared/projection.glsl: the ray is better taken from the eye.
  bool nearEye(const ProjectedPoint& p, double radius) const { return perspective_ && p.depth < 2 * radius; }
  bool perspective() const { return perspective_; }
  double eyeZ() const { return distance_; }
  float nearZ() const { return nearZ_; }

  /// Tiles that a sphere may touch with any of their pixels' rays; front = -infinity if none.
  Placement placeSphere(const glm::dvec3& center, double radius) const;
  /// The same of the balls of a cluster that stands elsewhere, nearly as close.
  void placeBalls(const RigidMotion& motion, const Cluster& cluster, std::span<const Clusters::Ball> balls,
                  Placement* out) const;
  /// Bounds of a sphere's rows, relative to its projected centre [pixels]; untouched if it has none.
  void rowsOf(const ProjectedPoint& center, float radius, float& low, float& high) const;
  /// The same of a cylinder or capsule. along: from its one end to the other, in view space.
  void rowsOf(const ProjectedPoint& center, const glm::dvec3& along, double radius, float& low,
              float& high) const;
  /// axisA, axisB, axisC: semi-axes in world directions.
  Placement placeEllipsoid(const glm::dvec3& center, const glm::dvec3 (&axes)[3]) const;
  /// Both end discs of a cylinder.
  Placement placeCylinder(const glm::dvec3& a, const glm::dvec3& b, double radius) const;
  /// The largest disc across the view through a ball's centre, which every ray that meets it enters the ball
  /// before; none if the near plane cuts the ball.
  Occluder occluder(const glm::dvec3& center, double radius) const;

 private:
  // Bounds in pixels of the picture.
  struct Rectangle {
    float x0, y0, x1, y1;
    bool bounded;
  };
  Rectangle boundsOf(const ProjectedPoint& p, float radius, const f32::vec3& axesX, const f32::vec3& axesY,
                     const f32::vec3& axesZ) const;
  Placement placed(const Rectangle& r, double front, double back) const;

  glm::dmat3 rotation_;
  glm::dvec3 translation_;
  glm::dvec2 center_;
  double pixelSize_, distance_;
  bool perspective_;
  float nearZ_, farZ_;
  TileGrid grid_;
  f32::ViewBlock block_{};
  ClusterView cluster_;  // but for what differs from cluster to cluster
};

}  // namespace meniscus::tiles

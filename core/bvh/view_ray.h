#pragma once
// Rays of a picture in the axes and about the origin of its primitives: where secondary rays live.

#include <algorithm>
#include <glm/matrix.hpp>

#include "core/view.h"

namespace meniscus::bvh {

/// Of a picture's rays: rayThrough(), turned from view space.
class ViewRays {
 public:
  /// origin: Primitives::origin.
  ViewRays(const View& view, const glm::dvec3& origin)
      : view_(view), turn_(glm::transpose(view.rotation)), shift_(view.pivot - origin) {}

  struct PictureRay {
    glm::dvec3 origin, direction;
    double start;  ///< where it meets the near plane
  };
  PictureRay through(glm::dvec2 pixel) const {
    const Ray ray = rayThrough(view_, pixel);
    const double start = view_.projection == Projection::perspective
                             ? std::max((view_.distance - view_.nearZ) / -ray.direction.z, 0.0)
                             : 0.0;
    return {turn_ * ray.origin + shift_, turn_ * ray.direction, start};
  }
  /// Of a direction, to view space.
  glm::dvec3 toView(const glm::dvec3& v) const { return view_.rotation * v; }
  glm::dvec3 fromView(const glm::dvec3& v) const { return turn_ * v; }

 private:
  View view_;
  glm::dmat3 turn_;
  glm::dvec3 shift_;
};

}  // namespace meniscus::bvh

#include "core/view.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace meniscus {

namespace {

// The nearest that the near plane comes to the eye when the eye is inside the scene, as a share of the
// scene's radius: far below any feature; with a reversed float depth buffer a tiny near distance costs no
// precision.
constexpr double kNearestPlane = 1e-6;

}  // namespace

Ray rayThrough(const View& view, glm::dvec2 pixel) {
  const glm::dvec2 offset = (pixel - view.center) * view.pixelSize;
  if (view.projection == Projection::orthographic) return {{offset, view.nearZ}, {0, 0, -1}};
  return {{0, 0, view.distance}, glm::normalize(glm::dvec3(offset, -1.0))};
}

View makeView(const Camera& camera, ImageSize size, const BoundingSphere& bounds) {
  View view;
  view.projection = camera.projection;
  view.rotation = glm::mat3_cast(glm::normalize(camera.orientation));
  view.pivot = camera.target;
  view.distance = camera.distance;
  view.size = size;
  view.center = glm::dvec2(size.width, size.height) * 0.5;
  view.pixelSize = 2.0 * std::tan(camera.fovY * 0.5) / (size.height * camera.zoom);
  if (camera.projection == Projection::orthographic) view.pixelSize *= camera.distance;

  // A little more than the bounds, so that no rounding clips what touches them.
  const double middle = (view.rotation * (bounds.center - view.pivot)).z;
  const double half = bounds.radius * 1.0001 + camera.distance * 1e-6 + 1e-9;
  view.nearZ = middle + half;
  view.farZ = middle - half;
  if (view.projection == Projection::perspective) {
    view.nearZ = std::min(view.nearZ, view.distance - kNearestPlane * half);
    view.farZ = std::min(view.farZ, view.nearZ - half);
  }
  if (camera.nearest && camera.distance - *camera.nearest < view.nearZ) {
    view.nearZ = camera.distance - *camera.nearest;
    view.farZ = std::min(view.farZ, view.nearZ - 1e-3 * half);  // where everything lies before the plane
  }
  const double cut = camera.distance - camera.farthest.value_or(0);
  if (camera.farthest && cut > view.farZ) {
    view.farZ = cut;
    view.cutsFar = true;
    // Where everything lies behind the plane, or nearer than the other.
    const double room = camera.projection == Projection::perspective ? 0.5 * *camera.farthest : half;
    view.nearZ = std::max(view.nearZ, view.farZ + std::min(1e-3 * half, room));
  }
  return view;
}

}  // namespace meniscus

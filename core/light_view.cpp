#include "core/light_view.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace meniscus {

namespace {

// Rows: right, up, and towards the light, in the camera's axes. Any right will do; the one nearest to the
// camera's own keeps the map steady when the light moves a little.
glm::dmat3 lightAxes(const DirectionalLight& light) {
  const double length = glm::length(light.direction);
  const glm::dvec3 back = length > 0 ? -light.direction / length : glm::dvec3(0, 0, 1);
  const glm::dvec3 hint = std::abs(back.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 right = glm::normalize(hint - glm::dot(hint, back) * back);
  return glm::transpose(glm::dmat3(right, glm::cross(back, right), back));
}

struct Rectangle {
  glm::dvec2 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
  void add(const glm::dvec2& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
};

}  // namespace

double pixelFootprint(const View& view, const BoundingSphere& bounds) {
  if (view.projection == Projection::orthographic) return view.pixelSize;
  const double middle = (view.rotation * (bounds.center - view.pivot)).z;
  const double nearest = view.distance - (middle + bounds.radius);
  // From within, what is a tenth of the scene away counts as near.
  return view.pixelSize * std::max(nearest, 0.1 * bounds.radius);
}

double shadowTexelSize(double footprint, double penumbra, double thinnest) {
  constexpr double kTexelsOfPenumbra = 10, kTexelsOfRadius = 6;
  return std::max(footprint, std::min(penumbra / kTexelsOfPenumbra, thinnest / kTexelsOfRadius));
}

View makeLightView(const View& camera, const DirectionalLight& light, const BoundingSphere& bounds,
                   double texelSize, int maxSize, double margin) {
  const glm::dmat3 fromCamera = lightAxes(light);
  const glm::dvec3 center = camera.rotation * (bounds.center - camera.pivot);  // in the camera's axes

  // The part of the frustum that can hold anything, seen along the light, and the bounds themselves.
  Rectangle visible;
  for (const double z : {camera.nearZ, camera.farZ}) {
    const double scale =
        camera.pixelSize * (camera.projection == Projection::perspective ? camera.distance - z : 1.0);
    for (const double x : {0.0, static_cast<double>(camera.size.width)}) {
      for (const double y : {0.0, static_cast<double>(camera.size.height)}) {
        const glm::dvec3 corner((glm::dvec2(x, y) - camera.center) * scale, z);
        visible.add(glm::dvec2(fromCamera * (corner - center)));
      }
    }
  }
  const glm::dvec2 low = glm::max(visible.low, glm::dvec2(-bounds.radius)) - margin;
  const glm::dvec2 high =
      glm::max(glm::min(visible.high, glm::dvec2(bounds.radius)) + margin, low + texelSize);
  const glm::dvec2 extent = high - low;

  View view;
  view.projection = Projection::orthographic;
  view.rotation = fromCamera * camera.rotation;
  view.pivot = bounds.center;
  view.pixelSize = std::max(texelSize, std::max(extent.x, extent.y) / maxSize);
  view.size = {std::clamp(static_cast<int>(std::ceil(extent.x / view.pixelSize)), 1, maxSize),
               std::clamp(static_cast<int>(std::ceil(extent.y / view.pixelSize)), 1, maxSize)};
  view.center = -low / view.pixelSize;
  view.nearZ = bounds.radius * 1.0001 + 1e-9;
  view.farZ = -view.nearZ;
  return view;
}

}  // namespace meniscus

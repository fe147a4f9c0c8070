#include "app/scene/mvs_camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vector_relational.hpp>

#include "app/option_camera.h"
#include "app/scene/settings.h"

namespace meniscus {
namespace {

// A single atom does not fill the picture.
constexpr double kLeastFocus = 5;

/// World axes -> view axes of a viewer that looks along `direction`.
std::optional<glm::dquat> orientationOf(const glm::dvec3& direction, const glm::dvec3& up) {
  const double length = glm::length(direction);
  const glm::dvec3 across = glm::cross(direction, up);
  if (!(length > 0) || !(glm::length(across) > 1e-9 * length * glm::length(up))) return std::nullopt;
  const glm::dvec3 right = glm::normalize(across), back = -direction / length;
  const glm::dmat3 axes(right, glm::cross(back, right), back);
  return glm::normalize(glm::quat_cast(glm::transpose(axes)));
}

/// The eye's distance at which a sphere of this radius fills the picture's height.
double distanceFor(const RenderOptions& options, double radius) {
  const double half = 0.5 * glm::radians(options.fovYDeg);
  return radius / (options.orthographic ? std::tan(half) : std::sin(half));
}

}  // namespace

BoundingSphere boundsOf(const FitSpheres& spheres) {
  if (spheres.empty()) return {};
  glm::dvec3 low = spheres.front().center, high = low;
  const auto within = [&](const FitSphere& s) {
    return glm::all(glm::greaterThanEqual(s.center - s.radius, low)) &&
           glm::all(glm::lessThanEqual(s.center + s.radius, high));
  };
  spheres.forEach(within, [&](const FitSphere& s) {
    low = glm::min(low, s.center - s.radius);
    high = glm::max(high, s.center + s.radius);
  });
  BoundingSphere bounds{(low + high) * 0.5, 0};
  const auto reach = [&](const FitSphere& s) { return glm::length(s.center - bounds.center) + s.radius; };
  spheres.forEach([&](const FitSphere& s) { return reach(s) <= bounds.radius; },
                  [&](const FitSphere& s) { bounds.radius = std::max(bounds.radius, reach(s)); });
  return bounds;
}

void MvsCamera::readCamera(const MvsNode& node, std::vector<std::string>& unsupported) {
  if (reference_) unsupported.push_back(node.place().path() + ": a second camera; the first one is used");
  if (reference_) return;
  Reference reference{node.at("target").vector(), node.at("position").vector(), {0, 1, 0}, {}};
  if (const auto up = node.find("up")) reference.up = up->vector();
  if (const auto near = node.find("near")) reference.near = near->number();
  node.listOtherParameters({"target", "position", "up", "near"}, unsupported);
  if (!orientationOf(reference.target - reference.position, reference.up))
    node.place().fail("position and target must differ, and up must not be along their line");
  reference_ = reference;
  const std::optional<JsonPlace> exact = node.meniscus();
  if (!exact) return;
  static constexpr std::array<std::string_view, 5> kKeys{"orientation", "target", "distance", "near", "far"};
  settingsOf(*exact, SettingPlace::picture, kKeys);
  Camera camera;
  const std::vector<double> q = exact->at("orientation").numbers(4);
  camera.orientation = glm::dquat(q[0], q[1], q[2], q[3]);
  if (!(std::abs(glm::length(camera.orientation) - 1) < 1e-6))
    exact->at("orientation").fail("is no unit quaternion W, X, Y, Z");
  camera.target = exact->at("target").vector();
  camera.distance = exact->at("distance").number();
  if (!(camera.distance > 0)) exact->at("distance").fail("must be positive");
  if (const auto nearest = exact->find("near")) {
    camera.nearest = nearest->number();
    if (!(*camera.nearest >= 0)) nearest->fail("must not be negative");
  }
  if (const auto farthest = exact->find("far")) {
    camera.farthest = farthest->number();
    if (!(*camera.farthest > camera.nearest.value_or(0)))
      farthest->fail("must be more than near, and positive");
  }
  exact_ = camera;
}

void MvsCamera::readFocus(const MvsNode& node, const FitSpheres& spheres,
                          std::vector<std::string>& unsupported) {
  node.listOtherParameters({"direction", "up", "radius", "radius_factor", "radius_extent"}, unsupported);
  glm::dvec3 direction(0, 0, -1), up(0, 1, 0);
  if (const auto given = node.find("direction")) direction = given->vector();
  if (const auto given = node.find("up")) up = given->vector();
  const std::optional<glm::dquat> orientation = orientationOf(direction, up);
  if (!orientation) node.place().fail("direction must not be zero or along up");
  if (spheres.empty()) {
    unsupported.push_back(node.place().path() + ": there are no atoms to look at");
    return;
  }
  BoundingSphere sphere = boundsOf(spheres);
  double factor = 1, extent = 0;
  if (const auto given = node.find("radius_factor")) factor = given->number();
  if (const auto given = node.find("radius_extent")) extent = given->number();
  sphere.radius = std::max(sphere.radius * factor + extent, kLeastFocus);
  if (const auto given = node.find("radius")) {
    sphere.radius = given->number();
    if (!(sphere.radius > 0)) given->fail("must be positive");
  }
  focused_.push_back(sphere);
  focusOrientation_ = *orientation;
}

Camera MvsCamera::camera(const RenderOptions& options, const FitSpheres& all) const {
  Camera camera = ownCamera(options, all);
  if (options.orientation.kind == Orientation::Kind::axis)
    camera.orientation = lookDownAxis(options.orientation.axis);
  if (options.orientation.kind == Orientation::Kind::quaternion)
    camera.orientation = options.orientation.quaternion;
  return withViewpoint(camera, options);
}

Camera MvsCamera::ownCamera(const RenderOptions& options, const FitSpheres& all) const {
  Camera camera = lensOf(options);
  if (exact_) {
    camera.orientation = exact_->orientation;
    camera.target = exact_->target;
    camera.distance = exact_->distance;
    camera.nearest = exact_->nearest;
    camera.farthest = exact_->farthest;
    return camera;
  }
  if (reference_) {
    const glm::dvec3 along = reference_->target - reference_->position;
    const double length = glm::length(along);
    camera.orientation = *orientationOf(along, reference_->up);
    camera.target = reference_->target;
    // The reference camera of 60 degrees holds a sphere of half its distance.
    camera.distance = distanceFor(options, 0.5 * length);
    if (reference_->near) camera.nearest = camera.distance - (length - *reference_->near);
    return camera;
  }
  if (focused_.empty()) return fitted(camera, options.size, all);
  std::vector<FitSphere> spheres;
  for (const BoundingSphere& sphere : focused_) spheres.push_back({sphere.center, sphere.radius});
  const BoundingSphere bounds = spheres.size() == 1 ? focused_.front() : boundsOf(spheres);
  camera.orientation = focusOrientation_;
  camera.target = bounds.center;
  const double tall = static_cast<double>(options.size.height) / options.size.width;
  camera.distance = distanceFor(options, bounds.radius) * std::max(1.0, tall);
  return camera;
}

}  // namespace meniscus

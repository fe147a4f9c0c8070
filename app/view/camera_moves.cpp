#include "app/view/camera_moves.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <utility>

namespace meniscus {
namespace {

// Of the smaller half side of the picture. A choice: a little inside the picture, so that its corners turn
// about the axis of sight.
constexpr double kBallRadius = 0.9;

constexpr double kLeastDistance = 1e-2, kMostDistance = 1e7;  // [Å]

glm::dvec3 onBall(ImageSize size, glm::dvec2 pixel) {
  const double half = 0.5 * std::min(size.width, size.height);
  const glm::dvec2 p = (pixel - 0.5 * glm::dvec2(size.width, size.height)) / (half * kBallRadius);
  const double square = glm::dot(p, p);
  const double z = square <= 0.5 ? std::sqrt(1 - square) : 0.5 / std::sqrt(square);
  return glm::normalize(glm::dvec3(p, z));
}

glm::dvec3 inWorld(const Camera& camera, const glm::dvec3& viewAxes) {
  return glm::conjugate(glm::normalize(camera.orientation)) * viewAxes;
}

// Of what is in front of the eye: the nearest and the farthest [Å].
std::pair<double, double> depthsOf(const Camera& camera, const BoundingSphere& scene) {
  const glm::dvec3 middle = glm::normalize(camera.orientation) * (scene.center - camera.target);
  const double depth = camera.distance - middle.z;
  return {std::max(0.0, depth - scene.radius), depth + scene.radius};
}

// What the two planes leave between them at least [Å].
double leastSlab(const BoundingSphere& scene) {
  return 1e-3 * scene.radius;
}

}  // namespace

double pixelAtTarget(const Camera& camera, ImageSize size) {
  return 2 * std::tan(0.5 * camera.fovY) * camera.distance / (size.height * camera.zoom);
}

Camera turned(Camera camera, ImageSize size, glm::dvec2 from, glm::dvec2 to) {
  const glm::dvec3 a = onBall(size, from), b = onBall(size, to);
  const glm::dvec3 axis = glm::cross(a, b);
  const double sine = glm::length(axis);
  if (sine == 0) return camera;
  const glm::dquat turn = glm::angleAxis(std::atan2(sine, glm::dot(a, b)), axis / sine);
  camera.orientation = glm::normalize(turn * camera.orientation);
  return camera;
}

Camera panned(Camera camera, ImageSize size, glm::dvec2 from, glm::dvec2 to) {
  camera.target -= inWorld(camera, glm::dvec3((to - from) * pixelAtTarget(camera, size), 0));
  return camera;
}

Camera dollied(Camera camera, ImageSize size, glm::dvec2 cursor, double factor) {
  const double distance = std::clamp(camera.distance * factor, kLeastDistance, kMostDistance);
  factor = distance / camera.distance;
  const glm::dvec2 offset =
      (cursor - 0.5 * glm::dvec2(size.width, size.height)) * pixelAtTarget(camera, size);
  camera.target += inWorld(camera, glm::dvec3(offset * (1 - factor), 0));
  if (camera.nearest) camera.nearest = std::max(0.0, *camera.nearest + distance - camera.distance);
  if (camera.farthest)
    camera.farthest = std::max(kLeastDistance, *camera.farthest + distance - camera.distance);
  camera.distance = distance;
  return camera;
}

Camera focusedOn(Camera camera, ImageSize size, const BoundingSphere& sphere) {
  const double half = std::atan(std::tan(0.5 * camera.fovY) / camera.zoom);
  const double tall = std::max(1.0, static_cast<double>(size.height) / size.width);
  const double radius = std::max(sphere.radius, kLeastDistance) * tall;
  const double distance =
      radius / (camera.projection == Projection::perspective ? std::sin(half) : std::tan(half));
  camera.nearest.reset();
  camera.farthest.reset();
  camera.target = sphere.center;
  camera.distance = std::clamp(distance, kLeastDistance, kMostDistance);
  return camera;
}

Camera clippedBy(Camera camera, const BoundingSphere& scene, double share) {
  const auto [front, back] = depthsOf(camera, scene);
  const double plane = camera.nearest.value_or(front) + share * 2 * scene.radius;
  camera.nearest = std::min(plane, camera.farthest ? *camera.farthest - leastSlab(scene) : back);
  if (*camera.nearest <= front) camera.nearest.reset();
  return camera;
}

Camera clippedBehindBy(Camera camera, const BoundingSphere& scene, double share) {
  const auto [front, back] = depthsOf(camera, scene);
  const double plane = camera.farthest.value_or(back) - share * 2 * scene.radius;
  camera.farthest = std::max({plane, camera.nearest.value_or(front) + leastSlab(scene), kLeastDistance});
  if (*camera.farthest >= back) camera.farthest.reset();
  return camera;
}

std::optional<glm::dvec2> pixelOf(const Camera& camera, ImageSize size, const glm::dvec3& world) {
  const View view = makeView(camera, size, {});
  const glm::dvec3 p = view.rotation * (world - view.pivot);
  const double depth = view.projection == Projection::perspective ? view.distance - p.z : 1.0;
  if (!(depth > 0)) return std::nullopt;
  return view.center + glm::dvec2(p) / (view.pixelSize * depth);
}

}  // namespace meniscus

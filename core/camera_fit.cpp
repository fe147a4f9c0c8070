#include "core/camera_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/symmetric_eigen.h"

namespace meniscus {

namespace {

// An axis has no sign of its own: take the one along which the distribution has its longer tail.
glm::dvec3 withSign(glm::dvec3 axis, std::span<const FitSphere> spheres, glm::dvec3 mean) {
  double third = 0, scale = 0;
  for (const FitSphere& s : spheres) {
    const double x = glm::dot(s.center - mean, axis);
    third += x * x * x;
    scale += std::abs(x * x * x);
  }
  if (std::abs(third) > 1e-6 * scale) return third > 0 ? axis : -axis;
  // Symmetric: the largest component becomes positive.
  const glm::dvec3 a = glm::abs(axis);
  const double largest = a.x >= a.y && a.x >= a.z ? axis.x : a.y >= a.z ? axis.y : axis.z;
  return largest >= 0 ? axis : -axis;
}

glm::dquat fromAxes(glm::dvec3 right, glm::dvec3 up) {
  const glm::dvec3 back = glm::cross(right, up);
  return glm::normalize(glm::quat_cast(glm::transpose(glm::dmat3(right, up, back))));
}

}  // namespace

glm::dquat principalAxes(std::span<const FitSphere> spheres, bool tall) {
  if (spheres.size() < 2) return {1, 0, 0, 0};
  glm::dvec3 mean(0.0);
  for (const FitSphere& s : spheres) mean += s.center;
  mean /= static_cast<double>(spheres.size());
  glm::dmat3 covariance(0.0);
  for (const FitSphere& s : spheres) {
    const glm::dvec3 d = s.center - mean;
    covariance += glm::outerProduct(d, d);
  }
  const SymmetricEigen eigen = symmetricEigen(covariance);
  std::array<int, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return eigen.values[a] > eigen.values[b]; });
  if (eigen.values[order[0]] <= 0) return {1, 0, 0, 0};
  const glm::dvec3 longest = withSign(eigen.vectors[order[0]], spheres, mean);
  const glm::dvec3 second = withSign(eigen.vectors[order[1]], spheres, mean);
  return tall ? fromAxes(-second, longest) : fromAxes(longest, second);
}

glm::dquat lookDownAxis(int axis) {
  glm::dvec3 right(0.0), up(0.0);
  right[(axis + 1) % 3] = 1;
  up[(axis + 2) % 3] = 1;
  return fromAxes(right, up);
}

glm::dquat rotatedBy(const glm::dquat& orientation, glm::dvec3 degrees) {
  const glm::dvec3 angles = glm::radians(degrees);
  const glm::dquat x = glm::angleAxis(angles.x, glm::dvec3(1, 0, 0));
  const glm::dquat y = glm::angleAxis(angles.y, glm::dvec3(0, 1, 0));
  const glm::dquat z = glm::angleAxis(angles.z, glm::dvec3(0, 0, 1));
  return glm::normalize(z * y * x * orientation);
}

Camera fitted(Camera camera, ImageSize size, std::span<const FitSphere> spheres, double margin) {
  if (spheres.empty()) return camera;
  const glm::dmat3 rotation = glm::mat3_cast(glm::normalize(camera.orientation));
  const bool perspective = camera.projection == Projection::perspective;
  const double tanY = std::tan(camera.fovY * 0.5) * (1 - margin);
  const double tanX = tanY * size.width / size.height;
  // How far a sphere reaches beyond its centre against a plane of the frustum, and how much its height
  // counts.
  const double reachX = perspective ? std::hypot(1.0, tanX) : 1.0, leanX = perspective ? tanX : 0.0;
  const double reachY = perspective ? std::hypot(1.0, tanY) : 1.0, leanY = perspective ? tanY : 0.0;

  constexpr double kNone = -std::numeric_limits<double>::infinity();
  double right = kNone, left = kNone, top = kNone, bottom = kNone, front = kNone, back = kNone;
  const glm::dvec3 base = spheres.front().center;  // keeps digits for molecules far from the origin
  for (const FitSphere& s : spheres) {
    const glm::dvec3 p = rotation * (s.center - base);
    right = std::max(right, p.x + leanX * p.z + reachX * s.radius);
    left = std::max(left, -p.x + leanX * p.z + reachX * s.radius);
    top = std::max(top, p.y + leanY * p.z + reachY * s.radius);
    bottom = std::max(bottom, -p.y + leanY * p.z + reachY * s.radius);
    front = std::max(front, p.z + s.radius);
    back = std::max(back, s.radius - p.z);
  }
  // Opposite planes of the frustum touch the spheres when the eye is half-way between them.
  const glm::dvec3 middle((right - left) * 0.5, (top - bottom) * 0.5, (front - back) * 0.5);
  double distance = std::max((right + left) * 0.5 / tanX, (top + bottom) * 0.5 / tanY);
  if (perspective) distance = std::max(distance, front + 1e-3 * (front + back)) - middle.z;
  camera.target = base + glm::transpose(rotation) * middle;
  camera.distance = std::max(distance, 1e-9);
  return camera;
}

}  // namespace meniscus

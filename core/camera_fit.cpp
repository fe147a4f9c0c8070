#include "core/camera_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/symmetric_eigen.h"

namespace meniscus {

namespace {

// Of points about their mean.
struct Moments {
  double count = 0;
  glm::dvec3 mean{0.0};
  glm::dmat3 second{0.0};
  glm::dmat3 third[3] = {glm::dmat3(0.0), glm::dmat3(0.0), glm::dmat3(0.0)};  // sums of d_k d d^T

  explicit Moments(const std::vector<FitSphere>& spheres) : count(static_cast<double>(spheres.size())) {
    for (const FitSphere& s : spheres) mean += s.center;
    mean /= count;
    for (const FitSphere& s : spheres) {
      const glm::dvec3 d = s.center - mean;
      const glm::dmat3 square = glm::outerProduct(d, d);
      second += square;
      for (int k = 0; k < 3; ++k) third[k] += d[k] * square;
    }
  }
  double secondAlong(const glm::dvec3& axis) const { return glm::dot(axis, second * axis); }
  double thirdAlong(const glm::dvec3& axis) const {
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += axis[k] * glm::dot(axis, third[k] * axis);
    return sum;
  }
};

// Of the centres of all spheres in all places. A group is summed once, whatever the number of its places.
class Distribution {
 public:
  explicit Distribution(const FitSpheres& spheres) : spheres_(spheres) {
    for (const FitGroup& group : spheres.groups()) moments_.emplace_back(group.spheres);
    forEachPlace([&](const Moments& m, const glm::dmat3&, const glm::dvec3& middle) {
      count_ += m.count;
      mean_ += m.count * middle;
    });
    mean_ /= count_;
    forEachPlace([&](const Moments& m, const glm::dmat3& turn, const glm::dvec3& middle) {
      const glm::dvec3 d = middle - mean_;
      covariance_ += turn * m.second * glm::transpose(turn) + m.count * glm::outerProduct(d, d);
    });
  }

  const glm::dmat3& covariance() const { return covariance_; }

  // An axis has no sign of its own: the one along which there is the longer tail.
  glm::dvec3 withSign(const glm::dvec3& axis) const {
    double third = 0;
    forEachPlace([&](const Moments& m, const glm::dmat3& turn, const glm::dvec3& middle) {
      const glm::dvec3 along = glm::transpose(turn) * axis;
      const double d = glm::dot(middle - mean_, axis);
      third += m.thirdAlong(along) + 3 * d * m.secondAlong(along) + m.count * d * d * d;
    });
    const double deviation = std::sqrt(std::max(glm::dot(axis, covariance_ * axis), 0.0) / count_);
    if (std::abs(third) > 1e-6 * count_ * deviation * deviation * deviation) return third > 0 ? axis : -axis;
    // Symmetric: the largest component becomes positive.
    const glm::dvec3 a = glm::abs(axis);
    const double largest = a.x >= a.y && a.x >= a.z ? axis.x : a.y >= a.z ? axis.y : axis.z;
    return largest >= 0 ? axis : -axis;
  }

 private:
  // f(moments of a group, its turn, where its mean is) for each place.
  template <typename F>
  void forEachPlace(F f) const {
    for (std::size_t g = 0; g < moments_.size(); ++g) {
      for (const glm::dmat4& place : spheres_.groups()[g].places)
        f(moments_[g], glm::dmat3(place), glm::dvec3(place * glm::dvec4(moments_[g].mean, 1.0)));
    }
  }

  const FitSpheres& spheres_;
  std::vector<Moments> moments_;  // of groups
  double count_ = 0;
  glm::dvec3 mean_{0.0};
  glm::dmat3 covariance_{0.0};
};

// Moments so close, as a share of the largest, that only rounding, the file's or ours, tells their axes
// apart.
constexpr double kAlike = 1e-6;

// As near to x as it may be, or to y where that is not across the axis at all.
glm::dvec3 across(const glm::dvec3& axis) {
  const glm::dvec3 near = std::abs(axis.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  return glm::normalize(near - glm::dot(near, axis) * axis);
}

glm::dquat fromAxes(glm::dvec3 right, glm::dvec3 up) {
  const glm::dvec3 back = glm::cross(right, up);
  return glm::normalize(glm::quat_cast(glm::transpose(glm::dmat3(right, up, back))));
}

}  // namespace

FitSphere FitGroup::ballIn(const glm::dmat4& place) const {
  // Matrices in files need not be rigid: no vector grows more than by the root of the largest sum in a row.
  const glm::dmat3 turn(place), square = glm::transpose(turn) * turn;
  double most = 1;
  for (int k = 0; k < 3; ++k)
    most = std::max(most, std::abs(square[k][0]) + std::abs(square[k][1]) + std::abs(square[k][2]));
  return {placed(ball, place).center, ball.radius * std::sqrt(most) * (1 + 1e-9)};
}

void FitSpheres::add(std::vector<FitSphere> spheres, std::vector<glm::dmat4> places) {
  if (spheres.empty() || places.empty()) return;
  glm::dvec3 low = spheres.front().center, high = low;
  for (const FitSphere& s : spheres) {
    low = glm::min(low, s.center);
    high = glm::max(high, s.center);
  }
  FitSphere ball{(low + high) * 0.5, 0};
  for (const FitSphere& s : spheres)
    ball.radius = std::max(ball.radius, glm::distance(s.center, ball.center) + s.radius);
  groups_.push_back({std::move(spheres), std::move(places), ball});
}

void FitSpheres::add(const FitSpheres& others) {
  groups_.insert(groups_.end(), others.groups_.begin(), others.groups_.end());
}

std::size_t FitSpheres::size() const {
  std::size_t count = 0;
  for (const FitGroup& group : groups_) count += group.spheres.size() * group.places.size();
  return count;
}

FitSphere FitSpheres::front() const {
  const FitGroup& group = groups_.front();
  return FitGroup::placed(group.spheres.front(), group.places.front());
}

glm::dquat principalAxes(const FitSpheres& spheres, bool tall) {
  if (spheres.size() < 2) return {1, 0, 0, 0};
  const Distribution distribution(spheres);
  const SymmetricEigen eigen = symmetricEigen(distribution.covariance());
  std::array<int, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return eigen.values[a] > eigen.values[b]; });
  if (eigen.values[order[0]] <= 0) return {1, 0, 0, 0};
  glm::dvec3 longest = eigen.vectors[order[0]], second = eigen.vectors[order[1]];
  const double alike = kAlike * eigen.values[order[0]];
  const bool round = eigen.values[order[0]] - eigen.values[order[1]] <= alike,
             rod = eigen.values[order[1]] - eigen.values[order[2]] <= alike;
  if (round && rod) {
    longest = {1, 0, 0};
    second = {0, 1, 0};
  } else if (round) {
    longest = across(eigen.vectors[order[2]]);
    second = glm::cross(eigen.vectors[order[2]], longest);
  } else if (rod) {
    second = across(longest);
  }
  longest = distribution.withSign(longest);
  second = distribution.withSign(second);
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

Camera fitted(Camera camera, ImageSize size, const FitSpheres& spheres, double margin) {
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
  // Beyond its point in the direction of each plane.
  const auto reach = [&](const FitSphere& s, auto f) {
    const glm::dvec3 p = rotation * (s.center - base);
    return f(right, p.x + leanX * p.z + reachX * s.radius) &&
           f(left, -p.x + leanX * p.z + reachX * s.radius) && f(top, p.y + leanY * p.z + reachY * s.radius) &&
           f(bottom, -p.y + leanY * p.z + reachY * s.radius) && f(front, p.z + s.radius) &&
           f(back, s.radius - p.z);
  };
  spheres.forEach(
      [&](const FitSphere& ball) {
        return reach(ball, [](double most, double here) { return here <= most; });
      },
      [&](const FitSphere& s) {
        reach(s, [](double& most, double here) {
          most = std::max(most, here);
          return true;
        });
      });
  // Opposite planes of the frustum touch the spheres when the eye is half-way between them.
  const glm::dvec3 middle((right - left) * 0.5, (top - bottom) * 0.5, (front - back) * 0.5);
  double distance = std::max((right + left) * 0.5 / tanX, (top + bottom) * 0.5 / tanY);
  if (perspective) distance = std::max(distance, front + 1e-3 * (front + back)) - middle.z;
  camera.target = base + glm::transpose(rotation) * middle;
  camera.distance = std::max(distance, 1e-9);
  return camera;
}

}  // namespace meniscus

#include "render/surface/projected_field.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "render/two_floats.h"

namespace meniscus {

namespace {

// Rasterizers snap corners to 1/256 pixel.
constexpr double kPadding = 0.05;

// Bounds [pixels from the optical axis] of a sphere along one screen direction: of the planes through the eye
// that touch it. Everything if it meets the eye plane.
void extent(const View& view, double x, double depth, double radius, double& from, double& to) {
  if (view.projection == Projection::orthographic) {
    from = (x - radius) / view.pixelSize;
    to = (x + radius) / view.pixelSize;
    return;
  }
  from = -std::numeric_limits<double>::infinity();
  to = -from;
  if (!(depth > radius * 1.0001)) return;
  const double a = depth * depth - radius * radius;
  const double half = radius * std::sqrt(x * x + a);
  from = (x * depth - half) / (a * view.pixelSize);
  to = (x * depth + half) / (a * view.pixelSize);
}

// Where places on rays are measured from: the pivot's plane, near which one looks, or what of the field is
// nearest to it.
double planeOf(const std::vector<glm::dvec3>& centers, const MetaballField& field) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (std::size_t i = 0; i < centers.size(); ++i) {
    const double support = static_cast<double>(field.balls[i].support);
    least = std::min(least, centers[i].z - support);
    most = std::max(most, centers[i].z + support);
  }
  return static_cast<double>(static_cast<float>(least <= most ? std::clamp(0.0, least, most) : 0.0));
}

}  // namespace

double largestStretch(const View& view, const Tile& tile, const glm::vec4& box) {
  if (view.projection == Projection::orthographic) return 1;
  const glm::dvec2 corner = glm::dvec2(tile.x, tile.y) - view.center;
  const glm::dvec2 from = glm::abs((glm::dvec2(box.x, box.y) + corner - 1.0) * view.pixelSize);
  const glm::dvec2 to = glm::abs((glm::dvec2(box.z, box.w) + corner + 2.0) * view.pixelSize);
  const glm::dvec2 slope = glm::max(from, to);
  return std::sqrt(1 + glm::dot(slope, slope));
}

namespace {

class Projector {
 public:
  Projector(const MetaballField& field, const std::vector<float>& coreShares, const View& view,
            const glm::dvec3& origin, const Tile& tile, glm::vec2 sampleShift, std::optional<double> plane)
      : field_(field),
        coreShares_(coreShares),
        view_(view),
        tile_(tile),
        chosen_(plane.has_value()),
        perspective_(view.projection == Projection::perspective),
        corner_(glm::dvec2(tile.x, tile.y) + glm::dvec2(sampleShift)),
        size_(tile.width, tile.height) {
    centers_.resize(field.balls.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, centers_.size(), kGrain), [&](const auto& some) {
      for (std::size_t i = some.begin(); i < some.end(); ++i)
        centers_[i] = view.rotation * ((origin - view.pivot) + glm::dvec3(field.balls[i].center));
    });
    plane_ = plane ? static_cast<double>(static_cast<float>(*plane)) : planeOf(centers_, field);
    eyeAbove_ = view.distance - plane_;
  }

  ProjectedField project(BallOrder order) const;

 private:
  struct Key {
    double key;
    std::uint32_t ball;
    bool operator<(const Key& other) const { return key != other.key ? key < other.key : ball < other.ball; }
  };
  static constexpr std::size_t kGrain = 4096;

  double support(std::uint32_t i) const { return static_cast<double>(field_.balls[i].support); }
  double distanceOf(std::uint32_t i) const;
  bool box(const glm::dvec3& center, double radius, glm::dvec2& from, glm::dvec2& to) const;
  void write(std::uint32_t i, std::size_t to, ProjectedField& out) const;

  const MetaballField& field_;
  const std::vector<float>& coreShares_;
  const View& view_;
  const Tile& tile_;
  bool chosen_, perspective_;
  glm::dvec2 corner_, size_;
  std::vector<glm::dvec3> centers_;
  double plane_ = 0, eyeAbove_ = 0;
};

double Projector::distanceOf(std::uint32_t i) const {
  const glm::dvec3& c = centers_[i];
  const double below = plane_ - c.z;
  if (!perspective_) return below - support(i);
  // |(x, y, depth)| - depth, without cancellation where the eye is far.
  const double depth = view_.distance - c.z, aside2 = c.x * c.x + c.y * c.y;
  const double length = std::sqrt(aside2 + depth * depth);
  const double further = depth > 0 ? aside2 / (length + depth) : length - depth;
  return below + further - support(i);
}

// The rectangle around a sphere; false if it lies outside the target.
bool Projector::box(const glm::dvec3& center, double radius, glm::dvec2& from, glm::dvec2& to) const {
  const double depth = perspective_ ? view_.distance - center.z : 1.0;
  extent(view_, center.x, depth, radius, from.x, to.x);
  extent(view_, center.y, depth, radius, from.y, to.y);
  from = glm::max(from + view_.center - corner_ - kPadding, glm::dvec2(-1.0));
  to = glm::min(to + view_.center - corner_ + kPadding, size_ + 1.0);
  return from.x < to.x && from.y < to.y && to.x > 0 && to.y > 0 && from.x < size_.x && from.y < size_.y;
}

void Projector::write(std::uint32_t i, std::size_t to, ProjectedField& out) const {
  const Metaball& ball = field_.balls[i];
  const glm::dvec3& c = centers_[i];
  const double depth = perspective_ ? view_.distance - c.z : 1.0;
  const double r = support(i), core = static_cast<double>(coreShares_[i]) * r;
  ProjectedBall b{};
  b.place.y = high(r * r);
  b.eye.w = core > 0 ? high(core * core) : -1.0f;
  double below = plane_ - c.z;
  if (perspective_ && depth < 2 * r) {  // close by or behind: the ray is taken from the eye
    b.eye = {high(-c.x), high(-c.y), high(depth), b.eye.w};
    below = -eyeAbove_;
  } else {
    const glm::dvec2 pixel = glm::dvec2(c) / (depth * view_.pixelSize) + view_.center;
    b.pixel = {high(pixel.x), high(pixel.y), low(pixel.x), low(pixel.y)};
    b.place.x = high(depth * view_.pixelSize);
  }
  b.place.z = high(below);
  b.place.w = low(below);
  b.coefficient = ball.coefficient;
  b.inverseR2 = high(1 / (r * r));
  b.color = ball.color;
  b.id = ball.id;
  out.balls[to] = b;
  out.indices[to] = i;
  glm::dvec2 least, most;
  box(c, r, least, most);
  out.boxes[to] = glm::vec4(glm::dvec4(least, most));
  const bool seen = core > 0 && box(c, core, least, most);
  out.coreBoxes[to] = seen ? glm::vec4(glm::dvec4(least, most)) : glm::vec4(0.0f);
  out.distances[to] = distanceOf(i);
  out.depths[to] = {plane_ - c.z - r, plane_ - c.z + r};
}

ProjectedField Projector::project(BallOrder order) const {
  std::vector<Key> keys(centers_.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, keys.size(), kGrain), [&](const auto& some) {
    for (std::size_t n = some.begin(); n < some.end(); ++n) {
      const auto i = static_cast<std::uint32_t>(n);
      const glm::dvec3& c = centers_[i];
      glm::dvec2 from, to;
      const bool seen = chosen_ || (c.z - support(i) <= view_.nearZ && box(c, support(i), from, to));
      const double key = order == BallOrder::depth ? -(c.z + support(i)) : distanceOf(i);
      keys[n] = {seen ? key : std::numeric_limits<double>::infinity(), i};
    }
  });
  std::erase_if(keys, [](const Key& key) { return key.key == std::numeric_limits<double>::infinity(); });
  tbb::parallel_sort(keys);

  ProjectedField out;
  out.block.plane = {high(plane_), high(eyeAbove_), low(eyeAbove_), 0.0f};
  out.block.field = {static_cast<float>(field_.level), static_cast<float>(field_.kernel.exponent),
                     static_cast<float>(field_.kernel.shape), 0.0f};
  out.nearDepth = plane_ - view_.nearZ;
  out.balls.resize(keys.size());
  out.indices.resize(keys.size());
  out.boxes.resize(keys.size());
  out.coreBoxes.resize(keys.size());
  out.distances.resize(keys.size());
  out.depths.resize(keys.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, keys.size(), kGrain), [&](const auto& some) {
    for (std::size_t n = some.begin(); n < some.end(); ++n) write(keys[n].ball, n, out);
  });
  double farthest = 0;
  for (const Key& key : keys)
    farthest = std::max(farthest, std::abs(centers_[key.ball].z - plane_) + support(key.ball));
  out.reach = farthest * largestStretch(view_, tile_, glm::vec4(glm::dvec4(0, 0, size_)));
  return out;
}

}  // namespace

std::vector<float> coreShares(const MetaballField& field) {
  std::vector<float> shares;
  shares.reserve(field.balls.size());
  float coefficient = 0, share = 0;  // of the ball before: most are alike
  for (const Metaball& ball : field.balls) {
    if (ball.coefficient != coefficient) {
      coefficient = ball.coefficient;
      share = static_cast<float>(coreShare(field.kernel, field.level, static_cast<double>(coefficient)));
    }
    shares.push_back(share);
  }
  return shares;
}

ShaderFlags kernelFlags(const Kernel& kernel) {
  if (kernel.shape == KernelShape::quartic) return {"KERNEL_QUARTIC"};
  if (kernel.shape == KernelShape::power) return {"KERNEL_POWER"};
  return {};
}

ProjectedField projectField(const MetaballField& field, const std::vector<float>& coreShares,
                            const View& view, const glm::dvec3& origin, const Tile& tile,
                            glm::vec2 sampleShift, BallOrder order, std::optional<double> plane) {
  return Projector(field, coreShares, view, origin, tile, sampleShift, plane).project(order);
}

}  // namespace meniscus

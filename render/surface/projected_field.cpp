#include "render/surface/projected_field.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

namespace meniscus {

namespace {

float high(double x) {
  return static_cast<float>(x);
}
float low(double x) {
  return static_cast<float>(x - static_cast<double>(high(x)));
}

// Rasterizers snap corners to 1/256 pixel.
constexpr double kPadding = 0.05;

// The largest length of a ray per height in the target.
double largestStretch(const View& view, const Tile& tile) {
  if (view.projection == Projection::orthographic) return 1;
  double largest = 1;
  for (const double x : {tile.x - 1.0, tile.x + tile.width + 1.0}) {
    for (const double y : {tile.y - 1.0, tile.y + tile.height + 1.0}) {
      const glm::dvec2 slope = (glm::dvec2(x, y) - view.center) * view.pixelSize;
      largest = std::max(largest, std::sqrt(1 + glm::dot(slope, slope)));
    }
  }
  return largest;
}

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

ProjectedField projectField(const MetaballField& field, const std::vector<float>& coreShares,
                            const View& view, const glm::dvec3& origin, const Tile& tile,
                            glm::vec2 sampleShift) {
  const bool perspective = view.projection == Projection::perspective;
  const glm::dvec2 corner = glm::dvec2(tile.x, tile.y) + glm::dvec2(sampleShift);
  const glm::dvec2 size(tile.width, tile.height);
  const double stretch = largestStretch(view, tile);
  std::vector<glm::dvec3> centers;
  centers.reserve(field.balls.size());
  for (const Metaball& ball : field.balls)
    centers.push_back(view.rotation * ((origin - view.pivot) + glm::dvec3(ball.center)));

  ProjectedField out;
  const double plane = planeOf(centers, field), eyeAbove = view.distance - plane;
  out.block.plane = {high(plane), high(eyeAbove), low(eyeAbove), 0.0f};
  out.block.field = {static_cast<float>(field.level), static_cast<float>(field.kernel.exponent),
                     static_cast<float>(field.kernel.shape), 0.0f};
  out.nearDepth = plane - view.nearZ;
  std::vector<std::uint32_t> order(field.balls.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto top = [&](std::uint32_t i) {
    return centers[i].z + static_cast<double>(field.balls[i].support);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return top(a) > top(b); });
  for (const std::uint32_t i : order) {
    const Metaball& ball = field.balls[i];
    const glm::dvec3 c = centers[i];
    const double support = static_cast<double>(ball.support);
    if (c.z - support > view.nearZ) continue;
    const double depth = perspective ? view.distance - c.z : 1.0;
    glm::dvec2 from, to;
    extent(view, c.x, depth, support, from.x, to.x);
    extent(view, c.y, depth, support, from.y, to.y);
    from = glm::max(from + view.center - corner - kPadding, glm::dvec2(-1.0));
    to = glm::min(to + view.center - corner + kPadding, size + 1.0);
    if (!(from.x < to.x && from.y < to.y && to.x > 0 && to.y > 0 && from.x < size.x && from.y < size.y))
      continue;

    const double core = static_cast<double>(coreShares[i]) * support;
    ProjectedBall b{};
    b.place.y = high(support * support);
    b.eye.w = core > 0 ? high(core * core) : -1.0f;
    double below = plane - c.z;
    if (perspective && depth < 2 * support) {  // close by or behind: the ray is taken from the eye
      b.eye = {high(-c.x), high(-c.y), high(depth), b.eye.w};
      below = -eyeAbove;
    } else {
      const glm::dvec2 pixel = glm::dvec2(c) / (depth * view.pixelSize) + view.center;
      b.pixel = {high(pixel.x), high(pixel.y), low(pixel.x), low(pixel.y)};
      b.place.x = high(depth * view.pixelSize);
    }
    b.place.z = high(below);
    b.place.w = low(below);
    b.coefficient = ball.coefficient;
    b.inverseR2 = high(1 / (support * support));
    b.color = ball.color;
    b.id = ball.id;
    out.balls.push_back(b);
    out.boxes.emplace_back(from.x, from.y, to.x, to.y);
    out.depths.emplace_back(plane - c.z - support, plane - c.z + support);
    out.reach = std::max(out.reach, (std::abs(c.z - plane) + support) * stretch);
  }
  return out;
}

}  // namespace meniscus

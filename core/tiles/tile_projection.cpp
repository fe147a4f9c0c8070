#include "core/tiles/tile_projection.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace meniscus::tiles {

namespace {

// Rays of a sample are shifted by up to half a pixel; the rest covers float32's rounding of the bounds on a
// poster of 65,000 pixels.
constexpr float kPadding = 0.52f;

}  // namespace

TileProjection::TileProjection(const TileTarget& target)
    : rotation_(target.view.rotation),
      translation_(target.view.rotation * (target.origin - target.view.pivot)),
      center_(target.view.center),
      pixelSize_(target.view.pixelSize),
      distance_(target.view.distance),
      perspective_(target.view.projection == Projection::perspective),
      nearZ_(static_cast<float>(target.view.nearZ)),
      farZ_(static_cast<float>(target.view.farZ)),
      grid_(target.area) {
  block_.scale.z = perspective_ ? 1.0f : 0.0f;  // all that the shared bounds ask of a view
  cluster_.tilesPerUnit = static_cast<float>(1 / (pixelSize_ * kTileSize));
  cluster_.padding = kPadding / kTileSize;
  cluster_.columns = grid_.columns;
  cluster_.rows = grid_.rows;
  cluster_.nearZ = nearZ_;
  cluster_.farZ = farZ_;
  cluster_.perspective = perspective_;
}

ProjectedPoint TileProjection::project(const glm::dvec3& center) const {
  ProjectedPoint p;
  p.view = rotation_ * center + translation_;
  p.depth = perspective_ ? distance_ - p.view.z : 1.0;
  const double pixels = 1 / (p.depth * pixelSize_);
  p.pixel = {center_.x + p.view.x * pixels, center_.y + p.view.y * pixels};
  return p;
}

double TileProjection::range(const ProjectedPoint& p) const {
  if (!perspective_) return static_cast<double>(nearZ_) - p.view.z;
  return std::sqrt(p.view.x * p.view.x + p.view.y * p.view.y + p.depth * p.depth);
}

TileProjection::Rectangle TileProjection::boundsOf(const ProjectedPoint& p, float radius,
                                                   const f32::vec3& axesX, const f32::vec3& axesY,
                                                   const f32::vec3& axesZ) const {
  const auto depth = static_cast<float>(p.depth), perPixel = static_cast<float>(1 / pixelSize_);
  const float slopeX = static_cast<float>(p.view.x) / depth, slopeY = static_cast<float>(p.view.y) / depth;
  const f32::Extent x = f32::ellipsoidExtent(block_, slopeX, depth, radius, axesX, axesZ);
  const f32::Extent y = f32::ellipsoidExtent(block_, slopeY, depth, radius, axesY, axesZ);
  const auto px = static_cast<float>(p.pixel.x), py = static_cast<float>(p.pixel.y);
  return {px + x.low * perPixel, py + y.low * perPixel, px + x.high * perPixel, py + y.high * perPixel,
          x.bounded && y.bounded};
}

Placement TileProjection::placed(const Rectangle& r, double front, double back) const {
  Placement out;
  const auto z = static_cast<float>(front);
  // The negated comparisons refuse what is not a number.
  if (!(back <= static_cast<double>(nearZ_)) || !(z >= farZ_)) return out;
  if (!r.bounded) {
    out = {0, 0, static_cast<std::int16_t>(grid_.columns - 1), static_cast<std::int16_t>(grid_.rows - 1), z};
    return out;
  }
  const auto tile = [](float pixel, int origin, int count) {
    const float t = std::floor((pixel - static_cast<float>(origin)) * (1.0f / kTileSize));
    return static_cast<std::int16_t>(std::clamp(t, -1.0f, static_cast<float>(count)));
  };
  if (!(r.x0 <= r.x1 && r.y0 <= r.y1)) return out;
  const std::int16_t x0 = tile(r.x0 - kPadding, grid_.x, grid_.columns),
                     y0 = tile(r.y0 - kPadding, grid_.y, grid_.rows),
                     x1 = tile(r.x1 + kPadding, grid_.x, grid_.columns),
                     y1 = tile(r.y1 + kPadding, grid_.y, grid_.rows);
  if (x1 < 0 || y1 < 0 || x0 >= grid_.columns || y0 >= grid_.rows) return out;
  out.x0 = std::max(x0, std::int16_t{0});
  out.y0 = std::max(y0, std::int16_t{0});
  out.x1 = std::min(x1, static_cast<std::int16_t>(grid_.columns - 1));
  out.y1 = std::min(y1, static_cast<std::int16_t>(grid_.rows - 1));
  out.front = z;
  return out;
}

Placement TileProjection::placeSphere(const glm::dvec3& center, double radius) const {
  if (!(radius > 0) || !std::isfinite(radius)) return {};
  const ProjectedPoint p = project(center);
  const Rectangle r = boundsOf(p, static_cast<float>(radius), {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  return placed(r, p.view.z + radius, p.view.z - radius);
}

void TileProjection::rowsOf(const ProjectedPoint& center, float radius, float& low, float& high) const {
  constexpr float kRounding = 1e-5f, kSpare = 0.01f;  // of the extent; pixels
  const auto depth = static_cast<float>(center.depth), perPixel = static_cast<float>(1 / pixelSize_);
  const f32::Extent y =
      f32::projectedExtent(block_, static_cast<float>(center.view.y) / depth, depth, radius, 0, 0);
  if (!y.bounded) return;
  const float spare = kRounding * perPixel * std::max(std::abs(y.low), std::abs(y.high)) + kSpare;
  low = y.low * perPixel - spare;
  high = y.high * perPixel + spare;
}

void TileProjection::rowsOf(const ProjectedPoint& center, const glm::dvec3& along, double radius, float& low,
                            float& high) const {
  // Of the ends' spheres. A sphere's tangents with slope t, seen at the slope s and the depth d:
  // |t - s| = r / d sqrt(1 + t^2) <= r / d (sqrt(1 + s^2) + |t - s|).
  constexpr double kLeastDepth = 16, kWidening = 16.0 / 15 + 1e-6;  // radii
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const double side : {-0.5, 0.5}) {
    const double y = center.view.y + side * along.y;
    const double depth = perspective_ ? center.depth - side * along.z : 1.0;
    if (perspective_ && !(depth > kLeastDepth * radius)) return;
    const double slope = perspective_ ? y / depth : 0.0;
    const double reach = kWidening * radius * std::sqrt(1 + slope * slope);
    least = std::min(least, (y - reach) / depth);
    most = std::max(most, (y + reach) / depth);
  }
  constexpr double kSpare = 0.01, kOfExtent = 1e-6;  // pixels
  const double middle = center.view.y / center.depth;
  const double below = (least - middle) / pixelSize_, above = (most - middle) / pixelSize_;
  const double spare = kSpare + kOfExtent * std::max(std::abs(below), std::abs(above));
  low = static_cast<float>(below - spare);
  high = static_cast<float>(above + spare);
}

void TileProjection::placeBalls(const RigidMotion& motion, const Cluster& cluster,
                                std::span<const Clusters::Ball> balls, Placement* out) const {
  const ProjectedPoint p = project(motion(cluster.center));
  const double radius = static_cast<double>(cluster.radius);
  if (perspective_ && !(p.depth > 2 * radius)) {
    std::transform(balls.begin(), balls.end(), out, [&](const Clusters::Ball& ball) {
      return placeSphere(motion(ball.center), static_cast<double>(ball.radius));
    });
    return;
  }
  ClusterView view = cluster_;
  const glm::dmat3 turn = rotation_ * motion.turn;
  for (int row = 0; row < 3; ++row) {
    view.center[row] = cluster.center[row];
    for (int column = 0; column < 3; ++column)
      view.rotation[3 * row + column] = static_cast<float>(turn[column][row]);
  }
  view.z = static_cast<float>(p.view.z);
  view.depth = static_cast<float>(p.depth);
  view.slopeX = perspective_ ? static_cast<float>(p.view.x / p.depth) : 0.0f;
  view.slopeY = perspective_ ? static_cast<float>(p.view.y / p.depth) : 0.0f;
  view.tileX = static_cast<float>((p.pixel.x - grid_.x) / kTileSize);
  view.tileY = static_cast<float>((p.pixel.y - grid_.y) / kTileSize);
  tiles::placeBalls(view, balls, out);
}

Placement TileProjection::placeEllipsoid(const glm::dvec3& center, const glm::dvec3 (&axes)[3]) const {
  const double longest = std::max({glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])});
  const double shortest = std::min({glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])});
  if (!(shortest > 0) || !std::isfinite(longest)) return {};
  const ProjectedPoint p = project(center);
  const glm::dvec3 u = turn(axes[0]) / longest, v = turn(axes[1]) / longest, w = turn(axes[2]) / longest;
  const f32::vec3 axesX(glm::dvec3(u.x, v.x, w.x)), axesY(glm::dvec3(u.y, v.y, w.y)),
      axesZ(glm::dvec3(u.z, v.z, w.z));
  const double reach = longest * static_cast<double>(glm::length(axesZ)) * (1 + 1e-6);
  return placed(boundsOf(p, static_cast<float>(longest), axesX, axesY, axesZ), p.view.z + reach,
                p.view.z - reach);
}

Placement TileProjection::placeCylinder(const glm::dvec3& a, const glm::dvec3& b, double radius) const {
  const glm::dvec3 along = turn(b - a);
  const double length = glm::length(along);
  if (!(radius > 0 && length > 0) || !std::isfinite(radius * length)) return {};
  const f32::vec3 axis(along / length);
  const auto r = static_cast<float>(radius), perPixel = static_cast<float>(1 / pixelSize_);
  Rectangle bounds{std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
                   -std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(), true};
  double front = -std::numeric_limits<double>::infinity(), back = -front;
  for (const glm::dvec3& end : {a, b}) {
    const ProjectedPoint p = project(end);
    const auto depth = static_cast<float>(p.depth);
    const f32::Extent x = f32::projectedExtent(block_, static_cast<float>(p.view.x) / depth, depth, r, axis.x,
                                               axis.z),
                      y = f32::projectedExtent(block_, static_cast<float>(p.view.y) / depth, depth, r, axis.y,
                                               axis.z);
    const auto px = static_cast<float>(p.pixel.x), py = static_cast<float>(p.pixel.y);
    bounds.bounded = bounds.bounded && x.bounded && y.bounded;
    bounds.x0 = std::min(bounds.x0, px + x.low * perPixel);
    bounds.x1 = std::max(bounds.x1, px + x.high * perPixel);
    bounds.y0 = std::min(bounds.y0, py + y.low * perPixel);
    bounds.y1 = std::max(bounds.y1, py + y.high * perPixel);
    front = std::max(front, p.view.z + radius);
    back = std::min(back, p.view.z - radius);
  }
  if (!std::isfinite(front) || !std::isfinite(back)) return {};
  return placed(bounds, front, back);
}

Occluder TileProjection::occluder(const glm::dvec3& center, double radius) const {
  const ProjectedPoint p = project(center);
  if (!(radius > 0) || p.view.z + radius >= static_cast<double>(nearZ_) || !(p.depth > 0)) return {};
  // The smaller radius and the plane farther back leave room for rounding.
  return {p.pixel.x, p.pixel.y, static_cast<float>(radius / perPixel(p) * (1 - 1e-4)),
          static_cast<float>(p.view.z - 1e-4 * radius)};
}

}  // namespace meniscus::tiles

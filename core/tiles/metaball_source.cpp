#include "core/tiles/metaball_source.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace meniscus::tiles {

MetaballSource::MetaballSource(const MetaballField& field, const TileTarget& target)
    : field_(field), projection_(target), coresHide_(field.allPositive()) {
  for (const Metaball& ball : field.balls)
    largestSupport_ = std::max(largestSupport_, static_cast<double>(ball.support));
  if (field.balls.empty()) return;
  lastCoefficient_ = field.balls.front().coefficient;
  lastShare_ = coreShare(field.kernel, field.level, static_cast<double>(lastCoefficient_));
}

Placement MetaballSource::place(std::size_t index) const {
  const Metaball& ball = field_.balls[index];
  if (ball.coefficient == 0) return {};
  return projection_.placeSphere(ball.center, static_cast<double>(ball.support));
}

Clusters clustersOf(const MetaballField& field) {
  Clusters clusters;
  if (!Clusters::worthwhile(field.balls.size())) return clusters;
  const auto ballOf = [&](std::size_t index) -> Clusters::Ball {
    const Metaball& ball = field.balls[index];
    return {ball.center, ball.coefficient != 0 ? ball.support : -1};
  };
  clusters.add(field.balls.size(), ballOf, std::array{RigidMotion{}});
  return clusters;
}

double MetaballSource::coreRadius(const Metaball& ball) const {
  const double share = ball.coefficient == lastCoefficient_
                           ? lastShare_
                           : coreShare(field_.kernel, field_.level, static_cast<double>(ball.coefficient));
  return share * static_cast<double>(ball.support);
}

Occluder MetaballSource::occluder(std::size_t index) const {
  if (!coresHide_) return {};
  const Metaball& ball = field_.balls[index];
  return projection_.occluder(ball.center, coreRadius(ball));
}

void MetaballSource::record(std::size_t index, BallRecord& out) const {
  const Metaball& ball = field_.balls[index];
  const auto support = static_cast<double>(ball.support);
  const ProjectedPoint p = projection_.project(ball.center);
  out.pixelX = p.pixel.x;
  out.pixelY = p.pixel.y;
  out.centerZ = p.view.z;
  out.perPixel = static_cast<float>(projection_.perPixel(p));
  out.centerX = static_cast<float>(p.view.x);
  out.centerY = static_cast<float>(p.view.y);
  out.eyeAbove = static_cast<float>(projection_.eyeZ() - p.view.z);
  out.support2 = static_cast<float>(support * support);
  out.inverseSupport2 = static_cast<float>(1 / (support * support));
  const double core = coreRadius(ball);
  out.core2 = static_cast<float>(core * core);
  out.coefficient = ball.coefficient;
  out.front = static_cast<float>(p.view.z + support);
  out.fromEye = projection_.nearEye(p, support) ? 1u : 0u;
  for (int c = 0; c < 3; ++c) {
    const float stored = static_cast<float>(ball.color >> (16 - 8 * c) & 0xFFu) / 255.0f;
    out.colorSquared[c] = stored * stored;
  }
  out.id = ball.id;
}

}  // namespace meniscus::tiles

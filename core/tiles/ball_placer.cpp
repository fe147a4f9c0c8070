#include "core/tiles/ball_placer.h"

#include <cstdint>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/tiles/ball_placer.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include "core/tiles/lanes.inl"

HWY_BEFORE_NAMESPACE();
namespace meniscus::tiles::HWY_NAMESPACE {
namespace {

// Of a ball's offset from the middle and of its extent: covers float32's rounding.
constexpr float kRounding = 4e-6f;

struct Range {
  V low, high;  // tiles
};

// Along one direction of the screen, as projectedExtent() in shaders/shared/projection.glsl of a sphere.
// along: of the ball's centre from the middle, in that direction; toward: in z.
HWY_INLINE Range extentOf(const ClusterView& view, V along, V toward, V radius, float slope, float tile) {
  const V scale = all(view.tilesPerUnit), rounding = all(kRounding);
  V offset, low, high;
  if (view.perspective) {
    const V depth = all(view.depth) - toward;
    const V aside = (along + all(slope) * toward) / depth;  // slope beyond the middle's
    const V s = all(slope) + aside;
    const V r2 = radius * radius;
    const V a = depth * depth - r2;
    const V middle = r2 * s / a;
    const V half = radius * hn::Sqrt(r2 * s * s + a * (all(1.0f) + s * s)) / a;
    offset = aside;
    low = middle - half;
    high = middle + half;
  } else {
    offset = along;
    low = hn::Neg(radius);
    high = radius;
  }
  const V spare =
      (hn::Abs(offset) + hn::Max(hn::Abs(low), hn::Abs(high))) * rounding * scale + all(view.padding);
  const V at = all(tile) + offset * scale;
  return {at + low * scale - spare, at + high * scale + spare};
}

void placeCluster(const ClusterView& view, const Clusters::Ball* balls, std::size_t count, Placement* out) {
  static_assert(sizeof(Clusters::Ball) == 4 * sizeof(float));
  const F f;
  const I i;
  const std::size_t lanes = laneCount();
  alignas(64) std::int32_t x0[16], x1[16], y0[16], y1[16];
  alignas(64) float front[16];
  alignas(64) float rest[4 * 16];
  const auto tileOf = [&](V v, int most) {  // -1 and most: outside
    return hn::ConvertTo(i, hn::Floor(hn::Min(hn::Max(v, all(-1.0f)), all(static_cast<float>(most)))));
  };
  for (std::size_t k = 0; k < count; k += lanes) {
    const auto* from = reinterpret_cast<const float*>(balls + k);
    const std::size_t here = count - k < lanes ? count - k : lanes;
    if (here < lanes) {
      for (std::size_t j = 0; j < 4 * lanes; ++j) rest[j] = j < 4 * here ? from[j] : 0.0f;
      from = rest;
    }
    V cx, cy, cz, radius;
    hn::LoadInterleaved4(f, from, cx, cy, cz, radius);
    const Vec3 o{cx - all(view.center[0]), cy - all(view.center[1]), cz - all(view.center[2])};
    const float* const r = view.rotation;
    const V x = dot(o, {all(r[0]), all(r[1]), all(r[2])}), y = dot(o, {all(r[3]), all(r[4]), all(r[5])}),
            z = dot(o, {all(r[6]), all(r[7]), all(r[8])});
    const Range across = extentOf(view, x, z, radius, view.slopeX, view.tileX),
                up = extentOf(view, y, z, radius, view.slopeY, view.tileY);
    const V middle = all(view.z) + z, nearest = middle + radius;
    const M seen =
        hn::And(hn::And(middle - radius <= all(view.nearZ), nearest >= all(view.farZ)), radius > hn::Zero(f));
    hn::Store(hn::IfThenElse(seen, nearest, all(-std::numeric_limits<float>::infinity())), f, front);
    hn::Store(tileOf(across.low, view.columns), i, x0);
    hn::Store(tileOf(across.high, view.columns), i, x1);
    hn::Store(tileOf(up.low, view.rows), i, y0);
    hn::Store(tileOf(up.high, view.rows), i, y1);
    for (std::size_t j = 0; j < here; ++j) {
      Placement& p = out[k + j];
      p = {};
      if (x1[j] < 0 || y1[j] < 0 || x0[j] >= view.columns || y0[j] >= view.rows) continue;
      p.x0 = static_cast<std::int16_t>(x0[j] > 0 ? x0[j] : 0);
      p.y0 = static_cast<std::int16_t>(y0[j] > 0 ? y0[j] : 0);
      p.x1 = static_cast<std::int16_t>(x1[j] < view.columns ? x1[j] : view.columns - 1);
      p.y1 = static_cast<std::int16_t>(y1[j] < view.rows ? y1[j] : view.rows - 1);
      p.front = front[j];
    }
  }
}

}  // namespace
}  // namespace meniscus::tiles::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meniscus::tiles {

HWY_EXPORT(placeCluster);

void placeBalls(const ClusterView& view, std::span<const Clusters::Ball> balls, Placement* out) {
  HWY_DYNAMIC_DISPATCH(placeCluster)(view, balls.data(), balls.size(), out);
}

}  // namespace meniscus::tiles
#endif

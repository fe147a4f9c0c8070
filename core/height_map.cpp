#include "core/height_map.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/height_map.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include "core/tiles/lanes.inl"

HWY_BEFORE_NAMESPACE();
namespace meniscus::HWY_NAMESPACE {
namespace {

using namespace tiles::HWY_NAMESPACE;
using U16 = hn::Rebind<std::uint16_t, F>;

void raiseAll(const HeightMap& map, std::span<const SpherePrimitive> balls) {
  static_assert(HeightMap::kBeyond >= laneCount());
  const F f;
  const I i;
  const U16 u16;
  const auto lanes = static_cast<int>(laneCount());
  const V zero = hn::Zero(f), texel = all(map.texel), perStep = all(map.perStep);
  for (const SpherePrimitive& s : balls) {
    if (!(s.radius > 0)) continue;
    const glm::vec3 c = map.turn * s.center + map.shift;
    const float r = s.radius / map.texel;
    const float r2 = r * r;
    const TexelRange rows(c.y, r, map.height), columns(c.x, r, map.width);
    std::uint16_t* const slab = map.slabOf(c.z);
    for (int y = rows.first; y <= rows.last; ++y) {
      const float dy = static_cast<float>(y) + 0.5f - c.y;
      const V left = all(r2 - dy * dy);
      std::uint16_t* const row = slab + static_cast<std::ptrdiff_t>(y) * map.width;
      for (int x = columns.first; x <= columns.last; x += lanes) {
        const V dx = hn::Iota(f, static_cast<float>(x)) + all(0.5f) - all(c.x);
        const V under = left - dx * dx;
        const M met = hn::And(under >= zero, hn::FirstN(f, static_cast<std::size_t>(columns.last - x + 1)));
        const V height = (all(c.z) + texel * hn::Sqrt(hn::Max(under, zero))) * perStep;
        const V stored = hn::IfThenElseZero(met, hn::Min(hn::Max(height, all(1.0f)), all(65535.0f)));
        hn::StoreU(hn::Max(hn::LoadU(u16, row + x), hn::DemoteTo(u16, hn::ConvertTo(i, stored))), u16,
                   row + x);
      }
    }
  }
}

}  // namespace
}  // namespace meniscus::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meniscus {

HWY_EXPORT(raiseAll);

std::uint16_t* HeightMap::slabOf(float z) const {
  const int slab = static_cast<int>(std::clamp(z * perSlab, 0.0f, static_cast<float>(slabs) - 0.5f));
  return heights +
         static_cast<std::size_t>(slab) * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

TexelRange::TexelRange(float place, float reach, int size) {
  const float low = std::ceil(place - reach - 0.5f), high = std::floor(place + reach - 0.5f);
  first = static_cast<int>(std::clamp(low, 0.0f, static_cast<float>(size)));
  last = static_cast<int>(std::clamp(high, -1.0f, static_cast<float>(size - 1)));
}

void raiseBalls(const HeightMap& map, std::span<const SpherePrimitive> balls) {
  HWY_DYNAMIC_DISPATCH(raiseAll)(map, balls);
}

}  // namespace meniscus
#endif

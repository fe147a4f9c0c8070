#include "core/effects/shadow_lookup.h"

#include <glm/packing.hpp>

#include "core/effects/rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/effects/shadow_lookup.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include "core/effects/surface_lanes.inl"

#ifndef MENISCUS_SHADOW_LOOKUP_ONCE
#define MENISCUS_SHADOW_LOOKUP_ONCE
namespace meniscus::effects {
struct ShadowTask {
  const SurfacePlanes* planes;
  const ShadowFilter* filter;
  const float* map;
  std::array<float, kMaxShadowSamples> offsetX, offsetY;  // texels
  int samples, probes;
  bool soft;
};
}  // namespace meniscus::effects
#endif

HWY_BEFORE_NAMESPACE();
namespace meniscus::effects::HWY_NAMESPACE {
namespace {

// As in include/shadow.glsl.
constexpr float kNormalError = 6e-5f, kPositionError = 2e-6f;

struct Receivers {
  V x, y, height;               // texels, the map's unit
  V neededX, neededY, neededZ;  // by how much a texel must lie above one to be above its tangent plane
  V factorX, factorY;
};
constexpr std::size_t kNumbers = 8;  // of a receiver

Receivers receiversOf(const ShadowFilter& filter, const Surfaces& s, V& facing) {
  const V nz = dot(xyz(filter.rowZ), s.normal);
  const float perTexel = filter.map.w / filter.map.z;
  const V toPlane = all(-filter.map.w * perTexel);
  Receivers r;
  r.x = dot(xyz(filter.rowX), s.point) + all(filter.rowX.w);
  r.y = dot(xyz(filter.rowY), s.point) + all(filter.rowY.w);
  r.height = (dot(xyz(filter.rowZ), s.point) + all(filter.rowZ.w)) * all(1 / filter.map.z);
  r.neededX = dot(xyz(filter.rowX), s.normal) * toPlane;
  r.neededY = dot(xyz(filter.rowY), s.normal) * toPlane;
  r.neededZ = all(kPositionError + 2 * kNormalError * perTexel * (filter.filter.x + 1));
  r.factorX = all(1.0f) / hn::Max(nz - all(kNormalError), all(1e-9f));
  r.factorY = all(1.0f) / (nz + all(kNormalError));
  facing = nz;
  return r;
}

// Where the light does not reach the tangent plane over a texel (whole numbers).
HWY_INLINE M shadowedAt(const ShadowTask& task, const Receivers& r, V texelX, V texelY) {
  const F f;
  const V zero = hn::Zero(f), half = all(0.5f);
  const glm::vec4& size = task.filter->map;
  const V x = hn::Min(hn::Max(texelX, zero), all(size.x - 1)),
          y = hn::Min(hn::Max(texelY, zero), all(size.y - 1));
  const auto index = hn::ConvertTo(I(), y) * hn::Set(I(), static_cast<int>(size.x)) + hn::ConvertTo(I(), x);
  const V height = hn::GatherIndex(f, task.map, index);
  const V needed = r.neededX * (texelX + half - r.x) + r.neededY * (texelY + half - r.y) + r.neededZ;
  const V least = r.height + hn::Max(needed * r.factorX, needed * r.factorY);
  return height > hn::Max(least, zero);
}

HWY_INLINE V litSamples(const ShadowTask& task, const Receivers& r, int first, int end) {
  V sum = hn::Zero(F());
  for (int i = first; i < end; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const M dark =
        shadowedAt(task, r, hn::Floor(r.x + all(task.offsetX[k])), hn::Floor(r.y + all(task.offsetY[k])));
    sum = sum + hn::IfThenZeroElse(dark, all(1.0f));
  }
  return sum;
}

// The share of all samples that is lit, of which `probed` are of the probes.
HWY_INLINE V shareOfAll(const ShadowTask& task, const Receivers& r, V probed) {
  return (probed + litSamples(task, r, task.probes, task.samples)) *
         all(1 / static_cast<float>(task.samples));
}

// The four texels around a place, weighted by nearness.
V litAround(const ShadowTask& task, const Receivers& r) {
  const V half = all(0.5f), one = all(1.0f);
  const V x = hn::Floor(r.x - half), y = hn::Floor(r.y - half);
  const V fx = r.x - half - x, fy = r.y - half - y;
  const auto lit = [&](V tx, V ty) { return hn::IfThenZeroElse(shadowedAt(task, r, tx, ty), one); };
  return mixed(mixed(lit(x, y), lit(x + one, y), fx), mixed(lit(x, y + one), lit(x + one, y + one), fx), fy);
}

// Pixels whose probes disagree wait here until there are enough of them for whole vectors.
class Penumbra {
 public:
  Penumbra(const ShadowTask& task, std::uint16_t* out) : task_(task), out_(out) {}

  void add(M disagree, const Receivers& r, V probed, hn::Vec<I> where) {
    const F f;
    const V numbers[kNumbers] = {r.x, r.y, r.height, r.neededX, r.neededY, r.neededZ, r.factorX, r.factorY};
    for (std::size_t i = 0; i < kNumbers; ++i)
      hn::CompressStore(numbers[i], disagree, f, numbers_[i] + count_);
    hn::CompressStore(probed, disagree, f, probed_ + count_);
    hn::CompressStore(where, hn::RebindMask(I(), disagree), I(), where_ + count_);
    count_ += hn::CountTrue(f, disagree);
    if (count_ >= laneCount()) takeFirst(laneCount());
  }
  void finish() {
    if (count_ > 0) takeFirst(count_);
  }

 private:
  void takeFirst(std::size_t n) {
    const F f;
    const auto number = [&](std::size_t i) { return hn::Load(f, numbers_[i]); };
    const Receivers r{number(0), number(1), number(2), number(3), number(4), number(5), number(6), number(7)};
    std::uint16_t shares[kMostLanes];
    storeShares(shareOfAll(task_, r, hn::Load(f, probed_)), n, shares);
    for (std::size_t k = 0; k < n; ++k) out_[where_[k]] = shares[k];
    count_ -= n;
    if (count_ == 0) return;
    // Fewer than a vector are left.
    for (auto& column : numbers_) hn::Store(hn::LoadU(f, column + n), f, column);
    hn::Store(hn::LoadU(f, probed_ + n), f, probed_);
    hn::Store(hn::LoadU(I(), where_ + n), I(), where_);
  }

  const ShadowTask& task_;
  std::uint16_t* out_;
  std::size_t count_ = 0;
  alignas(64) float numbers_[kNumbers][3 * kMostLanes] = {};  // CompressStore may write a whole vector
  alignas(64) float probed_[3 * kMostLanes] = {};
  alignas(64) std::int32_t where_[3 * kMostLanes] = {};
};

void lookUpRows(const ShadowTask& task, int firstRow, int lastRow, std::uint16_t* out) {
  const F f;
  const V zero = hn::Zero(f);
  const SurfacePlanes& planes = *task.planes;
  const auto lanes = static_cast<int>(laneCount());
  Penumbra penumbra(task, out);
  for (int y = firstRow; y < lastRow; ++y) {
    for (int x = 0; x < planes.width; x += lanes) {
      const std::size_t at = planes.rowStart(y) + static_cast<std::size_t>(x);
      const auto here = static_cast<std::size_t>(planes.width - x < lanes ? planes.width - x : lanes);
      const Surfaces s = surfacesAt(planes, at, x, y);
      V facing;
      const Receivers r = receiversOf(*task.filter, s, facing);
      const M wanted = hn::And(hn::And(s.there, hn::FirstN(f, here)), facing > zero);
      if (hn::AllFalse(f, wanted)) {
        storeShares(zero, here, out + at);
        continue;
      }
      if (!task.soft) {
        storeShares(hn::IfThenElseZero(wanted, litAround(task, r)), here, out + at);
        continue;
      }
      const V lit = litSamples(task, r, 0, task.probes), most = all(static_cast<float>(task.probes));
      const M agree = hn::Or(lit == zero, lit == most);
      const M disagree = task.probes > 0 ? hn::AndNot(agree, wanted) : wanted;
      if (hn::AllTrue(f, disagree)) {  // a whole vector already
        storeShares(shareOfAll(task, r, lit), here, out + at);
        continue;
      }
      storeShares(hn::IfThenElseZero(hn::And(wanted, lit > zero), all(1.0f)), here, out + at);
      if (!hn::AllFalse(f, disagree))
        penumbra.add(disagree, r, lit, hn::Iota(I(), static_cast<std::int32_t>(at)));
    }
  }
  penumbra.finish();
}

}  // namespace
}  // namespace meniscus::effects::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meniscus::effects {

HWY_EXPORT(lookUpRows);

void lookUpShadow(const SurfacePlanes& planes, const ShadowFilter& filter, std::span<const float> map,
                  bool soft, Shares& visibility) {
  visibility.resize(planes.pixels());
  ShadowTask task{&planes,
                  &filter,
                  map.data(),
                  {},
                  {},
                  static_cast<int>(filter.filter.y),
                  static_cast<int>(filter.filter.z),
                  soft};
  for (std::size_t i = 0; i < filter.offsets.size(); ++i) {
    const glm::vec2 offset = filter.filter.x * glm::unpackSnorm2x16(filter.offsets[i]);
    task.offsetX[i] = offset.x;
    task.offsetY[i] = offset.y;
  }
  forBands(planes.height, [&](int first, int last) {
    HWY_DYNAMIC_DISPATCH(lookUpRows)(task, first, last, visibility.data());
  });
}

}  // namespace meniscus::effects
#endif

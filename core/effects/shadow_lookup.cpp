#include "core/effects/shadow_lookup.h"

#include <bit>
#include <cstring>
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
  std::array<float, kMaxShadowSamples + kMostLanes> offsetX, offsetY;  // texels
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

// The map by whole numbers in floats.
struct Texels {
  explicit Texels(const ShadowTask& task)
      : first(task.map),
        lastX(all(task.filter->map.x - 1)),
        lastY(all(task.filter->map.y - 1)),
        rowLength(hn::Set(I(), static_cast<std::int32_t>(task.filter->map.x))),
        above(bitsOfTwoTo23() * (rowLength + hn::Set(I(), 1))) {}
  // Of the nearest texel of the map.
  HWY_INLINE V heightAt(V x, V y) const {
    const V zero = hn::Zero(F());
    const auto bits = [&](V value, V last) { return bitsWithTwoTo23(hn::Min(hn::Max(value, zero), last)); };
    return hn::GatherIndex(F(), first, bits(y, lastY) * rowLength + bits(x, lastX) - above);
  }

  const float* first;
  V lastX, lastY;
  hn::Vec<I> rowLength, above;  // above: what 2^23 adds to an index
};

// Where the light does not reach the tangent plane over a texel (whole numbers).
HWY_INLINE M shadowedAt(const Texels& texels, const Receivers& r, V texelX, V texelY) {
  const V height = texels.heightAt(texelX, texelY), half = all(0.5f);
  const V needed = r.neededX * (texelX - (r.x - half)) + r.neededY * (texelY - (r.y - half)) + r.neededZ;
  const V least = r.height + hn::Max(needed * r.factorX, needed * r.factorY);
  return height > hn::Max(least, hn::Zero(F()));
}

// How many of the first samples are lit.
HWY_INLINE V litSamples(const ShadowTask& task, const Texels& texels, const Receivers& r, int count) {
  V sum = hn::Zero(F());
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
    const M dark =
        shadowedAt(texels, r, hn::Floor(r.x + all(task.offsetX[k])), hn::Floor(r.y + all(task.offsetY[k])));
    sum = sum + hn::IfThenZeroElse(dark, all(1.0f));
  }
  return sum;
}

// How many of the samples from the probes on are lit at one of the receivers: a vector of samples at a time,
// whose texels lie beside each other.
HWY_INLINE float litAfterProbes(const ShadowTask& task, const Texels& texels, const Receivers& r) {
  const F f;
  std::size_t lit = 0;
  const auto lanes = static_cast<int>(laneCount());
  for (int i = task.probes; i < task.samples; i += lanes) {
    const auto k = static_cast<std::size_t>(i);
    const M dark = shadowedAt(texels, r, hn::Floor(r.x + hn::LoadU(f, &task.offsetX[k])),
                              hn::Floor(r.y + hn::LoadU(f, &task.offsetY[k])));
    const M taken = hn::FirstN(f, static_cast<std::size_t>(std::min(lanes, task.samples - i)));
    lit += hn::CountTrue(f, hn::AndNot(dark, taken));
  }
  return static_cast<float>(lit);
}

// The four texels around a place, weighted by nearness.
V litAround(const Texels& texels, const Receivers& r) {
  const V half = all(0.5f), one = all(1.0f);
  const V x = hn::Floor(r.x - half), y = hn::Floor(r.y - half);
  const V fx = r.x - half - x, fy = r.y - half - y;
  const auto lit = [&](V tx, V ty) { return hn::IfThenZeroElse(shadowedAt(texels, r, tx, ty), one); };
  return mixed(mixed(lit(x, y), lit(x + one, y), fx), mixed(lit(x, y + one), lit(x + one, y + one), fx), fy);
}

// Adds the samples after the probes to those receivers' sums for which it is asked.
V withAllSamples(const ShadowTask& task, const Texels& texels, const Receivers& r, M wanted, V probed) {
  const F f;
  alignas(64) float numbers[kNumbers][kMostLanes], sums[kMostLanes];
  const V of[kNumbers] = {r.x, r.y, r.height, r.neededX, r.neededY, r.neededZ, r.factorX, r.factorY};
  for (std::size_t i = 0; i < kNumbers; ++i) hn::Store(of[i], f, numbers[i]);
  hn::Store(probed, f, sums);
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(f, wanted, bits);
  std::uint64_t left;
  std::memcpy(&left, bits, sizeof(left));
  for (; left != 0; left &= left - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(left));
    const auto number = [&](std::size_t i) { return all(numbers[i][k]); };
    sums[k] += litAfterProbes(
        task, texels,
        {number(0), number(1), number(2), number(3), number(4), number(5), number(6), number(7)});
  }
  return hn::Load(f, sums);
}

HWY_INLINE V softShare(const ShadowTask& task, const Texels& texels, const Receivers& r, M wanted) {
  const F f;
  const V zero = hn::Zero(f), perSample = all(1 / static_cast<float>(task.samples));
  if (task.probes == 0) return litSamples(task, texels, r, task.samples) * perSample;
  const V probed = litSamples(task, texels, r, task.probes);
  const M agree = hn::Or(probed == zero, probed == all(static_cast<float>(task.probes)));
  const M disagree = hn::AndNot(agree, wanted);
  const V agreed = hn::IfThenElseZero(probed > zero, all(1.0f));
  if (hn::AllFalse(f, disagree)) return agreed;
  return hn::IfThenElse(disagree, withAllSamples(task, texels, r, disagree, probed) * perSample, agreed);
}

void lookUpRows(const ShadowTask& task, int firstRow, int lastRow, std::uint16_t* out) {
  const F f;
  const V zero = hn::Zero(f);
  const SurfacePlanes& planes = *task.planes;
  const Texels texels(task);
  const auto lanes = static_cast<int>(laneCount());
  for (int y = firstRow; y < lastRow; ++y) {
    for (int x = 0; x < planes.width; x += lanes) {
      const std::size_t at = planes.rowStart(y) + static_cast<std::size_t>(x);
      const auto here = static_cast<std::size_t>(planes.width - x < lanes ? planes.width - x : lanes);
      const Surfaces s = surfacesAt(planes, at, x, y);
      V facing;
      Receivers r = receiversOf(*task.filter, s, facing);
      const M wanted = hn::And(hn::And(s.there, hn::FirstN(f, here)), facing > zero);
      if (hn::AllFalse(f, wanted)) {
        storeShares(zero, here, out + at);
        continue;
      }
      r.x = hn::IfThenElseZero(wanted, r.x);  // a place in the map, whatever the other lanes hold
      r.y = hn::IfThenElseZero(wanted, r.y);
      const V share = task.soft ? softShare(task, texels, r, wanted) : litAround(texels, r);
      storeShares(hn::IfThenElseZero(wanted, share), here, out + at);
    }
  }
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

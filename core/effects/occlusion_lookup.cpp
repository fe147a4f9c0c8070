#include "core/effects/occlusion_lookup.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "core/effects/rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/effects/occlusion_lookup.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include "core/effects/surface_lanes.inl"

#ifndef MENISCUS_OCCLUSION_LOOKUP_ONCE
#define MENISCUS_OCCLUSION_LOOKUP_ONCE
namespace meniscus::effects {
/// Of each pixel what is hidden of the sky, and the sky; of rows with room on both sides, which holds zeros.
struct SkySums {
  float *hidden, *sky;
};
struct ConstSkySums {
  const float *hidden, *sky;
};
struct OcclusionTask {
  const SurfacePlanes* planes;
  const OcclusionLook* look;
  std::span<const OcclusionDirection> directionsOf(int part) const {
    const std::size_t count = look->directions.size() / static_cast<std::size_t>(look->parts);
    return std::span(look->directions).subspan(static_cast<std::size_t>(part) * count, count);
  }
};
/// Room for kOcclusionReach pixels beyond those of a vector.
inline constexpr std::size_t kSkyMargin = kMostLanes + kOcclusionReach;
}  // namespace meniscus::effects
#endif

HWY_BEFORE_NAMESPACE();
namespace meniscus::effects::HWY_NAMESPACE {
namespace {

struct Sky {
  V hidden, sky;
};
using Bits = hn::Vec<U>;
using Whole = hn::Vec<I>;

// Four slabs at a time, of two texels beside each other each.
struct Texels {
  Bits slabs[kSlabsPerTexel];
};
HWY_INLINE Texels texelsAt(const OcclusionTexel* texels, Whole index) {
  const U u;
  alignas(64) std::int32_t at[kMostLanes];
  alignas(64) std::uint32_t found[kSlabsPerTexel * kMostLanes];
  hn::Store(index, I(), at);
  for (std::size_t k = 0; k < laneCount(); ++k)
    std::memcpy(found + kSlabsPerTexel * k, &texels[at[k]], sizeof(OcclusionTexel));
  Texels t;
  hn::LoadInterleaved4(u, found, t.slabs[0], t.slabs[1], t.slabs[2], t.slabs[3]);
  return t;
}

// The lowest of four heights that is above a threshold; beyond all heights if none is.
template <typename Half>
HWY_INLINE V lowestAbove(const Texels& t, Whole threshold, Half half) {
  const I i;
  const Whole none = hn::Set(i, 0x7FFFFFFF);
  Whole lowest = none;
  for (const Bits& slab : t.slabs) {
    const Whole height = hn::BitCast(i, half(slab));
    lowest = hn::Min(lowest, hn::IfThenElse(height > threshold, height, none));
  }
  return hn::ConvertTo(F(), lowest);
}

// Adds what points see of the sky in a direction; of `there` alone.
HWY_INLINE void lookAlong(const OcclusionTask& task, const OcclusionDirection& d, const Surfaces& s, M there,
                          Sky& sum) {
  const F f;
  const I i;
  const V zero = hn::Zero(f), one = all(1.0f), half = all(0.5f);
  const OcclusionLook& look = *task.look;
  const V cosine = dot(xyz(d.rowZ), s.normal);
  const M seen = hn::And(there, cosine > zero);
  if (hn::AllFalse(f, seen)) return;
  // The rows give texels: times a texel's size twice, a slope comes out in Å per texel.
  const float square = 1.0f / (d.rowX.x * d.rowX.x + d.rowX.y * d.rowX.y + d.rowX.z * d.rowX.z);
  const V atX = dot(xyz(d.rowX), s.point) + all(d.rowX.w), atY = dot(xyz(d.rowY), s.point) + all(d.rowY.w),
          atZ = dot(xyz(d.rowZ), s.point) + all(d.rowZ.w);

  const auto cornerOf = [&](V at, int count, V& share) {
    const V place = hn::Min(hn::Max(at - half, zero), all(static_cast<float>(count - 1)));
    const Whole corner = hn::ConvertTo(i, hn::Min(place, all(static_cast<float>(std::max(count - 2, 0)))));
    share = place - hn::ConvertTo(f, corner);
    return corner;
  };
  V shareX, shareY;
  const Whole cornerX = cornerOf(atX, d.map.y, shareX), cornerY = cornerOf(atY, d.map.z, shareY);
  const V slab = hn::Min(hn::Max((atZ - all(look.slab.y)) * all(look.slab.x), zero),
                         all(static_cast<float>(d.map.w - 1)));
  const Whole pair = hn::ShiftRight<1>(hn::ConvertTo(i, slab));
  const Whole width = hn::Set(i, d.map.y);
  const Whole index = hn::Set(i, d.map.x) + (pair * hn::Set(i, d.map.z) + cornerY) * width + cornerX;
  const Texels low = texelsAt(look.texels.data(), hn::IfThenElseZero(hn::RebindMask(i, seen), index));
  const auto above =
      hn::RebindMask(i, hn::And(seen, hn::ConvertTo(f, cornerY) < all(static_cast<float>(d.map.z - 1))));
  const Texels high =
      texelsAt(look.texels.data(),
               hn::IfThenElseZero(hn::RebindMask(i, seen), index + hn::IfThenElseZero(above, width)));

  // The tangent plane over the four texels: lower left, lower right, upper left, upper right.
  const V steep = one / hn::Max(cosine, all(1e-3f));
  const V slopeX = hn::Neg(dot(xyz(d.rowX), s.normal) * all(square)) * steep,
          slopeY = hn::Neg(dot(xyz(d.rowY), s.normal) * all(square)) * steep;
  const V rise =
      slopeX * (hn::ConvertTo(f, cornerX) + half - atX) + slopeY * (hn::ConvertTo(f, cornerY) + half - atY);
  // A stored normal is off by up to 6e-5 rad (16-bit octahedral).
  const V least = atZ + (all(look.fade.w) * steep + all(1e-4f * std::sqrt(square)) * steep * steep);
  const V nearest = all(look.fade.x) + all(look.fade.y) * atZ;
  const auto hiddenAt = [&](const Texels& t, V risen, auto part) {
    const V threshold = least + hn::Max(risen, zero);
    const Whole units = hn::ConvertTo(i, hn::Min(threshold * all(look.slab.w), all(1e5f)));
    return hn::Min(hn::Max(nearest - all(look.slab.z) * lowestAbove(t, units, part), zero), one);
  };
  const auto left = [](Bits b) { return hn::And(b, hn::Set(U(), 0xFFFFu)); };
  const auto right = [](Bits b) { return hn::ShiftRight<16>(b); };
  // The nearest occluder counts the most.
  const V below = mixed(hiddenAt(low, rise, left), hiddenAt(low, rise + slopeX, right), shareX);
  const V over =
      mixed(hiddenAt(high, rise + slopeY, left), hiddenAt(high, rise + slopeX + slopeY, right), shareX);
  sum.hidden = sum.hidden + hn::IfThenElseZero(seen, cosine * mixed(below, over, shareY));
  sum.sky = sum.sky + hn::IfThenElseZero(seen, cosine);
}

HWY_INLINE Sky lookAround(const OcclusionTask& task, int part, const Surfaces& s, M there) {
  Sky sum{hn::Zero(F()), hn::Zero(F())};
  if (!hn::AllFalse(F(), there))
    for (const OcclusionDirection& d : task.directionsOf(part)) lookAlong(task, d, s, there, sum);
  return {sum.hidden * all(task.look->fade.z), sum.sky * all(task.look->fade.z)};
}

HWY_INLINE void storeSky(const Sky& sum, std::size_t count, std::uint32_t* out) {
  const auto stored = [](V share) { return hn::BitCast(U(), unorm16(hn::Min(share, all(1.0f)))); };
  storeSome(U(), hn::Or(stored(sum.hidden), hn::ShiftLeft<16>(stored(sum.sky))), count, out);
}

// Each pixel of a row along all directions.
void lookRow(const OcclusionTask& task, int y, std::uint32_t* out) {
  const SurfacePlanes& planes = *task.planes;
  const auto lanes = static_cast<int>(laneCount());
  for (int x = 0; x < planes.width; x += lanes) {
    const auto count = static_cast<std::size_t>(std::min(lanes, planes.width - x));
    const Surfaces s = surfacesAt(planes, planes.rowStart(y) + static_cast<std::size_t>(x), x, y);
    storeSky(lookAround(task, 0, s, hn::And(s.there, hn::FirstN(F(), count))), count, out + x);
  }
}

// Each pixel of a row along its part of them: every fourth pixel the same. `out` holds zeros.
void lookRowInParts(const OcclusionTask& task, int y, const SkySums& out) {
  const F f;
  const SurfacePlanes& planes = *task.planes;
  const auto lanes = static_cast<int>(laneCount());
  const auto inBlock = [](int at, int phase) { return (at + phase) % kOcclusionBlock; };
  for (int first = 0; first < std::min(kOcclusionBlock, planes.width); ++first) {
    const int part = occlusionPartOf(
        {inBlock(planes.x + first, task.look->phase.x), inBlock(planes.y + y, task.look->phase.y)},
        task.look->parts);
    for (int x = first; x < planes.width; x += kOcclusionBlock * lanes) {
      const int count = std::min(lanes, (planes.width - x + kOcclusionBlock - 1) / kOcclusionBlock);
      alignas(64) float depth[kMostLanes] = {};
      alignas(64) std::uint32_t normal[kMostLanes] = {};
      for (int k = 0; k < count; ++k) {
        const std::size_t at = planes.rowStart(y) + static_cast<std::size_t>(x + kOcclusionBlock * k);
        depth[k] = planes.depth[at];
        normal[k] = planes.normal[at];
      }
      if (hn::AllTrue(f, hn::Load(f, depth) <= hn::Zero(f))) continue;
      const V centers =
          hn::Iota(f, 0.0f) * all(kOcclusionBlock) + all(static_cast<float>(planes.x + x) + 0.5f);
      const Surfaces s =
          surfaceOf(planes, hn::Load(f, depth), hn::Load(U(), normal), slopesAt(planes, centers, y));
      const Sky sum = lookAround(task, part, s, s.there);
      alignas(64) float hidden[kMostLanes], sky[kMostLanes];
      hn::Store(sum.hidden, f, hidden);
      hn::Store(sum.sky, f, sky);
      for (int k = 0; k < count; ++k) {
        out.hidden[x + kOcclusionBlock * k] = hidden[k];
        out.sky[x + kOcclusionBlock * k] = sky[k];
      }
    }
  }
}

// Pixels take what their neighbours saw that show the same surface: what lies near the tangent plane.
class Gathering {
 public:
  // The pixels from `at` on, at (x, y) of the planes; perPixel: how far their tangent plane falls behind by
  // the next pixel.
  HWY_INLINE Gathering(const SurfacePlanes& planes, std::size_t at, int x, int y, bool up)
      : depth_(hn::LoadU(F(), planes.depth.data() + at)) {
    const f32::ViewBlock& view = planes.view;
    const Vec3 normal = normalsAt(planes, at);
    const Slopes slopes = slopesAt(planes, pixelCenters(planes.x + x), y);
    const bool perspective = view.scale.z > 0.5f;
    V facing = normal.z, factor = all(view.depthMap.x);
    if (perspective) {
      facing = facing - (normal.x * slopes.x + normal.y * slopes.y);
      factor = factor + depth_;
    }
    perDepth_ = facing / (all(view.scale.x) * factor);
    perPixel_ = up ? normal.y : normal.x;
  }
  // A neighbour so many pixels away.
  HWY_INLINE void add(int away, V depth, V hidden, V sky) {
    const V one = all(1.0f), zero = hn::Zero(F());
    const V distance = hn::Abs(perPixel_ * all(static_cast<float>(away)) + perDepth_ * (depth - depth_));
    const V weight = hn::Min(hn::Max(all(1.5f) - distance, zero), one) *
                     all(static_cast<float>(kOcclusionReach + 1 - std::abs(away)));
    sum_ = {sum_.hidden + weight * hidden, sum_.sky + weight * sky};
  }
  // Where there is a surface.
  HWY_INLINE Sky taken() const {
    constexpr float kWeights = (kOcclusionReach + 1) * (kOcclusionReach + 1);
    const V share = hn::IfThenElseZero(depth_ > hn::Zero(F()), all(1.0f / kWeights));
    return {sum_.hidden * share, sum_.sky * share};
  }

 private:
  V depth_, perDepth_, perPixel_;
  Sky sum_{hn::Zero(F()), hn::Zero(F())};
};

// From neighbours in a row; `depth` has the room that `from` has.
void gatherAcross(const OcclusionTask& task, int y, const float* depth, const ConstSkySums& from,
                  const SkySums& out) {
  const F f;
  const SurfacePlanes& planes = *task.planes;
  const auto lanes = static_cast<int>(laneCount());
  for (int x = 0; x < planes.width; x += lanes) {
    const auto count = static_cast<std::size_t>(std::min(lanes, planes.width - x));
    if (hn::AllTrue(f, hn::LoadU(f, depth + x) <= hn::Zero(f))) {
      storeSome(f, hn::Zero(f), count, out.hidden + x);
      storeSome(f, hn::Zero(f), count, out.sky + x);
      continue;
    }
    Gathering gathering(planes, planes.rowStart(y) + static_cast<std::size_t>(x), x, y, false);
    for (int away = -kOcclusionReach; away <= kOcclusionReach; ++away) {
      const int at = x + away;
      gathering.add(away, hn::LoadU(f, depth + at), hn::LoadU(f, from.hidden + at),
                    hn::LoadU(f, from.sky + at));
    }
    const Sky sum = gathering.taken();
    storeSome(f, sum.hidden, count, out.hidden + x);
    storeSome(f, sum.sky, count, out.sky + x);
  }
}

// From those above and below.
void gatherUp(const OcclusionTask& task, int y, const ConstSkySums& from, std::uint32_t* out) {
  const F f;
  const SurfacePlanes& planes = *task.planes;
  const auto lanes = static_cast<int>(laneCount());
  const int low = std::max(-kOcclusionReach, -y), high = std::min(kOcclusionReach, planes.height - 1 - y);
  for (int x = 0; x < planes.width; x += lanes) {
    const auto count = static_cast<std::size_t>(std::min(lanes, planes.width - x));
    const std::size_t here = planes.rowStart(y) + static_cast<std::size_t>(x);
    if (hn::AllTrue(f, hn::LoadU(f, planes.depth.data() + here) <= hn::Zero(f))) {
      storeSome(U(), hn::Zero(U()), count, out + x);
      continue;
    }
    Gathering gathering(planes, here, x, y, true);
    for (int away = low; away <= high; ++away) {
      const std::size_t at = planes.rowStart(y + away) + static_cast<std::size_t>(x);
      gathering.add(away, hn::LoadU(f, planes.depth.data() + at), hn::LoadU(f, from.hidden + at),
                    hn::LoadU(f, from.sky + at));
    }
    storeSky(gathering.taken(), count, out + x);
  }
}

}  // namespace
}  // namespace meniscus::effects::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meniscus::effects {

HWY_EXPORT(lookRow);
HWY_EXPORT(lookRowInParts);
HWY_EXPORT(gatherAcross);
HWY_EXPORT(gatherUp);

int occlusionPartOf(glm::ivec2 inBlock, int parts) {
  // Aligned blocks of a power of two of the directions are evenly spread (core/occlusion_maps.h), and so
  // should be what any few neighbours look along: the four pixels of a quarter are neighbours in this order,
  // and so are its diagonals.
  constexpr int kOrder[kOcclusionBlock][kOcclusionBlock] = {
      {0, 1, 4, 5}, {3, 2, 7, 6}, {12, 13, 8, 9}, {15, 14, 11, 10}};
  return kOrder[inBlock.y][inBlock.x] % parts;
}

void lookUpOcclusion(const SurfacePlanes& planes, const OcclusionLook& look,
                     std::vector<std::uint32_t>& occlusion) {
  occlusion.resize(planes.pixels());
  const OcclusionTask task{&planes, &look};
  if (look.parts == 1) {
    forRows(planes.height, [&](int y) {
      HWY_DYNAMIC_DISPATCH(lookRow)(task, y, occlusion.data() + planes.rowStart(y));
    });
    return;
  }
  // Vectors reach beyond the last pixel. The memory of the frame before serves again.
  thread_local std::vector<float> ofFrame;
  const std::size_t pixels = planes.pixels() + kMostLanes;
  ofFrame.resize(2 * pixels);
  const SkySums rows{ofFrame.data(), ofFrame.data() + pixels};
  forRows(planes.height, [&](int y) {
    const std::size_t first = planes.rowStart(y);
    const auto width = static_cast<std::size_t>(planes.width);
    thread_local std::vector<float> row;
    row.assign(3 * (width + 2 * kSkyMargin), 0.0f);
    float* const depth = row.data() + kSkyMargin;
    const SkySums seen{depth + width + 2 * kSkyMargin, depth + 2 * (width + 2 * kSkyMargin)};
    std::copy_n(planes.depth.data() + first, width, depth);
    HWY_DYNAMIC_DISPATCH(lookRowInParts)(task, y, seen);
    HWY_DYNAMIC_DISPATCH(gatherAcross)
    (task, y, depth, ConstSkySums{seen.hidden, seen.sky}, SkySums{rows.hidden + first, rows.sky + first});
  });
  forRows(planes.height, [&](int y) {
    HWY_DYNAMIC_DISPATCH(gatherUp)
    (task, y, ConstSkySums{rows.hidden, rows.sky}, occlusion.data() + planes.rowStart(y));
  });
}

}  // namespace meniscus::effects
#endif

#include "core/effects/outlines.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/effects/outlines.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include "core/effects/surface_lanes.inl"

#ifndef MENISCUS_OUTLINES_ONCE
#define MENISCUS_OUTLINES_ONCE
namespace meniscus::effects {

struct OutlineTask {
  const SurfacePlanes* planes;
  const OutlineBlock* block;
  const OutlineGroups* groups;
  int reach;  // from a pixel of a line to one with its border [pixels]
};

/// Surfaces and borders of some rows and of a margin around them, a plane for each number.
struct OutlineBand {
  int firstRow = 0, rows = 0, stride = 0;
  int before = 0;                                            // columns before the picture's first
  std::vector<float> x, y, z, nx, ny, nz, footprint, depth;  // depth: negative outside of the picture
  std::vector<std::uint32_t> group, borders;

  void resize(const OutlineTask& task, int first, int last) {
    constexpr auto kLanes = static_cast<int>(kMostLanes);
    const auto wholeVectors = [](int count) { return (count + kLanes - 1) / kLanes * kLanes; };
    // Borders are wanted `reach` away, and they look one pixel further.
    const int margin = task.reach + 1;
    firstRow = first - margin;
    rows = last - first + 2 * margin;
    before = wholeVectors(margin);
    stride = wholeVectors(task.planes->width) + 2 * before;
    const auto size = static_cast<std::size_t>(rows) * static_cast<std::size_t>(stride);
    for (std::vector<float>* plane : {&x, &y, &z, &nx, &ny, &nz, &footprint}) plane->resize(size);
    depth.assign(size, -1.0f);
    borders.assign(size, 0);
    group.resize(task.groups->differ ? size : 0);
  }
  // Of the picture's pixel.
  std::size_t at(int column, int row) const {
    return static_cast<std::size_t>(row - firstRow) * static_cast<std::size_t>(stride) +
           static_cast<std::size_t>(column + before);
  }
};

}  // namespace meniscus::effects
#endif

HWY_BEFORE_NAMESPACE();
namespace meniscus::effects::HWY_NAMESPACE {
namespace {

constexpr std::uint32_t kHalfLine = 1, kWholeLine = 2;  // half: the other half lies across the border
constexpr float kFar = 1e6f;

struct Side {
  int x, y;
};
constexpr Side kSides[] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};  // in the order of their bits

struct Surface {
  Vec3 point, normal;
  V footprint;
};

HWY_INLINE Surface surfaceOf(const OutlineBand& band, std::size_t at) {
  const F f;
  const auto get = [&](const std::vector<float>& plane) { return hn::LoadU(f, plane.data() + at); };
  return {{get(band.x), get(band.y), get(band.z)},
          {get(band.nx), get(band.ny), get(band.nz)},
          get(band.footprint)};
}

// Whether there is a step between surfaces that are seen `pixels` apart.
HWY_INLINE M isApart(const OutlineBlock& block, const Surface& a, const Surface& b, float pixels) {
  const Vec3 away = sub(b.point, a.point);
  const V gap = hn::Max(hn::Abs(dot(a.normal, away)), hn::Abs(dot(b.normal, away)));
  const V least = hn::Max(all(block.step.x * pixels) * hn::Max(a.footprint, b.footprint), all(block.step.y));
  return gap > least + all(block.step.z);
}

void loadBand(const OutlineTask& task, OutlineBand& band) {
  const F f;
  const SurfacePlanes& planes = *task.planes;
  const f32::ViewBlock& view = planes.view;
  const auto lanes = static_cast<int>(laneCount());
  const std::span<const std::uint32_t> groups = task.groups->byId;
  const int firstRow = std::max(band.firstRow, 0),
            lastRow = std::min(band.firstRow + band.rows, planes.height);
  for (int row = firstRow; row < lastRow; ++row) {
    const std::size_t from = static_cast<std::size_t>(row) * static_cast<std::size_t>(planes.width);
    for (int column = 0; column < planes.width; column += lanes) {
      const std::size_t to = band.at(column, row);
      const std::size_t here = from + static_cast<std::size_t>(column);
      const Surfaces s = surfacesAt(planes, here, column, row);
      const auto put = [&](std::vector<float>& plane, V v) { hn::StoreU(v, f, plane.data() + to); };
      put(band.x, s.point.x);
      put(band.y, s.point.y);
      put(band.z, s.point.z);
      put(band.nx, s.normal.x);
      put(band.ny, s.normal.y);
      put(band.nz, s.normal.z);
      put(band.footprint,
          view.scale.z > 0.5f ? all(view.scale.x) * (all(view.depth.x) - s.point.z) : all(view.scale.x));
      const M inside = hn::FirstN(f, static_cast<std::size_t>(std::min(lanes, planes.width - column)));
      put(band.depth, hn::IfThenElse(inside, hn::LoadU(f, planes.depth.data() + here), all(-1.0f)));
    }
    if (!task.groups->differ) continue;
    for (int column = 0; column < planes.width; ++column) {
      const std::uint32_t id = planes.id[from + static_cast<std::size_t>(column)];
      band.group[band.at(column, row)] = id < groups.size() ? groups[id] : id;
    }
  }
}

// Two bits for each side of a pixel.
void findBorders(const OutlineTask& task, OutlineBand& band) {
  const F f;
  const U u;
  const V zero = hn::Zero(f);
  const OutlineBlock& block = *task.block;
  const M none = hn::MaskFromVec(zero);
  const M steps = block.step.w > 0.5f ? hn::Not(none) : none;
  const int lanes = static_cast<int>(laneCount()), width = task.planes->width;
  const int firstRow = std::max(band.firstRow + 1, 0),
            lastRow = std::min(band.firstRow + band.rows - 1, task.planes->height);
  for (int row = firstRow; row < lastRow; ++row) {
    for (int column = 0; column < width; column += lanes) {
      const std::size_t at = band.at(column, row);
      const M wanted = hn::LoadU(f, band.depth.data() + at) > zero;
      if (hn::AllFalse(f, wanted)) continue;
      const Surface here = surfaceOf(band, at);
      auto borders = hn::Zero(u);
      for (std::uint32_t k = 0; k < 4; ++k) {
        const std::size_t there = at + static_cast<std::size_t>(kSides[k].y * band.stride + kSides[k].x);
        const V depth = hn::LoadU(f, band.depth.data() + there);
        const M surface = depth > zero, background = depth == zero;
        M differ = none;
        if (task.groups->differ) {
          const auto mine = hn::LoadU(u, band.group.data() + at),
                     other = hn::LoadU(u, band.group.data() + there);
          differ = hn::Not(hn::RebindMask(f, mine == other));
        }
        const M line = hn::Or(steps, differ);
        const Surface other = surfaceOf(band, there);
        const M apart = hn::And(surface, isApart(block, here, other, 1));
        const M whole = hn::And(line, hn::Or(background, hn::And(apart, here.point.z >= other.point.z)));
        const M half = hn::And(differ, hn::AndNot(apart, surface));
        const auto kind =
            hn::Or(hn::IfThenElseZero(hn::RebindMask(u, whole), hn::Set(u, kWholeLine << (2 * k))),
                   hn::IfThenElseZero(hn::RebindMask(u, half), hn::Set(u, kHalfLine << (2 * k))));
        borders = hn::Or(borders, kind);
      }
      hn::StoreU(hn::IfThenElseZero(hn::RebindMask(u, wanted), borders), u, band.borders.data() + at);
    }
  }
}

struct Squares {
  V whole, half;  // of the least distances to borders
};

// offset: of the pixels that have the borders, as seen from these.
HWY_INLINE void takeNearer(hn::Vec<U> borders, Side offset, M same, Squares& squares) {
  const U u;
  const auto dx = static_cast<float>(offset.x), dy = static_cast<float>(offset.y);
  // From the middles of the borders, because from the nearest points a slanting edge, which is stairs, would
  // be too wide by 20 %.
  const float across[] = {dx + 0.5f, 0.5f - dx, dy + 0.5f, 0.5f - dy};
  const float along[] = {dy, dy, dx, dx};
  for (int k = 0; k < 4; ++k) {
    if (!(across[k] > 0)) continue;
    const V square = all(across[k] * across[k] + along[k] * along[k]);
    const auto has = [&](std::uint32_t kind) {
      const auto bits = hn::And(borders, hn::Set(u, 3u << (2 * k)));
      return hn::And(same, hn::RebindMask(F(), bits == hn::Set(u, kind << (2 * k))));
    };
    squares.whole = hn::IfThenElse(has(kWholeLine), hn::Min(squares.whole, square), squares.whole);
    squares.half = hn::IfThenElse(has(kHalfLine), hn::Min(squares.half, square), squares.half);
  }
}

void drawRow(const OutlineTask& task, const OutlineBand& band, int row, std::uint16_t* out) {
  const F f;
  const U u;
  const V zero = hn::Zero(f), half = all(0.5f);
  const OutlineBlock& block = *task.block;
  const int lanes = static_cast<int>(laneCount()), width = task.planes->width, reach = task.reach;
  const int low = std::max(row - reach, 0), high = std::min(row + reach, task.planes->height - 1);
  for (int column = 0; column < width; column += lanes) {
    const std::size_t at = band.at(column, row);
    const auto count = static_cast<std::size_t>(std::min(lanes, width - column));
    const M wanted = hn::LoadU(f, band.depth.data() + at) > zero;
    if (hn::AllFalse(f, wanted)) {
      storeShares(zero, count, out + static_cast<std::size_t>(column));
      continue;
    }
    Squares squares{all(kFar), all(kFar)};
    for (int y = low; y <= high; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        const std::size_t there = band.at(column + x, y);
        const auto borders = hn::LoadU(u, band.borders.data() + there);
        if (hn::AllTrue(u, borders == hn::Zero(u))) continue;
        const Side offset{x, y - row};
        // Else it is another surface's line.
        const float pixels = std::sqrt(static_cast<float>(x * x + offset.y * offset.y));
        const M same = hn::Not(isApart(block, surfaceOf(band, at), surfaceOf(band, there), pixels));
        takeNearer(borders, offset, same, squares);
      }
    }
    const V whole = all(block.crease.z) + half - hn::Sqrt(squares.whole),
            halves = half * all(block.crease.z) + half - hn::Sqrt(squares.half);
    const V share = hn::Min(hn::Max(hn::Max(whole, halves), zero), all(1.0f));
    storeShares(hn::IfThenElseZero(wanted, share), count, out + static_cast<std::size_t>(column));
  }
}

void drawBand(const OutlineTask& task, int firstRow, int lastRow, std::uint16_t* out) {
  thread_local OutlineBand band;
  band.resize(task, firstRow, lastRow);
  loadBand(task, band);
  findBorders(task, band);
  for (int row = firstRow; row < lastRow; ++row)
    drawRow(task, band, row,
            out + static_cast<std::size_t>(row) * static_cast<std::size_t>(task.planes->width));
}

}  // namespace
}  // namespace meniscus::effects::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meniscus::effects {

HWY_EXPORT(drawBand);

void drawOutlines(const SurfacePlanes& planes, const OutlineBlock& block, const OutlineGroups& groups,
                  Shares& lines) {
  lines.resize(planes.pixels());
  const OutlineTask task{&planes, &block, &groups, static_cast<int>(block.crease.w)};
  const int rows = std::max(16, 4 * task.reach);  // for a task: few of them compared with the margin
  const int bands = (planes.height + rows - 1) / rows;
  tbb::parallel_for(0, bands, [&](int band) {
    HWY_DYNAMIC_DISPATCH(drawBand)
    (task, band * rows, std::min((band + 1) * rows, planes.height), lines.data());
  });
}

}  // namespace meniscus::effects
#endif

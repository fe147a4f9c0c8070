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
  bool creases;
};

/// Surfaces and borders of a part of the picture and of a margin around it, a plane for each number: as many
/// as stay near to a processor.
struct OutlinePatch {
  int left = 0, right = 0, bottom = 0, top = 0;  // of the part
  int margin = 0, stride = 0;
  std::vector<float> x, y, z, nx, ny, nz, footprint, depth;  // depth: negative outside of the picture
  std::vector<std::uint32_t> group, borders;

  void resize(const OutlineTask& task) {
    // Borders are wanted `reach` away, and they look one pixel further, creases two.
    margin = task.reach + (task.creases ? 2 : 1);
    stride = right - left + 2 * margin + static_cast<int>(kMostLanes);
    const auto size =
        static_cast<std::size_t>(top - bottom + 2 * margin) * static_cast<std::size_t>(stride) + kMostLanes;
    for (std::vector<float>* plane : {&x, &y, &z, &nx, &ny, &nz, &footprint}) plane->resize(size);
    depth.assign(size, -1.0f);
    borders.assign(size, 0);
    group.resize(task.groups->differ ? size : 0);
  }
  // Of the picture's pixel.
  std::size_t at(int column, int row) const {
    return static_cast<std::size_t>(row - bottom + margin) * static_cast<std::size_t>(stride) +
           static_cast<std::size_t>(column - left + margin);
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

// f(first column, row) for the vectors that hold the patch's pixels and the picture's up to `around` beyond
// them.
template <typename Body>
HWY_INLINE void forVectors(const SurfacePlanes& planes, const OutlinePatch& patch, int around, Body f) {
  const auto lanes = static_cast<int>(laneCount());
  const int right = std::min(patch.right + around, planes.width),
            top = std::min(patch.top + around, planes.height);
  for (int row = std::max(patch.bottom - around, 0); row < top; ++row) {
    for (int column = std::max(patch.left - around, 0); column < right; column += lanes) f(column, row);
  }
}

struct Surface {
  Vec3 point, normal;
  V footprint;
};

HWY_INLINE Surface surfaceOf(const OutlinePatch& patch, std::size_t at) {
  const F f;
  const auto get = [&](const std::vector<float>& plane) { return hn::LoadU(f, plane.data() + at); };
  return {{get(patch.x), get(patch.y), get(patch.z)},
          {get(patch.nx), get(patch.ny), get(patch.nz)},
          get(patch.footprint)};
}

// Whether there is a step between surfaces that are seen `pixels` apart.
HWY_INLINE M isApart(const OutlineBlock& block, const Surface& a, const Surface& b, float pixels) {
  const Vec3 away = sub(b.point, a.point);
  const V gap = hn::Max(hn::Abs(dot(a.normal, away)), hn::Abs(dot(b.normal, away)));
  const V least = hn::Max(all(block.step.x * pixels) * hn::Max(a.footprint, b.footprint), all(block.step.y));
  return gap > least + all(block.step.z);
}

void load(const OutlineTask& task, OutlinePatch& patch) {
  const F f;
  const SurfacePlanes& planes = *task.planes;
  const f32::ViewBlock& view = planes.view;
  const auto lanes = static_cast<int>(laneCount());
  const std::span<const std::uint32_t> groups = task.groups->byId;
  forVectors(planes, patch, patch.margin, [&](int column, int row) {
    const std::size_t to = patch.at(column, row);
    const std::size_t here = planes.rowStart(row) + static_cast<std::size_t>(column);
    const Surfaces s = surfacesAt(planes, here, column, row);
    const auto put = [&](std::vector<float>& plane, V v) { hn::StoreU(v, f, plane.data() + to); };
    put(patch.x, s.point.x);
    put(patch.y, s.point.y);
    put(patch.z, s.point.z);
    put(patch.nx, s.normal.x);
    put(patch.ny, s.normal.y);
    put(patch.nz, s.normal.z);
    put(patch.footprint,
        view.scale.z > 0.5f ? all(view.scale.x) * (all(view.depth.x) - s.point.z) : all(view.scale.x));
    const int inPicture = std::min(lanes, planes.width - column);
    const M inside = hn::FirstN(f, static_cast<std::size_t>(inPicture));
    put(patch.depth, hn::IfThenElse(inside, hn::LoadU(f, planes.depth.data() + here), all(-1.0f)));
    if (!task.groups->differ) return;
    for (std::size_t k = 0; k < static_cast<std::size_t>(inPicture); ++k) {
      const std::uint32_t id = planes.id[here + k];
      patch.group[to + k] = id < groups.size() ? groups[id] : id;
    }
  });
}

// Cosine of how much the normal turns from s to its neighbour if the surface goes on there; otherwise 1.
HWY_INLINE V cosineTo(const OutlineBlock& block, const OutlinePatch& patch, const Surface& s,
                      std::size_t there) {
  const F f;
  const Surface other = surfaceOf(patch, there);
  const M goesOn =
      hn::AndNot(isApart(block, s, other, 1), hn::LoadU(f, patch.depth.data() + there) > hn::Zero(f));
  return hn::IfThenElse(goesOn, hn::Min(dot(s.normal, other.normal), all(1.0f)), all(1.0f));
}

// As in silhouette.frag, where they go on. at: here's; step: from one to the other.
HWY_INLINE M isCrease(const OutlineTask& task, const OutlinePatch& patch, const Surface& here, std::size_t at,
                      const Surface& other, std::ptrdiff_t step, M goesOn) {
  const F f;
  const OutlineBlock& block = *task.block;
  const V cosine = dot(here.normal, other.normal), least = all(block.crease.y);
  const M turns = hn::And(goesOn, cosine < least);
  if (hn::AllFalse(f, turns)) return turns;
  const M groove = dot(sub(other.normal, here.normal), sub(other.point, here.point)) < hn::Zero(f);
  const auto place = [&](std::ptrdiff_t steps) {
    return static_cast<std::size_t>(static_cast<std::ptrdiff_t>(at) + steps * step);
  };
  const V curvature = hn::IfThenElse(here.normal.z > other.normal.z, cosineTo(block, patch, here, place(-1)),
                                     cosineTo(block, patch, other, place(2)));
  const V sum = least * curvature -
                all(block.crease.x) * hn::Sqrt(hn::Max(all(1.0f) - curvature * curvature, hn::Zero(f)));
  const M ridge = hn::And(curvature > hn::Neg(least), cosine < sum);
  return hn::And(turns, hn::Or(groove, ridge));
}

// Two bits for each side of a pixel.
template <bool kCreases>
void findBorders(const OutlineTask& task, OutlinePatch& patch) {
  const F f;
  const U u;
  const V zero = hn::Zero(f);
  const OutlineBlock& block = *task.block;
  const M none = hn::MaskFromVec(zero);
  const M steps = block.step.w > 0.5f ? hn::Not(none) : none;
  forVectors(*task.planes, patch, task.reach, [&](int column, int row) {
    const std::size_t at = patch.at(column, row);
    const M wanted = hn::LoadU(f, patch.depth.data() + at) > zero;
    if (hn::AllFalse(f, wanted)) return;
    const Surface here = surfaceOf(patch, at);
    auto borders = hn::Zero(u);
    for (std::uint32_t k = 0; k < 4; ++k) {
      const std::ptrdiff_t step = kSides[k].y * patch.stride + kSides[k].x;
      const auto there = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(at) + step);
      const V depth = hn::LoadU(f, patch.depth.data() + there);
      const M surface = depth > zero, background = depth == zero;
      M differ = none;
      if (task.groups->differ) {
        const auto mine = hn::LoadU(u, patch.group.data() + at),
                   other = hn::LoadU(u, patch.group.data() + there);
        differ = hn::Not(hn::RebindMask(f, mine == other));
      }
      const M line = hn::Or(steps, differ);
      const Surface other = surfaceOf(patch, there);
      const M apart = hn::And(surface, isApart(block, here, other, 1));
      const M whole = hn::And(line, hn::Or(background, hn::And(apart, here.point.z >= other.point.z)));
      const M goesOn = hn::AndNot(apart, surface);
      if constexpr (kCreases)
        differ = hn::Or(differ, isCrease(task, patch, here, at, other, step, hn::And(wanted, goesOn)));
      const M half = hn::And(differ, goesOn);
      const auto kind =
          hn::Or(hn::IfThenElseZero(hn::RebindMask(u, whole), hn::Set(u, kWholeLine << (2 * k))),
                 hn::IfThenElseZero(hn::RebindMask(u, half), hn::Set(u, kHalfLine << (2 * k))));
      borders = hn::Or(borders, kind);
    }
    hn::StoreU(hn::IfThenElseZero(hn::RebindMask(u, wanted), borders), u, patch.borders.data() + at);
  });
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

void drawLines(const OutlineTask& task, const OutlinePatch& patch, std::uint16_t* out) {
  const F f;
  const U u;
  const V zero = hn::Zero(f), half = all(0.5f);
  const OutlineBlock& block = *task.block;
  const SurfacePlanes& planes = *task.planes;
  const int lanes = static_cast<int>(laneCount()), reach = task.reach;
  forVectors(planes, patch, 0, [&](int column, int row) {
    const std::size_t at = patch.at(column, row);
    const auto count = static_cast<std::size_t>(std::min(lanes, patch.right - column));
    std::uint16_t* const to = out + planes.rowStart(row) + static_cast<std::size_t>(column);
    const M wanted = hn::LoadU(f, patch.depth.data() + at) > zero;
    if (hn::AllFalse(f, wanted)) {
      storeShares(zero, count, to);
      return;
    }
    Squares squares{all(kFar), all(kFar)};
    const int low = std::max(row - reach, 0), high = std::min(row + reach, planes.height - 1);
    for (int y = low; y <= high; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        const std::size_t there = patch.at(column + x, y);
        const auto borders = hn::LoadU(u, patch.borders.data() + there);
        if (hn::AllTrue(u, borders == hn::Zero(u))) continue;
        const Side offset{x, y - row};
        // Else it is another surface's line.
        const float pixels = std::sqrt(static_cast<float>(x * x + offset.y * offset.y));
        const M same = hn::Not(isApart(block, surfaceOf(patch, at), surfaceOf(patch, there), pixels));
        takeNearer(borders, offset, same, squares);
      }
    }
    const V whole = all(block.crease.z) + half - hn::Sqrt(squares.whole),
            halves = half * all(block.crease.z) + half - hn::Sqrt(squares.half);
    const V share = hn::Min(hn::Max(hn::Max(whole, halves), zero), all(1.0f));
    storeShares(hn::IfThenElseZero(wanted, share), count, to);
  });
}

void drawPatch(const OutlineTask& task, OutlinePatch& patch, std::uint16_t* out) {
  patch.resize(task);
  load(task, patch);
  task.creases ? findBorders<true>(task, patch) : findBorders<false>(task, patch);
  drawLines(task, patch, out);
}

}  // namespace
}  // namespace meniscus::effects::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meniscus::effects {

HWY_EXPORT(drawPatch);

void drawOutlines(const SurfacePlanes& planes, const OutlineBlock& block, const OutlineGroups& groups,
                  bool creases, Shares& lines) {
  lines.resize(planes.pixels());
  const OutlineTask task{&planes, &block, &groups, static_cast<int>(block.crease.w), creases};
  constexpr int kColumns = 128;
  const int rows = std::max(32, 4 * task.reach);  // few of them beside the margin
  const auto parts = [](int whole, int part) { return (whole + part - 1) / part; };
  const int across = parts(planes.width, kColumns);
  tbb::parallel_for(0, across * parts(planes.height, rows), [&](int i) {
    thread_local OutlinePatch patch;
    patch.left = kColumns * (i % across);
    patch.right = std::min(patch.left + kColumns, planes.width);
    patch.bottom = rows * (i / across);
    patch.top = std::min(patch.bottom + rows, planes.height);
    HWY_DYNAMIC_DISPATCH(drawPatch)(task, patch, lines.data());
  });
}

}  // namespace meniscus::effects
#endif

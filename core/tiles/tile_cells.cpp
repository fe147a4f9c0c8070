#include "core/tiles/tile_cells.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/tiles/tile_cells.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include "core/tiles/lanes.inl"

HWY_BEFORE_NAMESPACE();
namespace meniscus::tiles::HWY_NAMESPACE {
namespace {

// A vector of rows at a time.
bool coverRows(std::uint32_t* cells, float x, float y, float radius) {
  constexpr float kCells = kCellsPerPixel, kMost = kTileCells;
  const F f;
  const I i;
  const U u;
  const auto lanes = static_cast<int>(laneCount());
  // In cells from here on.
  const float cx = x * kCells, cy = y * kCells, r = radius * kCells;
  const auto from = static_cast<int>(std::clamp(cy - r, 0.0f, kMost)),
             to = static_cast<int>(std::clamp(cy + r + 1, 0.0f, kMost));
  const V half = all(0.5f), r2 = all(r * r), zero = hn::Zero(f);
  auto added = hn::Zero(u);
  for (int next = from; next < to; next += lanes) {
    const int row = std::min(next, kTileCells - lanes);
    // Of the row's two edges, the one farther from the centre.
    const V middle = hn::ConvertTo(f, hn::Iota(i, row)) + half;
    const V dy = hn::Abs(middle - all(cy)) + half;
    const V reach = hn::Sqrt(hn::Max(r2 - dy * dy, zero));
    const V low = hn::Ceil(hn::Max(all(cx) - reach, zero)),
            high = hn::Floor(hn::Min(all(cx) + reach, all(kMost)));
    const auto some = hn::RebindMask(u, low < high);  // so low is at most 31 and high at least 1
    const auto first = hn::BitCast(u, hn::ConvertTo(i, hn::Min(low, all(kMost - 1)))),
               beyond = hn::BitCast(u, hn::ConvertTo(i, all(kMost) - hn::Max(high, all(1.0f))));
    const auto ones = hn::Set(u, ~std::uint32_t{0});
    const auto bits = hn::IfThenElseZero(some, hn::And(hn::Shl(ones, first), hn::Shr(ones, beyond)));
    const auto here = hn::LoadU(u, cells + row);
    added = hn::Or(added, hn::AndNot(here, bits));
    hn::StoreU(hn::Or(here, bits), u, cells + row);
  }
  return !hn::AllTrue(u, added == hn::Zero(u));
}

}  // namespace
}  // namespace meniscus::tiles::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meniscus::tiles {

HWY_EXPORT(coverRows);

bool coverCells(TileCells& cells, float x, float y, float radius) {
  return HWY_DYNAMIC_DISPATCH(coverRows)(cells.data(), x, y, radius);
}

bool allCovered(const TileCells& cells) {
  std::uint32_t all = ~std::uint32_t{0};
  for (const std::uint32_t row : cells) all &= row;
  return all == ~std::uint32_t{0};
}

}  // namespace meniscus::tiles
#endif

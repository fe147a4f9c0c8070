#include "core/effects/depth_unsharp.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include "core/effects/rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/effects/depth_unsharp.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include "core/effects/surface_lanes.inl"

#ifndef MENISCUS_DEPTH_UNSHARP_ONCE
#define MENISCUS_DEPTH_UNSHARP_ONCE
namespace meniscus::effects {

/// Pixels of a row between the centres of the same two blocks.
struct BlockRun {
  int first, end;
  int low, high;  // blocks
};
struct UnsharpColumns {
  std::vector<BlockRun> runs;
  std::vector<float> shares;  // of the higher block, for each pixel
};

}  // namespace meniscus::effects
#endif

HWY_BEFORE_NAMESPACE();
namespace meniscus::effects::HWY_NAMESPACE {
namespace {

// Adds a row's nearness and numbers of surface pixels.
void addRow(const SurfacePlanes& planes, const Nearness& nearness, int row, float* sums, float* numbers) {
  const F f;
  const float* const from = planes.depth.data() + planes.rowStart(row);
  const auto width = static_cast<std::size_t>(planes.width);
  for (std::size_t x = 0; x < width; x += laneCount()) {
    const V depth = hn::LoadU(f, from + x);
    const M there = depth > hn::Zero(f);
    hn::StoreU(hn::LoadU(f, sums + x) + hn::IfThenElseZero(there, nearnessOf(nearness, depth)), f, sums + x);
    hn::StoreU(hn::LoadU(f, numbers + x) + hn::IfThenElseZero(there, all(1.0f)), f, numbers + x);
  }
}

// blocks: between the rows of blocks below and above.
void differencesOfRow(const SurfacePlanes& planes, const Nearness& nearness, const UnsharpColumns& columns,
                      const glm::vec2* blocks, int row, float* out) {
  const F f;
  const float* const from = planes.depth.data() + planes.rowStart(row);
  const auto lanes = static_cast<int>(laneCount());
  for (const BlockRun& run : columns.runs) {
    const glm::vec2 low = blocks[run.low], high = blocks[run.high];
    for (int x = run.first; x < run.end; x += lanes) {
      const V share = hn::LoadU(f, columns.shares.data() + x), depth = hn::LoadU(f, from + x);
      const V sum = mixed(all(low.x), all(high.x), share), number = mixed(all(low.y), all(high.y), share);
      const M wanted = hn::And(depth > hn::Zero(f), number > hn::Zero(f));
      const V difference = nearnessOf(nearness, depth) - sum / number;
      // What lies beyond the run is the next one's, which comes later.
      storeSome(f, hn::IfThenElseZero(wanted, difference),
                static_cast<std::size_t>(std::min(lanes, planes.width - x)), out + x);
    }
  }
}

}  // namespace
}  // namespace meniscus::effects::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meniscus::effects {

HWY_EXPORT(addRow);
HWY_EXPORT(differencesOfRow);

namespace {

/// The blocks of a target, and what they hold: sums of nearness (x) and numbers (y) of surface pixels.
struct Blocks {
  int firstX, firstY, columns, rows;
  std::vector<glm::vec2> sums;
  Blocks(const SurfacePlanes& planes, const glm::ivec4& grid)
      : firstX(grid.x / grid.z),
        firstY(grid.y / grid.z),
        columns((grid.x + planes.width - 1) / grid.z - firstX + 1),
        rows((grid.y + planes.height - 1) / grid.z - firstY + 1),
        sums(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), glm::vec2(0.0f)) {}
  glm::vec2* row(int y) {
    return sums.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(columns);
  }
  const glm::vec2* row(int y) const {
    return sums.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(columns);
  }
};

void sumRow(const SurfacePlanes& planes, const glm::ivec4& grid, const Nearness& nearness, int blockRow,
            Blocks& blocks) {
  const int side = grid.z;
  const int low = std::max((blockRow + blocks.firstY) * side - grid.y, 0),
            high = std::min((blockRow + blocks.firstY + 1) * side - grid.y, planes.height);
  thread_local std::vector<float> sums, numbers;  // of the pixels above each other
  for (std::vector<float>* values : {&sums, &numbers})
    values->assign(static_cast<std::size_t>(planes.width) + kMostLanes, 0.0f);
  for (int y = low; y < high; ++y)
    HWY_DYNAMIC_DISPATCH(addRow)(planes, nearness, y, sums.data(), numbers.data());
  const float share = 1 / static_cast<float>(side * side);
  glm::vec2* const out = blocks.row(blockRow);
  for (int x = 0, column = 0; x < planes.width; ++column) {
    const int end = std::min((column + blocks.firstX + 1) * side - grid.x, planes.width);
    glm::vec2 sum(0.0f);
    for (; x < end; ++x)
      sum += glm::vec2(sums[static_cast<std::size_t>(x)], numbers[static_cast<std::size_t>(x)]);
    out[column] = sum * share;
  }
}

// What lies outside of the target has no weight.
void blurAcross(const DepthUnsharpBlock& block, const glm::vec2* from, int count, glm::vec2* to) {
  for (int x = 0; x < count; ++x) {
    glm::vec2 sum = from[x] * block.taps[0];
    for (int i = 1; i < block.grid.w; ++i) {
      const float weight = block.taps[static_cast<std::size_t>(i)];
      if (x >= i) sum += from[x - i] * weight;
      if (x + i < count) sum += from[x + i] * weight;
    }
    to[x] = sum;
  }
}

void blurUp(const DepthUnsharpBlock& block, const Blocks& from, int y, glm::vec2* to) {
  const auto add = [&](int row, float weight) {
    const glm::vec2* values = from.row(row);
    for (int x = 0; x < from.columns; ++x) to[x] += values[x] * weight;
  };
  add(y, block.taps[0]);
  for (int i = 1; i < block.grid.w; ++i) {
    const float weight = block.taps[static_cast<std::size_t>(i)];
    if (y >= i) add(y - i, weight);
    if (y + i < from.rows) add(y + i, weight);
  }
}

// Where a pixel lies between the centres of two blocks.
struct Place {
  int low, high;
  float share;
};
Place placeOf(int pixel, int side, int first, int count) {
  const float place = (static_cast<float>(pixel) + 0.5f) / static_cast<float>(side) - 0.5f;
  const float corner = std::floor(place);
  const int block = static_cast<int>(corner) - first;
  return {std::clamp(block, 0, count - 1), std::clamp(block + 1, 0, count - 1), place - corner};
}

UnsharpColumns columnsOf(const SurfacePlanes& planes, const glm::ivec4& grid, const Blocks& blocks) {
  UnsharpColumns columns;
  for (int x = 0; x < planes.width; ++x) {
    const Place place = placeOf(x + grid.x, grid.z, blocks.firstX, blocks.columns);
    std::vector<BlockRun>& runs = columns.runs;
    if (runs.empty() || runs.back().low != place.low || runs.back().high != place.high)
      runs.push_back({x, x, place.low, place.high});
    runs.back().end = x + 1;
    columns.shares.push_back(place.share);
  }
  columns.shares.resize(columns.shares.size() + kMostLanes);
  return columns;
}

}  // namespace

void unsharpDepth(const SurfacePlanes& planes, const DepthUnsharpBlock& block,
                  std::vector<float>& difference) {
  difference.resize(planes.pixels());
  const Nearness nearness(planes.view);
  Blocks sums(planes, block.grid), across = sums, blurred = sums;
  tbb::parallel_for(0, sums.rows, [&](int y) {
    sumRow(planes, block.grid, nearness, y, sums);
    blurAcross(block, sums.row(y), sums.columns, across.row(y));
  });
  tbb::parallel_for(0, sums.rows, [&](int y) { blurUp(block, across, y, blurred.row(y)); });
  const UnsharpColumns columns = columnsOf(planes, block.grid, blurred);
  forRows(planes.height, [&](int y) {
    const Place row = placeOf(y + block.grid.y, block.grid.z, blurred.firstY, blurred.rows);
    const glm::vec2 *below = blurred.row(row.low), *above = blurred.row(row.high);
    thread_local std::vector<glm::vec2> between;
    between.resize(static_cast<std::size_t>(blurred.columns));
    for (std::size_t i = 0; i < between.size(); ++i) between[i] = glm::mix(below[i], above[i], row.share);
    HWY_DYNAMIC_DISPATCH(differencesOfRow)
    (planes, nearness, columns, between.data(), y, difference.data() + planes.rowStart(y));
  });
}

}  // namespace meniscus::effects
#endif

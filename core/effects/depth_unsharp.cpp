#include "core/effects/depth_unsharp.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "core/effects/nearness.h"

namespace meniscus::effects {

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
  glm::vec2* const out = blocks.row(blockRow);
  for (int y = low; y < high; ++y) {
    const float* depth = planes.depth.data() + planes.rowStart(y);
    for (int x = 0, column = 0; x < planes.width; ++column) {
      const int end = std::min((column + blocks.firstX + 1) * side - grid.x, planes.width);
      glm::vec2 sum(0.0f);
      for (; x < end; ++x) sum += glm::vec2(nearness(depth[x]), depth[x] > 0 ? 1.0f : 0.0f);
      out[column] += sum;
    }
  }
  const float share = 1 / static_cast<float>(side * side);
  for (int column = 0; column < blocks.columns; ++column) out[column] *= share;
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
  std::vector<Place> columns;
  for (int x = 0; x < planes.width; ++x)
    columns.push_back(placeOf(x + block.grid.x, block.grid.z, blurred.firstX, blurred.columns));
  tbb::parallel_for(0, planes.height, [&](int y) {
    const Place row = placeOf(y + block.grid.y, block.grid.z, blurred.firstY, blurred.rows);
    const glm::vec2 *below = blurred.row(row.low), *above = blurred.row(row.high);
    const std::size_t first = planes.rowStart(y);
    for (std::size_t x = 0; x < columns.size(); ++x) {
      const float depth = planes.depth[first + x];
      difference[first + x] = 0;
      if (!(depth > 0)) continue;
      const Place& p = columns[x];
      const glm::vec2 sum = glm::mix(glm::mix(below[p.low], below[p.high], p.share),
                                     glm::mix(above[p.low], above[p.high], p.share), row.share);
      if (sum.y > 0) difference[first + x] = nearness(depth) - sum.x / sum.y;
    }
  });
}

}  // namespace meniscus::effects

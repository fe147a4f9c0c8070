#include "render/surface/peel_regions.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace meniscus {

namespace {

// Side of the smallest cell [pixels]: a smaller one would cost more to set up than to draw.
constexpr int kLeastCell = 16;

// Where the grid's line i lies, of `side` + 1 over `size` pixels.
int gridLine(int i, int side, int size) {
  return static_cast<int>(std::int64_t{size} * i / side);
}

struct Column {
  int from, to;  // in the region
};

// The columns (or rows) of the target's grid, as far as they lie in the region.
std::vector<Column> columnsOf(int side, int target, int from, int size) {
  std::vector<Column> out;
  const int count = std::clamp(side, 1, std::max(target / kLeastCell, 1));
  for (int i = 0; i < count; ++i) {
    const int low = std::max(gridLine(i, count, target) - from, 0);
    const int high = std::min(gridLine(i + 1, count, target) - from, size);
    if (low < high) out.push_back({low, high});
  }
  return out;
}

// Which columns [from, to] touches: first and one past the last.
std::pair<std::size_t, std::size_t> touched(const std::vector<Column>& columns, float from, float to) {
  const auto first = std::partition_point(columns.begin(), columns.end(),
                                          [&](const Column& c) { return static_cast<float>(c.to) <= from; });
  const auto last = std::partition_point(first, columns.end(),
                                         [&](const Column& c) { return static_cast<float>(c.from) < to; });
  return {static_cast<std::size_t>(first - columns.begin()),
          static_cast<std::size_t>(last - columns.begin())};
}

}  // namespace

std::vector<ScreenRect> splitRect(const ScreenRect& rect, std::int64_t mostPixels) {
  if (rect.pixels() <= std::max<std::int64_t>(mostPixels, 1)) return {rect};
  ScreenRect a = rect, b = rect;
  if (rect.width > rect.height) {
    a.width = rect.width / 2;
    b.x += a.width;
    b.width -= a.width;
  } else {
    a.height = rect.height / 2;
    b.y += a.height;
    b.height -= a.height;
  }
  std::vector<ScreenRect> out = splitRect(a, mostPixels);
  for (const ScreenRect& part : splitRect(b, mostPixels)) out.push_back(part);
  return out;
}

std::vector<PeelCell> makeCells(const ProjectedField& field, const ScreenRect& target,
                                const ScreenRect& region, int side, std::vector<PeelInstance>& instances) {
  const std::vector<Column> columns = columnsOf(side, target.width, region.x, region.width);
  const std::vector<Column> rows = columnsOf(side, target.height, region.y, region.height);
  std::vector<PeelCell> cells;
  for (const Column& row : rows)
    for (const Column& column : columns)
      cells.push_back({{column.from, row.from, column.to - column.from, row.to - row.from}});

  const glm::vec4 shift(region.x, region.y, region.x, region.y);
  const auto forEachCell = [&](auto f) {
    for (std::size_t i = 0; i < field.balls.size(); ++i) {
      const glm::vec4 box = field.boxes[i] - shift;
      const auto [left, right] = touched(columns, box.x, box.z);
      const auto [low, high] = touched(rows, box.y, box.w);
      for (std::size_t y = low; y < high; ++y)
        for (std::size_t x = left; x < right; ++x) f(i, box, cells[y * columns.size() + x]);
    }
  };
  forEachCell([](std::size_t, const glm::vec4&, PeelCell& cell) { ++cell.count; });
  int total = 0;
  for (PeelCell& cell : cells) {
    cell.first = total;
    total += cell.count;
    cell.count = 0;
  }
  instances.resize(static_cast<std::size_t>(total));
  forEachCell([&](std::size_t i, const glm::vec4& box, PeelCell& cell) {
    const int at = cell.first + cell.count++;
    const ProjectedBall& ball = field.balls[i];
    instances[static_cast<std::size_t>(at)] = {
        box, ball.pixel, ball.place, ball.eye, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(at)};
    cell.crossesNear = cell.crossesNear || field.depths[i].x < field.nearDepth;
  });
  std::erase_if(cells, [](const PeelCell& cell) { return cell.count == 0; });
  return cells;
}

StretchRange stretchRange(const View& view, const Tile& tile, const ScreenRect& region,
                          const ScreenRect& cell) {
  if (view.projection == Projection::orthographic) return {};
  const glm::dvec2 low(tile.x + region.x + cell.x - 1, tile.y + region.y + cell.y - 1);
  const glm::dvec2 high = low + glm::dvec2(cell.width + 2, cell.height + 2);
  const auto stretchAt = [&](const glm::dvec2& pixel) {
    const glm::dvec2 slope = (pixel - view.center) * view.pixelSize;
    return std::sqrt(1 + glm::dot(slope, slope));
  };
  const glm::dvec2 far = glm::max(glm::abs(low - view.center), glm::abs(high - view.center));
  return {stretchAt(glm::clamp(view.center, low, high)), stretchAt(view.center + far)};
}

// Shaders round places to the nearest step, and have computed them in float32.
constexpr double kSlackSteps = 64, kSlackShare = 2e-6;

double stepAtLeast(double depth, const StretchRange& stretch, double step) {
  const double steps = depth * (depth > 0 ? stretch.least : stretch.largest) / step;
  return std::clamp(kMiddleStep + steps - kSlackSteps - kSlackShare * std::abs(steps), kFirstStep, kMostStep);
}

double stepAtMost(double depth, const StretchRange& stretch, double step) {
  const double steps = depth * (depth > 0 ? stretch.largest : stretch.least) / step;
  return kMiddleStep + steps + kSlackSteps + kSlackShare * std::abs(steps);
}

void addUnfinished(const PeelCell& cell, const ScreenRect& region, const std::vector<std::uint32_t>& blocks,
                   std::uint32_t layer, const StepInstance& model, std::vector<StepInstance>& out,
                   ScreenRect& reach) {
  const ScreenRect& r = cell.rect;
  const int right = r.x + r.width, top = r.y + r.height, along = blocksAlong(region.width);
  int lowX = right, lowY = top, highX = r.x, highY = r.y;
  for (int y = r.y; y < top;) {
    const int row = y / kBlockSide, nextY = std::min((row + 1) * kBlockSide, top);
    int start = right;  // of the run that is open
    const auto close = [&](int end) {
      if (start >= end) return;
      out.push_back(model);
      out.back().box = glm::vec4(start, y, end, nextY);
      lowX = std::min(lowX, start);
      highX = std::max(highX, end);
      lowY = std::min(lowY, y);
      highY = nextY;
      start = right;
    };
    for (int x = r.x; x < right;) {
      const int column = x / kBlockSide;
      const bool alive = blocks[static_cast<std::size_t>(row) * static_cast<std::size_t>(along) +
                                static_cast<std::size_t>(column)] == layer;
      if (alive && start == right) start = x;
      if (!alive) close(x);
      x = std::min((column + 1) * kBlockSide, right);
    }
    close(right);
    y = nextY;
  }
  reach = {lowX, lowY, std::max(highX - lowX, 0), std::max(highY - lowY, 0)};
}

void keepSeen(std::vector<PeelCell>& cells, std::vector<PeelInstance>& instances,
              const std::vector<std::uint32_t>& seen) {
  std::size_t kept = 0;
  for (PeelCell& cell : cells) {
    const auto first = static_cast<std::size_t>(cell.first),
               end = first + static_cast<std::size_t>(cell.count);
    cell.first = static_cast<int>(kept);
    for (std::size_t i = first; i < end; ++i)
      if (seen[i] != 0) instances[kept++] = instances[i];
    cell.count = static_cast<int>(kept) - cell.first;
  }
  instances.resize(kept);
  std::erase_if(cells, [](const PeelCell& cell) { return cell.count == 0; });
}

}  // namespace meniscus

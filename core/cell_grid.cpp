#include "core/cell_grid.h"

#include <bit>
#include <glm/common.hpp>

namespace meniscus {
namespace {

std::uint64_t hashOf(glm::ivec3 at) {
  std::uint64_t h = static_cast<std::uint32_t>(at.x);
  h = (h << 21) ^ static_cast<std::uint32_t>(at.y) ^ (h >> 11);
  h = h * 0x9E3779B97F4A7C15u ^ static_cast<std::uint32_t>(at.z);
  h ^= h >> 32;
  h *= 0xD6E8FEB86659FD93u;
  return h ^ (h >> 32);
}

}  // namespace

CellGrid::CellGrid(std::span<const glm::dvec3> points, double size) : size_(size) {
  slots_.assign(std::bit_ceil(points.size() * 2 + 2), 0);
  cellOfPoint_.resize(points.size());
  if (points.empty()) return;
  glm::dvec3 low = points[0];
  for (const glm::dvec3& p : points) low = glm::min(low, p);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::ivec3 at((points[i] - low) / size);
    const std::size_t slot = slotOf(at);
    if (slots_[slot] == 0) {
      cells_.push_back({at, {}});
      slots_[slot] = static_cast<std::uint32_t>(cells_.size());
    }
    cellOfPoint_[i] = slots_[slot] - 1;
    ++cells_[cellOfPoint_[i]].points.count;
  }
  std::uint32_t first = 0;
  for (Cell& cell : cells_) {
    cell.points.first = first;
    first += cell.points.count;
    cell.points.count = 0;
  }
  points_.resize(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    IndexRange& range = cells_[cellOfPoint_[i]].points;
    points_[range.first + range.count++] = i;
  }
}

std::int64_t CellGrid::neighborOf(std::size_t cell, glm::ivec3 offset) const {
  const std::size_t slot = slotOf(cells_[cell].at + offset);
  return static_cast<std::int64_t>(slots_[slot]) - 1;
}

std::size_t CellGrid::slotOf(glm::ivec3 at) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = static_cast<std::size_t>(hashOf(at)) & mask;
  while (slots_[slot] != 0 && cells_[slots_[slot] - 1].at != at) slot = (slot + 1) & mask;
  return slot;
}

}  // namespace meniscus

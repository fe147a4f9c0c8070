#pragma once
// Points sorted into cubic cells, found by hashing, so that memory and time are linear in points however far
// apart they lie.

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/molecule.h"

namespace meniscus {

class CellGrid {
 public:
  /// Points must be finite; the extent divided by `size` [Å] must stay below 2^31.
  CellGrid(std::span<const glm::dvec3> points, double size);

  std::size_t cellCount() const { return cells_.size(); }
  double size() const { return size_; }
  /// Indices of the points in a cell, ascending.
  std::span<const std::uint32_t> pointsOf(std::size_t cell) const {
    return {points_.data() + cells_[cell].points.first, cells_[cell].points.count};
  }
  std::size_t cellOf(std::uint32_t point) const { return cellOfPoint_[point]; }
  /// The cell at an offset from another one; -1 if it holds no point.
  std::int64_t neighborOf(std::size_t cell, glm::ivec3 offset) const;

 private:
  struct Cell {
    glm::ivec3 at{0};
    IndexRange points;
  };
  std::size_t slotOf(glm::ivec3 at) const;

  double size_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> points_;
  std::vector<std::uint32_t> cellOfPoint_;
  std::vector<std::uint32_t> slots_;  ///< open addressing: cell index + 1, 0 = free
};

}  // namespace meniscus

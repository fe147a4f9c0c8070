#pragma once
// Where on a grid a field's surface may be: its range over a box is bounded ball by ball, and a box in which
// that does not decide the sign is halved along each side, down to blocks of a few cubes.

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/mesh/field_sum.h"
#include "core/metaball_field.h"

namespace meniscus::mesh {

inline constexpr int kBlockSide = 4;  ///< cubes along a block's side
inline constexpr int kMostGridSide = 1 << 20;

/// Nodes of the grid lie at base + spacing * (i, j, k).
struct Grid {
  glm::dvec3 base{0.0};
  double spacing = 1;
  int side = kBlockSide;  ///< cubes along each axis, a power of two
  double coordinate(int axis, int index) const { return base[axis] + spacing * index; }
};

struct ActiveBlock {
  std::uint64_t key;                 ///< of its place
  glm::ivec3 first;                  ///< its least node
  std::vector<std::uint32_t> balls;  ///< all that reach into it, ascending
};

std::uint64_t blockKey(const glm::ivec3& firstNode);

/// All blocks that the surface may meet, by ascending key. Throws InputError naming the spacing if they are
/// more than mostBlocks.
std::vector<ActiveBlock> findActiveBlocks(const MetaballField& field, std::span<const WideBall> balls,
                                          const Grid& grid, std::size_t mostBlocks);

}  // namespace meniscus::mesh

#pragma once
// Lists of screen tiles in buffers, for shaders (shaders/include/tile_lists.glsl).

#include <array>
#include <glm/vec4.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "core/tiles/tile_target.h"
#include "render/gl/storage.h"

namespace meniscus {

/// The lists of a block of tiles, tile after tile: numbers of what a tile's rays can meet, in order.
struct TileBlockEntries {
  std::vector<std::uint32_t> entries;
  std::array<std::uint32_t, tiles::kTilesPerBlock> counts{};
};

class TileListBuffers {
 public:
  /// blocks: of the grid, which covers `area`. Throws InputError, saying what to use instead, if the driver's
  /// buffers are too small.
  void upload(const tiles::TileGrid& grid, const tiles::PixelArea& area,
              std::span<const TileBlockEntries> blocks, std::string_view instead);
  /// Storage 1 and 7.
  void bind() const;

  /// x, y: from a pixel of the target to one of the grid; z: tiles in a row; w: 0.
  const glm::ivec4& grid() const { return grid_; }
  std::size_t entries() const { return entryCount_; }
  std::size_t longest() const { return longest_; }
  std::uint64_t bytes() const { return entries_.bytes() + lists_.bytes(); }

 private:
  gl::Storage entries_, lists_;
  glm::ivec4 grid_{0};
  std::size_t entryCount_ = 0, longest_ = 0;
};

}  // namespace meniscus

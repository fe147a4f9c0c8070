#include "render/tile_list_buffers.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/vec2.hpp>

#include "core/error.h"

namespace meniscus {

void TileListBuffers::upload(const tiles::TileGrid& grid, const tiles::PixelArea& area,
                             std::span<const TileBlockEntries> blocks, std::string_view instead) {
  grid_ = {area.x - grid.x, area.y - grid.y, grid.columns, 0};
  entryCount_ = longest_ = 0;
  for (const TileBlockEntries& block : blocks) entryCount_ += block.entries.size();
  if (4 * entryCount_ > static_cast<std::uint64_t>(gl::queryLimits().storageBlock))
    throw InputError(
        fmt::format("the lists of all screen tiles take {} MiB, more than this driver's buffers hold; use {}",
                    4 * entryCount_ >> 20, instead));
  std::vector<std::uint32_t> entries;
  entries.reserve(entryCount_);
  std::vector<glm::uvec2> lists(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows),
                                glm::uvec2(0));
  for (int b = 0; b < grid.blocks(); ++b) {
    const TileBlockEntries& block = blocks[static_cast<std::size_t>(b)];
    auto first = static_cast<std::uint32_t>(entries.size());
    for (int t = 0; t < tiles::kTilesPerBlock; ++t) {
      const std::uint32_t count = block.counts[static_cast<std::size_t>(t)];
      if (count == 0) continue;
      const glm::ivec2 at = (grid.corner(b, t) - glm::ivec2(grid.x, grid.y)) / tiles::kTileSize;
      lists[static_cast<std::size_t>(at.y * grid.columns + at.x)] = {first, count};
      first += count;
      longest_ = std::max<std::size_t>(longest_, count);
    }
    entries.insert(entries.end(), block.entries.begin(), block.entries.end());
  }
  entries_.reserve(std::max<std::size_t>(4 * entries.size(), 4));
  entries_.write(entries.data(), 4 * entries.size());
  lists_.reserve(sizeof(glm::uvec2) * lists.size());
  lists_.write(lists.data(), sizeof(glm::uvec2) * lists.size());
}

void TileListBuffers::bind() const {
  entries_.bindStorage(1);
  lists_.bindStorage(7);
}

}  // namespace meniscus

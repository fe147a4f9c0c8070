#pragma once
// Which primitives a tile's rays can meet, nearest first, and none that an opaque front hides from all of
// them. Built in parallel: bounds of every primitive, one bucket sort by the nearest depth, distribution to
// blocks of tiles, then each block by itself, front to back. A tile keeps the cells (pixels) that discs
// inside its primitives cover whole; once all are covered, what lies behind the farthest of these discs is
// not listed any more, so the lists hold what can be seen and little else, however deep the scene.

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/tiles/tile_target.h"

namespace meniscus::tiles {

/// Where a primitive can be seen.
struct Placement {
  std::int16_t x0 = 0, y0 = 0, x1 = -1, y1 = -1;          ///< tiles of the grid, both ends included
  float front = -std::numeric_limits<float>::infinity();  ///< view-space z that none of its points exceeds;
                                                          ///< -infinity: nowhere
};

/// A disc across the view (pixels of the picture) that hides what lies below z in view space. radius 0: none.
struct Occluder {
  double x = 0, y = 0;
  float radius = 0, z = 0;
};

/// Primitives of any kind, by index.
class TileSource {
 public:
  virtual ~TileSource() = default;
  virtual std::size_t size() const = 0;
  /// The placements of [first, last). Called from several threads.
  virtual void place(std::size_t first, std::size_t last, Placement* out) const = 0;
  virtual Occluder occluder(std::size_t index) const = 0;
};

/// The lists of a block of tiles.
struct TileBlock {
  std::vector<std::uint32_t> members;  ///< primitives that any of its tiles lists, nearest bucket first
  std::vector<std::uint32_t> entries;  ///< indices into members, tile after tile
  std::array<std::uint32_t, kTilesPerBlock + 1> first{};  ///< of a tile's entries

  std::span<const std::uint32_t> list(int tile) const {
    const auto t = static_cast<std::size_t>(tile);
    return std::span(entries).subspan(first[t], first[t + 1] - first[t]);
  }
};

class TileLists {
 public:
  /// cut: whether a tile's list ends where its front is opaque (off: every primitive that may touch it).
  void build(const TileSource& source, const TileTarget& target, bool cut = true);

  const TileGrid& grid() const { return grid_; }
  const TileBlock& block(int index) const { return blocks_[static_cast<std::size_t>(index)]; }
  /// How much nearer a later entry of a list can be than an earlier one [Å].
  float slack() const { return bucketDepth_ * 1.001f; }
  /// The smallest part of an area that holds all blocks with entries; one pixel if none has any.
  PixelArea occupied(const PixelArea& area) const;
  std::size_t entryCount() const;
  std::uint64_t bytes() const;

 private:
  struct Placed {
    Placement place;
    std::uint32_t index;
  };
  void sortByDepth(const TileSource& source);
  void distribute();
  void fillBlock(int index, const TileSource& source, bool cut);
  std::uint32_t bucketOf(float front) const;

  TileGrid grid_{PixelArea{}};
  float nearZ_ = 0, bucketDepth_ = 0;
  std::uint32_t buckets_ = 1;
  std::vector<Placed> unsorted_, sorted_;
  std::vector<std::uint32_t> blockEntries_;  // positions in sorted_, block after block
  std::vector<std::size_t> blockFirst_;
  std::vector<TileBlock> blocks_;
};

}  // namespace meniscus::tiles

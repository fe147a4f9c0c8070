#pragma once
// Which parts of a tile are covered: cells, sixteenths of a pixel, marked by the discs inside primitives.

#include <array>
#include <cstdint>

#include "core/tiles/tile_target.h"

namespace meniscus::tiles {

inline constexpr int kCellsPerPixel = 4;  ///< along a side: fine enough for atoms of a fifth of a pixel
inline constexpr int kTileCells = kTileSize * kCellsPerPixel;
/// A bit for each cell of a tile, row by row.
using TileCells = std::array<std::uint32_t, kTileCells>;
static_assert(kTileCells == 32);

/// A smaller disc covers no cell: half a cell's diagonal [pixels].
inline constexpr float kLeastDisc = 0.70f / kCellsPerPixel;

/// Marks the cells that lie in a disc. x, y: its centre relative to the tile's corner [pixels]. Returns
/// whether any is new.
bool coverCells(TileCells& cells, float x, float y, float radius);
bool allCovered(const TileCells& cells);

}  // namespace meniscus::tiles

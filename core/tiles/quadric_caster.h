#pragma once
// Casts the rays of a tile into its list of quadrics, by the widest vectors that the processor has.

#include <cstdint>
#include <span>

#include "core/tiles/quadric_source.h"
#include "core/tiles/tile_rays.h"

namespace meniscus::tiles {

/// list: indices into records, nearest bucket first; slack: of TileLists. What is wanted of `out` is written,
/// background included. Returns whether anything was hit.
bool castQuadrics(std::span<const QuadricRecord> records, std::span<const std::uint32_t> list, float slack,
                  const TileRays& rays, const PlaneChannels& channels, TilePixels& out);

}  // namespace meniscus::tiles

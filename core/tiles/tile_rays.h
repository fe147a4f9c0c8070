#pragma once
// The rays through a tile's pixels, as the casters take them: float32, relative to the tile's lower left
// corner.

#include "core/tiles/tile_target.h"

namespace meniscus::tiles {

struct TileRays {
  alignas(64) float laneX[kTilePixels];  ///< pixel coordinates of each ray relative to the corner
  alignas(64) float laneY[kTilePixels];
  double cornerX, cornerY;  ///< the corner in pixels of the picture, with the sample's shift
  double slopeXExact, slopeYExact, pixelSizeExact, eyeZExact;
  float slopeX, slopeY;     ///< of the ray through the corner (perspective)
  float pixelSize;          ///< at unit depth (perspective) | in Å
  float nearZ, farZ, eyeZ;  ///< view space
  float depthFactor;        ///< of the depth value
  bool perspective;
};

/// How lanes are laid over a tile: row by row, or in squares of 4 x 4 of 2 x 2.
enum class LaneOrder : std::uint8_t { rows, squares };

/// All but what depends on the tile.
TileRays makeRays(const TileTarget& target, LaneOrder order);
/// x, y: pixel coordinates of the tile's lower left corner.
void moveRays(TileRays& rays, const TileTarget& target, int x, int y);
/// Where lane k of a tile lies.
int lanePixelX(LaneOrder order, int lane);
int lanePixelY(LaneOrder order, int lane);

/// What a tile's rays met, in rows from the bottom (LaneOrder::rows), in the formats of Planes.
struct TilePixels {
  alignas(64) float depth[kTilePixels];
  alignas(64) float distance[kTilePixels];
  alignas(64) std::uint32_t albedo[kTilePixels], normal[kTilePixels], id[kTilePixels];
};
/// Copies a tile into planes; what lies outside their area is left out. x, y: the tile's lower left corner.
void storeTile(const TilePixels& pixels, int x, int y, Planes& planes);
/// The same of a tile that shows the background.
void clearTile(int x, int y, Planes& planes);

}  // namespace meniscus::tiles

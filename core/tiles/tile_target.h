#pragma once
// What the tile casters draw and where it goes: a rectangle of a picture as seen from a View, and the planes
// of a G-buffer in main memory.
//
// A picture is cut into square tiles of kTileSize pixels, counted from the picture's own lower left corner,
// and into blocks of kBlockTiles x kBlockTiles tiles. What a pixel shows depends on its tile alone, so a
// picture that is drawn in parts has the same bytes as one drawn at once.

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "core/view.h"

namespace meniscus::tiles {

inline constexpr int kTileSize = 8;    ///< pixels; measured: docs/measured/tiles.md
inline constexpr int kBlockTiles = 8;  ///< tiles along a block's side
inline constexpr int kTilePixels = kTileSize * kTileSize;
inline constexpr int kTilesPerBlock = kBlockTiles * kBlockTiles;

/// Pixels of the whole picture: lower left corner and size.
struct PixelArea {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const PixelArea&) const = default;
};

/// What is drawn at once.
struct TileTarget {
  View view;
  glm::dvec3 origin{0.0};  ///< Primitives::origin
  PixelArea area;
  glm::vec2 sampleShift{0.0f};  ///< of every ray within its pixel, at most half a pixel
  bool thinned = false;  ///< few balls may stand for many quadrics smaller than a pixel (detail_levels.h)
};

/// Whether the same primitives make the same lists: all but the shift of the rays is the same.
bool sameLists(const TileTarget& a, const TileTarget& b);

/// Channels that are wanted; depth always is.
struct PlaneChannels {
  bool albedo = true, normal = true, id = true, distance = false;
  bool operator==(const PlaneChannels&) const = default;
};

/// Which part of a target is wanted: all of it, or that outside of which there is nothing but background.
enum class Extent : std::uint8_t { occupied, whole };

/// Texels beyond the last pixel of planes, so that vectors may be read there.
inline constexpr std::size_t kPlanePadding = 16;

/// The channels of a part of a G-buffer (render/gbuffer.h), rows from the bottom, in the same formats. Those
/// that are not wanted are empty.
struct Planes {
  PixelArea area;
  PlaneChannels channels;
  std::vector<float> depth;           ///< reversed z; 0 = background
  std::vector<std::uint32_t> albedo;  ///< bytes R, G, B, 255; 0 = background
  std::vector<std::uint32_t> normal;  ///< octahedral, 16 bits each, x in the lower; 0 = background
  std::vector<std::uint32_t> id;      ///< 0 = background
  std::vector<float> distance;        ///< along the unit ray [Å]; +infinity = background

  /// Makes room; contents are not set.
  void resize(const PixelArea& newArea, const PlaneChannels& wanted);
  std::size_t pixels() const {
    return static_cast<std::size_t>(area.width) * static_cast<std::size_t>(area.height);
  }
  std::uint64_t bytes() const;
};

/// Keeps of each pixel what is nearer, and of two that are as near the first. Both must have the same area
/// and channels.
void mergeNearer(Planes& planes, const Planes& others);

/// The tiles that cover an area, and the blocks that cover the tiles.
struct TileGrid {
  int x = 0, y = 0;  ///< pixel of the first tile's lower left corner
  int columns = 0, rows = 0;
  int blockColumns = 0, blockRows = 0;

  explicit TileGrid(const PixelArea& area);
  int blocks() const { return blockColumns * blockRows; }
  /// Pixel coordinates of a tile's lower left corner, by its block and its place in the block; {-1, -1}
  /// outside of the grid.
  glm::ivec2 corner(int block, int tile) const;
};

}  // namespace meniscus::tiles

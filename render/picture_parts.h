#pragma once
// How a picture is cut into parts that are drawn at once, so that one of any size takes a bounded memory.

#include "core/image.h"
#include "render/view_block.h"

namespace meniscus {

struct TileSize {
  int width, height;
};

/// Of a part without the margin that is drawn around it. maxTileSize: largest side [pixels]; 0 = what the
/// driver allows. A context must be current.
TileSize chooseTileSize(ImageSize picture, int bytesPerRowPixel, int maxTileSize, int margin = 0);

/// A part grown by what its pixels' effects look at, as far as the picture goes.
Tile withMargin(const Tile& tile, int margin, ImageSize picture);

}  // namespace meniscus

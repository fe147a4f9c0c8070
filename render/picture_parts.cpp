#include "render/picture_parts.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "render/gl/objects.h"

namespace meniscus {

namespace {

// A tile's G-buffer, sum and picture take about 40 bytes a pixel: at most 320 MiB.
constexpr std::int64_t kTilePixels = std::int64_t{8} << 20;
// Finished rows wait for the ones beside them: at most 128 MiB, unless one row alone is larger.
constexpr std::int64_t kBandBytes = std::int64_t{128} << 20;

}  // namespace

TileSize chooseTileSize(ImageSize picture, int bytesPerRowPixel, int maxTileSize, int margin) {
  const gl::Limits limits = gl::queryLimits();
  int side = std::min({limits.textureSize, limits.viewportWidth, limits.viewportHeight}) - 2 * margin;
  if (maxTileSize > 0) side = std::min(side, maxTileSize);
  // With a wide margin larger and squarer, or most of what is drawn would be margin.
  const std::int64_t pixels = std::max(kTilePixels, std::int64_t{16} * margin * margin);
  int width = std::min(picture.width, side);
  if (margin > 0 && std::int64_t{4} * margin * (width + 2 * margin) > pixels) {
    width = std::min(width, static_cast<int>(std::sqrt(static_cast<double>(pixels))) - 2 * margin);
  }
  const std::int64_t rows =
      std::min(pixels / (width + 2 * margin) - 2 * margin,
               kBandBytes / (static_cast<std::int64_t>(picture.width) * bytesPerRowPixel));
  return {width, static_cast<int>(std::clamp<std::int64_t>(rows, 1, std::min(picture.height, side)))};
}

Tile withMargin(const Tile& tile, int margin, ImageSize picture) {
  const int left = std::min(margin, tile.x), below = std::min(margin, tile.y);
  const int right = std::min(margin, picture.width - tile.x - tile.width);
  const int above = std::min(margin, picture.height - tile.y - tile.height);
  return {tile.x - left, tile.y - below, left + tile.width + right, below + tile.height + above};
}

}  // namespace meniscus

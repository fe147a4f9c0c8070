#include "core/tiles/tile_target.h"

namespace meniscus::tiles {

bool sameLists(const TileTarget& a, const TileTarget& b) {
  const View& v = a.view;
  const View& w = b.view;
  return v.projection == w.projection && v.rotation == w.rotation && v.pivot == w.pivot &&
         v.distance == w.distance && v.pixelSize == w.pixelSize && v.center == w.center &&
         v.nearZ == w.nearZ && v.farZ == w.farZ && a.origin == b.origin && a.area == b.area;
}

void Planes::resize(const PixelArea& newArea, const PlaneChannels& wanted) {
  area = newArea;
  channels = wanted;
  const std::size_t pixels = static_cast<std::size_t>(area.width) * static_cast<std::size_t>(area.height);
  depth.resize(pixels);
  albedo.resize(wanted.albedo ? pixels : 0);
  normal.resize(wanted.normal ? pixels : 0);
  id.resize(wanted.id ? pixels : 0);
  distance.resize(wanted.distance ? pixels : 0);
}

std::uint64_t Planes::bytes() const {
  return 4 * (depth.size() + albedo.size() + normal.size() + id.size() + distance.size());
}

namespace {
int floorDivide(int a, int b) {
  return a >= 0 ? a / b : -((-a + b - 1) / b);
}
int ceilDivide(int a, int b) {
  return -floorDivide(-a, b);
}
}  // namespace

TileGrid::TileGrid(const PixelArea& area)
    : x(floorDivide(area.x, kTileSize) * kTileSize),
      y(floorDivide(area.y, kTileSize) * kTileSize),
      columns(ceilDivide(area.x + area.width - x, kTileSize)),
      rows(ceilDivide(area.y + area.height - y, kTileSize)),
      blockColumns(ceilDivide(columns, kBlockTiles)),
      blockRows(ceilDivide(rows, kBlockTiles)) {}

glm::ivec2 TileGrid::corner(int block, int tile) const {
  const int column = block % blockColumns * kBlockTiles + tile % kBlockTiles,
            row = block / blockColumns * kBlockTiles + tile / kBlockTiles;
  if (column >= columns || row >= rows) return {-1, -1};
  return {x + column * kTileSize, y + row * kTileSize};
}

}  // namespace meniscus::tiles

#include "core/tiles/tile_target.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "core/error.h"

namespace meniscus::tiles {

bool sameLists(const TileTarget& a, const TileTarget& b) {
  const View& v = a.view;
  const View& w = b.view;
  return v.projection == w.projection && v.rotation == w.rotation && v.pivot == w.pivot &&
         v.distance == w.distance && v.pixelSize == w.pixelSize && v.center == w.center &&
         v.nearZ == w.nearZ && v.farZ == w.farZ && a.origin == b.origin && a.area == b.area &&
         a.thinned == b.thinned;
}

void Planes::resize(const PixelArea& newArea, const PlaneChannels& wanted) {
  area = newArea;
  channels = wanted;
  const std::size_t texels = pixels() + kPlanePadding;
  depth.resize(texels);
  albedo.resize(wanted.albedo ? texels : 0);
  normal.resize(wanted.normal ? texels : 0);
  id.resize(wanted.id ? texels : 0);
  distance.resize(wanted.distance ? texels : 0);
}

void mergeNearer(Planes& planes, const Planes& others) {
  MENISCUS_CHECK(planes.area == others.area && planes.channels == others.channels);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, planes.pixels(), 1 << 14),
                    [&](const tbb::blocked_range<std::size_t>& part) {
                      const auto keep = [&](auto& plane, const auto& other) {
                        if (plane.empty()) return;
                        for (std::size_t i = part.begin(); i < part.end(); ++i)
                          plane[i] = others.depth[i] > planes.depth[i] ? other[i] : plane[i];
                      };
                      keep(planes.albedo, others.albedo);
                      keep(planes.normal, others.normal);
                      keep(planes.id, others.id);
                      keep(planes.distance, others.distance);
                      keep(planes.depth, others.depth);  // last: it decides
                    });
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

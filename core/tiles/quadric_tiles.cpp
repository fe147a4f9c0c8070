#include "core/tiles/quadric_tiles.h"

#include <tbb/parallel_for.h>

#include <utility>

#include "core/tiles/quadric_caster.h"
#include "core/tiles/quadric_source.h"

namespace meniscus::tiles {

void QuadricTiles::setPrimitives(std::shared_ptr<DetailLevels> levels) {
  levels_ = std::move(levels);
  valid_ = false;
}

void QuadricTiles::setPrimitives(const Primitives* primitives) {
  setPrimitives(levelsOf(*primitives));
}

void QuadricTiles::cast(const TileTarget& target, const PlaneChannels& channels, Planes& planes,
                        Extent extent) {
  const DetailLevels::Level all = levels_->level(levels_->levelFor(target));
  const QuadricSource source(*all.primitives, target);
  if (!valid_ || !sameLists(listed_, target)) {
    lists_.build(source, *all.clusters, target);
    listed_ = target;
    valid_ = true;
    ++builds_;
  }
  planes.resize(extent == Extent::whole ? target.area : lists_.occupied(target.area), channels);
  const TileGrid& grid = lists_.grid();
  tbb::parallel_for(0, grid.blocks(), [&](int b) {
    const TileBlock& block = lists_.block(b);
    thread_local std::vector<QuadricRecord> records;
    makeRecords(source, block, records);
    TileRays rays = makeRays(target, LaneOrder::rows);
    TilePixels pixels;
    for (int t = 0; t < kTilesPerBlock; ++t) {
      const glm::ivec2 corner = grid.corner(b, t);
      if (corner.x < 0) continue;
      const std::span<const std::uint32_t> list = block.list(t);
      if (list.empty()) {
        clearTile(corner.x, corner.y, planes);
        continue;
      }
      moveRays(rays, target, corner.x, corner.y);
      castQuadrics(records, list, lists_.slack(), rays, channels, pixels);
      storeTile(pixels, corner.x, corner.y, planes);
    }
  });
}

}  // namespace meniscus::tiles

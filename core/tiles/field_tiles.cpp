#include "core/tiles/field_tiles.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bitset>
#include <utility>

namespace meniscus::tiles {

void FieldTiles::setField(const MetaballField* field, std::shared_ptr<const Clusters> clusters) {
  field_ = field;
  clusters_ = std::move(clusters);
  valid_ = wholeValid_ = false;
}

void FieldTiles::setField(const MetaballField* field) {
  setField(field, std::make_shared<const Clusters>(clustersOf(*field)));
}

namespace {

using Tiles = std::bitset<kTilesPerBlock>;

// Casts some tiles of a block. Returns those that its lists do not do for.
Tiles castBlock(const MetaballSource& source, const MetaballField& field, const TileLists& lists, bool cut,
                const TileTarget& target, int b, const Tiles& wanted, const PlaneChannels& channels,
                Planes& planes, FieldCounts& counts) {
  const TileBlock& block = lists.block(b);
  thread_local std::vector<BallRecord> records;
  makeRecords(source, block, records);
  TileRays rays = makeRays(target, LaneOrder::squares);
  TilePixels pixels;
  FieldTile tile{&field, source.largestSupport(), records, {}, lists.slack(), cut};
  Tiles again;
  for (int t = 0; t < kTilesPerBlock; ++t) {
    const glm::ivec2 corner = lists.grid().corner(b, t);
    if (corner.x < 0 || !wanted[static_cast<std::size_t>(t)]) continue;
    tile.list = block.list(t);
    if (tile.list.empty()) {
      clearTile(corner.x, corner.y, planes);
      continue;
    }
    moveRays(rays, target, corner.x, corner.y);
    if (castField(tile, rays, channels, pixels, counts)) {
      storeTile(pixels, corner.x, corner.y, planes);
    } else {
      again.set(static_cast<std::size_t>(t));
    }
  }
  return again;
}

}  // namespace

void FieldTiles::cast(const TileTarget& target, const PlaneChannels& channels, Planes& planes,
                      Extent extent) {
  const MetaballSource source(*field_, target);
  if (!valid_ || !sameLists(listed_, target)) {
    lists_.build(source, *clusters_, target);
    listed_ = target;
    valid_ = true;
    wholeValid_ = false;
    ++builds_;
  }
  planes.resize(extent == Extent::whole ? target.area : lists_.occupied(target.area), channels);
  const int blocks = lists_.grid().blocks();
  tbb::enumerable_thread_specific<FieldCounts> counts;
  std::vector<Tiles> again(static_cast<std::size_t>(blocks));
  tbb::parallel_for(0, blocks, [&](int b) {
    again[static_cast<std::size_t>(b)] = castBlock(source, *field_, lists_, source.coresHide(), target, b,
                                                   Tiles().set(), channels, planes, counts.local());
  });
  if (std::any_of(again.begin(), again.end(), [](const Tiles& tiles) { return tiles.any(); })) {
    if (!wholeValid_) whole_.build(source, *clusters_, target, false);
    wholeValid_ = true;
    tbb::parallel_for(0, blocks, [&](int b) {
      const Tiles& tiles = again[static_cast<std::size_t>(b)];
      if (tiles.any())
        castBlock(source, *field_, whole_, false, target, b, tiles, channels, planes, counts.local());
    });
  }
  for (const FieldCounts& some : counts) counts_.add(some);
}

FieldCounts FieldTiles::takeCounts() {
  return std::exchange(counts_, {});
}

}  // namespace meniscus::tiles

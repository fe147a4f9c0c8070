#include "core/tiles/tile_lists.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <iterator>

#include "core/tiles/chunks.h"

namespace meniscus::tiles {

namespace {

constexpr std::size_t kSlabs = 16, kFewestClusters = 128, kMostClusters = 2048;  // of a slab
constexpr std::uint32_t kPlacedByTask = 256;                                     // clusters

}  // namespace

std::uint32_t TileLists::bucketOf(float front) const {
  const float bucket = (nearZ_ - front) / bucketDepth_;
  return static_cast<std::uint32_t>(std::clamp(bucket, 0.0f, static_cast<float>(buckets_ - 1)));
}

// Into sorted_, in order of their buckets; within a bucket as they came.
void TileLists::sortByDepth(const std::vector<Placed>& items) {
  const std::size_t count = items.size(), chunks = chunksOf(count).count;
  float nearest = -std::numeric_limits<float>::infinity(), farthest = std::numeric_limits<float>::infinity();
  for (const Placed& p : items) {
    nearest = std::max(nearest, p.place.front);
    farthest = std::min(farthest, p.place.front);
  }
  const std::uint32_t firstBucket = bucketOf(nearest);
  const std::size_t used = count > 0 ? bucketOf(farthest) - firstBucket + 1 : 0;
  bins_.assign(chunks * used, 0);
  const auto binOf = [&](const Placed& p) { return bucketOf(p.place.front) - firstBucket; };
  forChunks(count, [&](std::size_t c, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) ++bins_[c * used + binOf(items[i])];
  });
  placeBins(bins_, chunks, used);
  sorted_.resize(count);
  forChunks(count, [&](std::size_t c, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) sorted_[bins_[c * used + binOf(items[i])]++] = items[i];
  });
}

// To each block the positions in sorted_ of what touches it, in that order.
void TileLists::distribute() {
  const std::size_t count = sorted_.size(), chunks = chunksOf(count).count;
  const auto blockCount = static_cast<std::size_t>(grid_.blocks());
  bins_.assign(chunks * blockCount, 0);
  const auto forBlocks = [&](const Placement& p, auto f) {
    for (int y = p.y0 / kBlockTiles; y <= p.y1 / kBlockTiles; ++y) {
      for (int x = p.x0 / kBlockTiles; x <= p.x1 / kBlockTiles; ++x)
        f(static_cast<std::size_t>(y * grid_.blockColumns + x));
    }
  };
  forChunks(count, [&](std::size_t c, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      forBlocks(sorted_[i].place, [&](std::size_t block) { ++bins_[c * blockCount + block]; });
  });
  blockEntries_.resize(placeBins(bins_, chunks, blockCount));
  blockFirst_.assign(blockCount + 1, blockEntries_.size());
  for (std::size_t b = 0; b < blockCount && chunks > 0; ++b) blockFirst_[b] = bins_[b];
  forChunks(count, [&](std::size_t c, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      forBlocks(sorted_[i].place, [&](std::size_t block) {
        blockEntries_[bins_[c * blockCount + block]++] = static_cast<std::uint32_t>(i);
      });
    }
  });
}

void TileLists::startBlock(int index) {
  Filling& f = filling_[static_cast<std::size_t>(index)];
  f.cells.clear();
  f.behind.fill(-std::numeric_limits<float>::infinity());
  f.farthest.fill(std::numeric_limits<float>::infinity());
  f.counts.fill(0);
  f.tiles.clear();
  f.members.clear();
  f.open = std::min(kBlockTiles, grid_.columns - index % grid_.blockColumns * kBlockTiles) *
           std::min(kBlockTiles, grid_.rows - index / grid_.blockColumns * kBlockTiles);
  f.allBehind = std::numeric_limits<float>::infinity();
  blocks_[static_cast<std::size_t>(index)].members.clear();
}

void TileLists::fillBlock(int index, const TileSource& source, bool cut) {
  TileBlock& block = blocks_[static_cast<std::size_t>(index)];
  Filling& f = filling_[static_cast<std::size_t>(index)];
  const int blockX = index % grid_.blockColumns * kBlockTiles,
            blockY = index / grid_.blockColumns * kBlockTiles;
  const int tilesX = std::min(kBlockTiles, grid_.columns - blockX),
            tilesY = std::min(kBlockTiles, grid_.rows - blockY);
  const std::size_t first = blockFirst_[static_cast<std::size_t>(index)],
                    last = blockFirst_[static_cast<std::size_t>(index) + 1];
  if (first < last && f.cells.empty()) f.cells.resize(kTilesPerBlock);
  for (std::size_t k = first; k < last; ++k) {
    if (k + kPrefetched < last) source.prefetch(sorted_[blockEntries_[k + kPrefetched]].index);
    const Placed& p = sorted_[blockEntries_[k]];
    if (f.open == 0 && p.place.front + slack() <= f.allBehind) break;
    const int x0 = std::max(p.place.x0 - blockX, 0), x1 = std::min(p.place.x1 - blockX, tilesX - 1);
    const int y0 = std::max(p.place.y0 - blockY, 0), y1 = std::min(p.place.y1 - blockY, tilesY - 1);
    Occluder disc;
    bool listed = false;
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const auto tile = static_cast<std::size_t>(y * kBlockTiles + x);
        if (p.place.front <= f.behind[tile]) continue;
        if (!listed) {
          listed = true;
          block.members.push_back(p.index);
          if (cut) disc = source.occluder(p.index);
          disc.x -= grid_.x + blockX * kTileSize;
          disc.y -= grid_.y + blockY * kTileSize;
        }
        f.tiles.push_back(static_cast<std::uint32_t>(tile));
        f.members.push_back(static_cast<std::uint32_t>(block.members.size() - 1));
        ++f.counts[tile];
        const bool covered = f.behind[tile] > -std::numeric_limits<float>::infinity();
        if (covered || !(disc.radius > kLeastDisc)) continue;
        TileCells& cells = f.cells[tile];
        if (!coverCells(cells, static_cast<float>(disc.x - x * kTileSize),
                        static_cast<float>(disc.y - y * kTileSize), disc.radius))
          continue;
        f.farthest[tile] = std::min(f.farthest[tile], disc.z);
        if (!allCovered(cells)) continue;
        f.behind[tile] = f.farthest[tile];
        f.allBehind = std::min(f.allBehind, f.behind[tile]);
        --f.open;
      }
    }
  }
}

// Entries as they came, to entries tile by tile.
void TileLists::finishBlock(int index) {
  TileBlock& block = blocks_[static_cast<std::size_t>(index)];
  const Filling& f = filling_[static_cast<std::size_t>(index)];
  block.first[0] = 0;
  for (std::size_t t = 0; t < kTilesPerBlock; ++t) block.first[t + 1] = block.first[t] + f.counts[t];
  block.entries.resize(f.tiles.size());
  std::array<std::uint32_t, kTilesPerBlock> next;
  std::copy_n(block.first.begin(), kTilesPerBlock, next.begin());
  for (std::size_t i = 0; i < f.tiles.size(); ++i) block.entries[next[f.tiles[i]]++] = f.members[i];
}

void TileLists::fillAll(const TileSource& source, bool cut) {
  distribute();
  tbb::parallel_for(0, grid_.blocks(), [&](int b) { fillBlock(b, source, cut); });
}

// Whether all that a placement touches is covered in front of it.
bool TileLists::hidden(const Placement& p) const {
  for (int y = p.y0 / kBlockTiles; y <= p.y1 / kBlockTiles; ++y) {
    for (int x = p.x0 / kBlockTiles; x <= p.x1 / kBlockTiles; ++x) {
      const Filling& f = filling_[static_cast<std::size_t>(y * grid_.blockColumns + x)];
      if (f.open == 0 && p.front <= f.allBehind) continue;
      const int x0 = std::max(p.x0 - x * kBlockTiles, 0),
                x1 = std::min(p.x1 - x * kBlockTiles, kBlockTiles - 1);
      const int y0 = std::max(p.y0 - y * kBlockTiles, 0),
                y1 = std::min(p.y1 - y * kBlockTiles, kBlockTiles - 1);
      for (int v = y0; v <= y1; ++v) {
        for (int u = x0; u <= x1; ++u)
          if (p.front > f.behind[static_cast<std::size_t>(v * kBlockTiles + u)]) return false;
      }
    }
  }
  return true;
}

void TileLists::fillWhole(const TileSource& source, bool cut) {
  placed_.resize(source.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, placed_.size(), kLeastChunk), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i)
      placed_[i] = {source.place(i), static_cast<std::uint32_t>(i)};
  });
  placedCount_ = placed_.size();
  std::erase_if(placed_, [](const Placed& p) { return !p.place.visible(); });
  sortByDepth(placed_);
  fillAll(source, cut);
}

// Into copyOrder_ the copies that are in the picture, in order of their buckets.
void TileLists::sortCopies(const TileSource& source, const Clusters& clusters) {
  const std::span<const ClusterCopy> all = clusters.copies();
  placed_.resize(all.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, all.size(), kLeastChunk), [&](const auto& range) {
    for (std::size_t c = range.begin(); c < range.end(); ++c) {
      const Clusters::Ball& ball = clusters.sets()[all[c].set].ball;
      placed_[c] = {source.placeBall(all[c].motion, ball.center, ball.radius), static_cast<std::uint32_t>(c)};
    }
  });
  std::erase_if(placed_, [](const Placed& p) { return !p.place.visible(); });
  sortByDepth(placed_);
  copyOrder_.swap(sorted_);
}

// Appends to waitingClusters_ the clusters of copies that can be seen, in order.
void TileLists::openCopies(const TileSource& source, const Clusters& clusters, std::span<const Placed> some,
                           bool cut) {
  struct Opened {
    const ClusterCopy* copy;
    std::size_t to;  // in placed_
  };
  std::vector<Opened> opened;
  std::size_t count = 0;
  for (const Placed& c : some) {
    if (cut && hidden(c.place)) continue;
    const ClusterCopy& copy = clusters.copies()[c.index];
    opened.push_back({&copy, count});
    count += clusters.sets()[copy.set].size();
  }
  openedCopies_ += opened.size();
  placed_.resize(count);
  tbb::parallel_for(std::size_t{0}, opened.size(), [&](std::size_t i) {
    const auto [copy, to] = opened[i];
    const Clusters::Set& set = clusters.sets()[copy->set];
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, set.size(), kPlacedByTask),
                      [&, copy, to](const auto& range) {
                        for (std::uint32_t k = range.begin(); k < range.end(); ++k) {
                          const Cluster& cluster = clusters.list()[set.first + k];
                          placed_[to + k] = {source.placeBall(copy->motion, cluster.center, cluster.radius),
                                             copy->firstCluster + k};
                        }
                      });
  });
  std::copy_if(placed_.begin(), placed_.end(), std::back_inserter(waitingClusters_),
               [](const Placed& p) { return p.place.visible(); });
}

// Into parts_ the primitives of clusters that can be seen, in order.
void TileLists::openClusters(const TileSource& source, const Clusters& clusters, std::span<const Placed> some,
                             bool cut) {
  constexpr std::size_t kFewest = 8;  // clusters for a task
  const std::size_t perPart = std::max((some.size() + kMostChunks - 1) / kMostChunks, kFewest);
  const std::size_t count = (some.size() + perPart - 1) / perPart;
  if (parts_.size() < count) parts_.resize(count);
  for (std::vector<Placed>& part : parts_) part.clear();
  std::atomic<std::size_t> looked = 0;
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t part) {
    std::array<Placement, kClusterSize> placements;
    for (const Placed& c : some.subspan(part * perPart, std::min(perPart, some.size() - part * perPart))) {
      if (cut && hidden(c.place)) continue;
      const ClusterCopy& copy = clusters.copyOf(c.index);
      const Cluster& cluster =
          clusters.list()[clusters.sets()[copy.set].first + (c.index - copy.firstCluster)];
      looked += cluster.last - cluster.first;
      source.placeBalls(copy.motion, cluster,
                        clusters.balls().subspan(cluster.first, cluster.last - cluster.first),
                        placements.data());
      for (std::uint32_t i = cluster.first; i < cluster.last; ++i) {
        Placed p{placements[i - cluster.first], copy.firstPrimitive + clusters.order()[i]};
        if (!p.place.visible() || (cut && hidden(p.place))) continue;
        if (!source.isBall(p.index)) p.place = source.place(p.index);
        if (p.place.visible()) parts_[part].push_back(p);
      }
    }
  });
  placedCount_ += looked;
}

// From waitingClusters_ and waiting_ all that begins in buckets before `limit`; the rest goes on waiting.
// Slabs end between buckets, so that the order of a list does not depend on them.
void TileLists::fillUpTo(std::uint32_t limit, const TileSource& source, const Clusters& clusters,
                         std::size_t perSlab, bool cut) {
  placed_.clear();
  stillWaitingClusters_.clear();
  for (const Placed& c : waitingClusters_)
    (bucketOf(c.place.front) < limit ? placed_ : stillWaitingClusters_).push_back(c);
  waitingClusters_.swap(stillWaitingClusters_);
  sortByDepth(placed_);
  clusterOrder_.swap(sorted_);
  const std::vector<Placed>& order = clusterOrder_;
  std::size_t next = 0;
  do {
    std::size_t end = std::min(next + perSlab, order.size());
    while (end < order.size() && bucketOf(order[end].place.front) == bucketOf(order[end - 1].place.front))
      ++end;
    const std::uint32_t slabEnd = end < order.size() ? bucketOf(order[end].place.front) : limit;
    openClusters(source, clusters, std::span(order).subspan(next, end - next), cut);
    active_.clear();
    stillWaiting_.clear();
    const auto take = [&](const std::vector<Placed>& from) {
      for (const Placed& p : from) (bucketOf(p.place.front) < slabEnd ? active_ : stillWaiting_).push_back(p);
    };
    take(waiting_);
    for (const std::vector<Placed>& part : parts_) take(part);
    waiting_.swap(stillWaiting_);
    sortByDepth(active_);
    fillAll(source, cut);
    next = end;
  } while (next < order.size());
}

void TileLists::fillBySlabs(const TileSource& source, const Clusters& clusters, bool cut) {
  sortCopies(source, clusters);
  const std::vector<Placed>& order = copyOrder_;
  const auto clustersOf = [&](const Placed& copy) -> std::size_t {
    return clusters.sets()[clusters.copies()[copy.index].set].size();
  };
  std::size_t all = 0;
  for (const Placed& copy : order) all += clustersOf(copy);
  const std::size_t perSlab = std::clamp(all / kSlabs, kFewestClusters, kMostClusters);
  waitingClusters_.clear();
  waiting_.clear();  // primitives of opened clusters, behind the last slab
  for (std::size_t next = 0; next < order.size();) {
    std::size_t end = next, opened = 0;
    while (end < order.size() &&
           (opened < perSlab || bucketOf(order[end].place.front) == bucketOf(order[end - 1].place.front)))
      opened += clustersOf(order[end++]);
    openCopies(source, clusters, std::span(order).subspan(next, end - next), cut);
    fillUpTo(end < order.size() ? bucketOf(order[end].place.front) : buckets_, source, clusters, perSlab,
             cut);
    next = end;
  }
}

void TileLists::build(const TileSource& source, const Clusters& clusters, const TileTarget& target,
                      bool cut) {
  grid_ = TileGrid(target.area);
  nearZ_ = static_cast<float>(target.view.nearZ);
  // A few primitives to a bucket.
  buckets_ = std::uint32_t{1} << std::clamp(static_cast<int>(std::bit_width(source.size())) - 3, 8, 14);
  bucketDepth_ = std::max((nearZ_ - static_cast<float>(target.view.farZ)) / static_cast<float>(buckets_),
                          std::numeric_limits<float>::min());
  blocks_.resize(static_cast<std::size_t>(grid_.blocks()));
  filling_.resize(blocks_.size());
  placedCount_ = openedCopies_ = 0;
  tbb::parallel_for(0, grid_.blocks(), [&](int b) { startBlock(b); });
  if (clusters.empty()) {
    fillWhole(source, cut);
  } else {
    fillBySlabs(source, clusters, cut);
  }
  tbb::parallel_for(0, grid_.blocks(), [&](int b) { finishBlock(b); });
}

PixelArea TileLists::occupied(const PixelArea& area) const {
  constexpr int kBlockSize = kBlockTiles * kTileSize;
  int x0 = area.x + area.width, y0 = area.y + area.height, x1 = area.x, y1 = area.y;
  for (int b = 0; b < grid_.blocks(); ++b) {
    if (block(b).entries.empty()) continue;
    const glm::ivec2 corner = grid_.corner(b, 0);
    x0 = std::min(x0, std::max(corner.x, area.x));
    y0 = std::min(y0, std::max(corner.y, area.y));
    x1 = std::max(x1, std::min(corner.x + kBlockSize, area.x + area.width));
    y1 = std::max(y1, std::min(corner.y + kBlockSize, area.y + area.height));
  }
  if (x0 >= x1 || y0 >= y1) return {area.x, area.y, 1, 1};
  return {x0, y0, x1 - x0, y1 - y0};
}

std::size_t TileLists::entryCount() const {
  std::size_t sum = 0;
  for (const TileBlock& b : blocks_) sum += b.entries.size();
  return sum;
}

std::uint64_t TileLists::bytes() const {
  std::uint64_t sum = sizeof(Placed) * sorted_.capacity() + sizeof(Filling) * filling_.capacity() +
                      sizeof(std::uint32_t) * blockEntries_.capacity() +
                      sizeof(TileBlock) * blocks_.capacity();
  for (const Filling& f : filling_)
    sum += sizeof(std::uint32_t) * (f.tiles.capacity() + f.members.capacity()) +
           sizeof(TileCells) * f.cells.capacity();
  for (const TileBlock& b : blocks_)
    sum += sizeof(std::uint32_t) * (b.members.capacity() + b.entries.capacity());
  return sum;
}

}  // namespace meniscus::tiles

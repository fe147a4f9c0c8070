#include "core/tiles/tile_lists.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace meniscus::tiles {

namespace {

constexpr std::size_t kLeastChunk = 4096;  // primitives that one task sorts or distributes
constexpr std::size_t kMostChunks = 64;
constexpr std::uint64_t kAllCells = ~std::uint64_t{0};

struct Chunks {
  std::size_t size, count;
};
Chunks chunksOf(std::size_t count) {
  const std::size_t size = std::max(kLeastChunk, (count + kMostChunks - 1) / kMostChunks);
  return {size, (count + size - 1) / size};
}

// Calls f(chunk, first, last) for each chunk, in parallel.
template <typename F>
void forChunks(std::size_t count, F f) {
  const Chunks chunks = chunksOf(count);
  tbb::parallel_for(std::size_t{0}, chunks.count,
                    [&](std::size_t c) { f(c, c * chunks.size, std::min(count, (c + 1) * chunks.size)); });
}

// Turns counts, chunk by chunk for each of `bins`, into the places where each chunk's share of each bin
// begins; returns the sum.
std::size_t placeBins(std::vector<std::size_t>& counts, std::size_t chunks, std::size_t bins) {
  std::size_t sum = 0;
  for (std::size_t b = 0; b < bins; ++b) {
    for (std::size_t c = 0; c < chunks; ++c) {
      std::size_t& slot = counts[c * bins + b];
      const std::size_t here = slot;
      slot = sum;
      sum += here;
    }
  }
  return sum;
}

// Of the 8 x 8 cells of a tile, those that lie in a disc; x, y: its centre relative to the tile's corner.
std::uint64_t cellsInside(float x, float y, float radius) {
  const float r2 = radius * radius;
  std::uint64_t cells = 0;
  for (int row = 0; row < kTileSize; ++row) {
    const float dy = std::abs(static_cast<float>(row) + 0.5f - y) + 0.5f;
    const float under = r2 - dy * dy;
    if (!(under > 0)) continue;
    const float half = std::sqrt(under);
    const auto low = static_cast<int>(std::ceil(std::max(x - half, 0.0f)));
    const auto high = static_cast<int>(std::min(x + half, static_cast<float>(kTileSize)));
    if (low >= high) continue;
    const std::uint64_t bits = ((std::uint64_t{1} << high) - 1) & ~((std::uint64_t{1} << low) - 1);
    cells |= bits << (row * kTileSize);
  }
  return cells;
}

}  // namespace

std::uint32_t TileLists::bucketOf(float front) const {
  const float bucket = (nearZ_ - front) / bucketDepth_;
  return static_cast<std::uint32_t>(std::clamp(bucket, 0.0f, static_cast<float>(buckets_ - 1)));
}

// Placements of what can be seen at all, in order of their buckets; within a bucket as they came.
void TileLists::sortByDepth(const TileSource& source) {
  const std::size_t count = source.size(), chunks = chunksOf(count).count;
  unsorted_.resize(count);
  std::vector<std::size_t> bins(chunks * buckets_, 0);
  std::vector<std::uint32_t> visible(chunks, 0);
  forChunks(count, [&](std::size_t c, std::size_t first, std::size_t last) {
    std::vector<Placement> placements(last - first);
    source.place(first, last, placements.data());
    std::size_t next = first;
    for (std::size_t i = first; i < last; ++i) {
      const Placement& p = placements[i - first];
      if (!(p.front > -std::numeric_limits<float>::infinity())) continue;
      unsorted_[next++] = {p, static_cast<std::uint32_t>(i)};
      ++bins[c * buckets_ + bucketOf(p.front)];
    }
    visible[c] = static_cast<std::uint32_t>(next - first);
  });
  sorted_.resize(placeBins(bins, chunks, buckets_));
  forChunks(count, [&](std::size_t c, std::size_t first, std::size_t) {
    for (std::size_t i = first; i < first + visible[c]; ++i) {
      sorted_[bins[c * buckets_ + bucketOf(unsorted_[i].place.front)]++] = unsorted_[i];
    }
  });
}

// To each block the positions in sorted_ of what touches it, in that order.
void TileLists::distribute() {
  const std::size_t count = sorted_.size(), chunks = chunksOf(count).count;
  const auto blockCount = static_cast<std::size_t>(grid_.blocks());
  std::vector<std::size_t> bins(chunks * blockCount, 0);
  const auto forBlocks = [&](const Placement& p, auto f) {
    for (int y = p.y0 / kBlockTiles; y <= p.y1 / kBlockTiles; ++y) {
      for (int x = p.x0 / kBlockTiles; x <= p.x1 / kBlockTiles; ++x)
        f(static_cast<std::size_t>(y * grid_.blockColumns + x));
    }
  };
  forChunks(count, [&](std::size_t c, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i)
      forBlocks(sorted_[i].place, [&](std::size_t block) { ++bins[c * blockCount + block]; });
  });
  blockEntries_.resize(placeBins(bins, chunks, blockCount));
  blockFirst_.assign(blockCount + 1, blockEntries_.size());
  for (std::size_t b = 0; b < blockCount && chunks > 0; ++b) blockFirst_[b] = bins[b];
  forChunks(count, [&](std::size_t c, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      forBlocks(sorted_[i].place, [&](std::size_t block) {
        blockEntries_[bins[c * blockCount + block]++] = static_cast<std::uint32_t>(i);
      });
    }
  });
}

void TileLists::fillBlock(int index, const TileSource& source, bool cut) {
  TileBlock& block = blocks_[static_cast<std::size_t>(index)];
  block.members.clear();
  const int blockX = index % grid_.blockColumns * kBlockTiles,
            blockY = index / grid_.blockColumns * kBlockTiles;
  struct Entry {
    std::uint32_t tile, member;
  };
  thread_local std::vector<Entry> entries;
  entries.clear();
  std::array<std::uint64_t, kTilesPerBlock> covered{};
  std::array<float, kTilesPerBlock> behind;    // nothing below is seen
  std::array<float, kTilesPerBlock> farthest;  // of the discs that cover cells
  behind.fill(-std::numeric_limits<float>::infinity());
  farthest.fill(std::numeric_limits<float>::infinity());
  std::array<std::uint32_t, kTilesPerBlock> counts{};
  const int tilesX = std::min(kBlockTiles, grid_.columns - blockX),
            tilesY = std::min(kBlockTiles, grid_.rows - blockY);
  int open = tilesX * tilesY;
  float allBehind = std::numeric_limits<float>::infinity();

  const std::size_t first = blockFirst_[static_cast<std::size_t>(index)],
                    last = blockFirst_[static_cast<std::size_t>(index) + 1];
  for (std::size_t k = first; k < last; ++k) {
    const Placed& p = sorted_[blockEntries_[k]];
    if (open == 0 && p.place.front + slack() <= allBehind) break;
    const int x0 = std::max(p.place.x0 - blockX, 0), x1 = std::min(p.place.x1 - blockX, tilesX - 1);
    const int y0 = std::max(p.place.y0 - blockY, 0), y1 = std::min(p.place.y1 - blockY, tilesY - 1);
    Occluder disc;
    bool listed = false;
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const auto tile = static_cast<std::size_t>(y * kBlockTiles + x);
        if (p.place.front <= behind[tile]) continue;
        if (!listed) {
          listed = true;
          block.members.push_back(p.index);
          if (cut) disc = source.occluder(p.index);
          disc.x -= grid_.x + blockX * kTileSize;
          disc.y -= grid_.y + blockY * kTileSize;
        }
        entries.push_back(
            {static_cast<std::uint32_t>(tile), static_cast<std::uint32_t>(block.members.size() - 1)});
        ++counts[tile];
        if (covered[tile] == kAllCells || !(disc.radius > 0.7f)) continue;
        const std::uint64_t cells = cellsInside(static_cast<float>(disc.x - x * kTileSize),
                                                static_cast<float>(disc.y - y * kTileSize), disc.radius);
        if ((cells & ~covered[tile]) == 0) continue;
        covered[tile] |= cells;
        farthest[tile] = std::min(farthest[tile], disc.z);
        if (covered[tile] != kAllCells) continue;
        behind[tile] = farthest[tile];
        allBehind = std::min(allBehind, behind[tile]);
        --open;
      }
    }
  }
  block.first[0] = 0;
  for (std::size_t t = 0; t < kTilesPerBlock; ++t) block.first[t + 1] = block.first[t] + counts[t];
  block.entries.resize(entries.size());
  std::array<std::uint32_t, kTilesPerBlock> next;
  std::copy_n(block.first.begin(), kTilesPerBlock, next.begin());
  for (const Entry& e : entries) block.entries[next[e.tile]++] = e.member;
}

void TileLists::build(const TileSource& source, const TileTarget& target, bool cut) {
  grid_ = TileGrid(target.area);
  nearZ_ = static_cast<float>(target.view.nearZ);
  // A few primitives to a bucket.
  buckets_ = std::uint32_t{1} << std::clamp(static_cast<int>(std::bit_width(source.size())) - 3, 8, 14);
  bucketDepth_ = std::max((nearZ_ - static_cast<float>(target.view.farZ)) / static_cast<float>(buckets_),
                          std::numeric_limits<float>::min());
  blocks_.resize(static_cast<std::size_t>(grid_.blocks()));
  sortByDepth(source);
  distribute();
  tbb::parallel_for(0, grid_.blocks(), [&](int b) { fillBlock(b, source, cut); });
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
  std::uint64_t sum = sizeof(Placed) * (unsorted_.capacity() + sorted_.capacity()) +
                      sizeof(std::uint32_t) * blockEntries_.capacity() +
                      sizeof(TileBlock) * blocks_.capacity();
  for (const TileBlock& b : blocks_)
    sum += sizeof(std::uint32_t) * (b.members.capacity() + b.entries.capacity());
  return sum;
}

}  // namespace meniscus::tiles

#pragma once
// Which primitives a tile's rays can meet, nearest first, and none that an opaque front hides from all of
// them. Built in parallel, front to back in slabs of depth: copies of sets of clusters, and clusters in them,
// that can still be seen, their primitives' bounds, a bucket sort by nearest depth, distribution to blocks of
// tiles, then each block by itself. A tile keeps the cells (sixteenths of a pixel) that discs inside its
// primitives cover whole; once all are covered, what lies behind the farthest of these discs is not listed
// any more, and clusters and copies behind it are not even opened. So the lists hold what can be seen and
// little else, however deep the scene.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/tiles/clusters.h"
#include "core/tiles/placement.h"
#include "core/tiles/tile_cells.h"
#include "core/tiles/tile_target.h"

namespace meniscus::tiles {

/// Primitives of any kind, by index, each copy by itself. Everything is called from several threads.
class TileSource {
 public:
  virtual ~TileSource() = default;
  virtual std::size_t size() const = 0;
  virtual Placement place(std::size_t index) const = 0;
  /// Says that the primitive is wanted soon: it may lie anywhere in memory.
  virtual void prefetch(std::size_t index) const = 0;
  /// Whether place() is placeBall() of the primitive's own bounding sphere.
  virtual bool isBall(std::size_t index) const = 0;
  virtual Occluder occluder(std::size_t index) const = 0;
  /// Where anything of a sphere can be seen. motion: of its centre, to relative to the primitives' origin.
  virtual Placement placeBall(const RigidMotion& motion, const glm::vec3& center, float radius) const = 0;
  /// The same of the bounding spheres in a cluster; it may find them a little larger.
  virtual void placeBalls(const RigidMotion& motion, const Cluster& cluster,
                          std::span<const Clusters::Ball> balls, Placement* out) const = 0;
};

/// The lists of a block of tiles.
struct TileBlock {
  std::vector<std::uint32_t> members;  ///< primitives that any of its tiles lists, nearest bucket first
  std::vector<std::uint32_t> entries;  ///< indices into members, tile after tile
  std::array<std::uint32_t, kTilesPerBlock + 1> first{};  ///< of a tile's entries

  std::span<const std::uint32_t> list(int tile) const {
    const auto t = static_cast<std::size_t>(tile);
    return std::span(entries).subspan(first[t], first[t + 1] - first[t]);
  }
};

/// How far ahead primitives are asked for.
inline constexpr std::size_t kPrefetched = 8;

/// A record for each member of a block, as source.record() makes them.
template <typename Source, typename Record>
void makeRecords(const Source& source, const TileBlock& block, std::vector<Record>& records) {
  const std::vector<std::uint32_t>& members = block.members;
  records.resize(members.size());
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (i + kPrefetched < members.size()) source.prefetch(members[i + kPrefetched]);
    source.record(members[i], records[i]);
  }
}

class TileLists {
 public:
  /// clusters: of the same primitives, or without any; cut: whether a tile's list ends where its front is
  /// opaque (off: every primitive that may touch it).
  void build(const TileSource& source, const Clusters& clusters, const TileTarget& target, bool cut = true);

  const TileGrid& grid() const { return grid_; }
  const TileBlock& block(int index) const { return blocks_[static_cast<std::size_t>(index)]; }
  /// How much nearer a later entry of a list can be than an earlier one [Å].
  float slack() const { return bucketDepth_ * 1.01f; }
  /// The smallest part of an area that holds all blocks with entries; one pixel if none has any.
  PixelArea occupied(const PixelArea& area) const;
  std::size_t entryCount() const;
  /// Primitives whose bounds were looked at one by one.
  std::size_t placedCount() const { return placedCount_; }
  /// Copies whose clusters were looked at one by one.
  std::size_t openedCopies() const { return openedCopies_; }
  std::uint64_t bytes() const;

 private:
  struct Placed {
    Placement place;
    std::uint32_t index;
  };
  // Of a block while it is filled.
  struct Filling {
    std::vector<TileCells> cells;                // covered ones, by tile; empty before the first disc
    std::array<float, kTilesPerBlock> behind;    // nothing below is seen
    std::array<float, kTilesPerBlock> farthest;  // of the discs that cover cells
    std::array<std::uint32_t, kTilesPerBlock> counts;
    std::vector<std::uint32_t> tiles, members;  // of the entries, as they came
    int open;                                   // tiles not covered
    float allBehind;                            // the lowest `behind` of those that are
  };
  void fillWhole(const TileSource& source, bool cut);
  void fillBySlabs(const TileSource& source, const Clusters& clusters, bool cut);
  void sortCopies(const TileSource& source, const Clusters& clusters);
  void openCopies(const TileSource& source, const Clusters& clusters, std::span<const Placed> some, bool cut);
  void fillUpTo(std::uint32_t limit, const TileSource& source, const Clusters& clusters, std::size_t perSlab,
                bool cut);
  bool hidden(const Placement& p) const;
  void sortByDepth(const std::vector<Placed>& items);
  void openClusters(const TileSource& source, const Clusters& clusters, std::span<const Placed> some,
                    bool cut);
  void distribute();
  void startBlock(int index);
  void fillBlock(int index, const TileSource& source, bool cut);
  void finishBlock(int index);
  void fillAll(const TileSource& source, bool cut);
  std::uint32_t bucketOf(float front) const;

  TileGrid grid_{PixelArea{}};
  float nearZ_ = 0, bucketDepth_ = 0;
  std::uint32_t buckets_ = 1;
  std::size_t placedCount_ = 0, openedCopies_ = 0;
  std::vector<Placed> sorted_;
  // Scratch that keeps its memory from view to view.
  std::vector<Placed> placed_, copyOrder_, clusterOrder_;
  std::vector<Placed> active_, waiting_, stillWaiting_;  // primitives
  std::vector<Placed> waitingClusters_, stillWaitingClusters_;
  std::vector<std::vector<Placed>> parts_;
  std::vector<std::size_t> bins_;
  std::vector<std::uint32_t> blockEntries_;  // positions in sorted_, block after block
  std::vector<std::size_t> blockFirst_;
  std::vector<Filling> filling_;
  std::vector<TileBlock> blocks_;
};

}  // namespace meniscus::tiles

#pragma once
// Levels of detail, for quadrics much smaller than a pixel. Up to 2^level neighbours become one ball that
// covers, seen from all sides, the area on the screen that they cover together on average. So a picture's
// share of covered pixels, and its colours, stay right on average, while lists are of what a screen can show.
// A quadric whose neighbours are too far away to lie in the same pixel stays by itself.

#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "core/primitives.h"
#include "core/tiles/clusters.h"
#include "core/tiles/tile_target.h"

namespace meniscus::tiles {

/// The largest radius of a ball that stands for others [pixels]; a quadric's own is at most 0.35 then, as two
/// cannot cover more than one of 1.4 times the size.
inline constexpr double kThinnedRadius = 0.5;

class DetailLevels {
 public:
  struct Level {
    const Primitives* primitives;
    const Clusters* clusters;
  };

  /// clusters: of the primitives, which must outlive this. Too few to have clusters have no levels.
  DetailLevels(const Primitives& primitives, std::shared_ptr<const Clusters> clusters);

  /// 0 = all quadrics as they are: thinning is not wanted, or the nearest could be larger than so. A level is
  /// made when it is first thought of, and kept. Not for several threads.
  int levelFor(const TileTarget& target);
  /// One that levelFor() returned.
  Level level(int level) const;

 private:
  struct Thinned {
    Primitives primitives;
    Clusters clusters;
    double largest = 0;  // radius [Å]
  };
  int levelAt(double scale);  // [pixels for each Å]
  const Thinned& thinned(int level);
  Thinned make(int level) const;

  const Primitives& primitives_;
  std::shared_ptr<const Clusters> clusters_;
  double largest_ = 0;  // enclosing radius [Å]
  std::map<int, Thinned> thinned_;
  std::optional<std::pair<TileTarget, int>> last_;  // asked for, of every sample of a picture
};

/// With clusters of their own.
std::shared_ptr<DetailLevels> levelsOf(const Primitives& primitives);

}  // namespace meniscus::tiles

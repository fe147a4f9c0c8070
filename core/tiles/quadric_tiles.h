#pragma once
// Draws the quadrics of Primitives from tile lists, on all processors, by the widest vectors there are.

#include <memory>

#include "core/primitives.h"
#include "core/tiles/detail_levels.h"
#include "core/tiles/tile_lists.h"

namespace meniscus::tiles {

class QuadricTiles {
 public:
  /// What to draw from now on.
  void setPrimitives(std::shared_ptr<DetailLevels> levels);
  /// They must outlive the next call.
  void setPrimitives(const Primitives* primitives);
  /// Fills planes of target.area, or of the part of it that is occupied (at least one pixel). Lists are built
  /// again only if something but the sample's shift has changed.
  void cast(const TileTarget& target, const PlaneChannels& channels, Planes& planes,
            Extent extent = Extent::occupied);
  const TileLists& lists() const { return lists_; }
  /// How often lists were built.
  int builds() const { return builds_; }

 private:
  std::shared_ptr<DetailLevels> levels_;
  TileLists lists_;
  TileTarget listed_;
  bool valid_ = false;
  int builds_ = 0;
};

}  // namespace meniscus::tiles

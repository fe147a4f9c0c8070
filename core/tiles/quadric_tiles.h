#pragma once
// Draws the quadrics of Primitives from tile lists, on all processors, by the widest vectors there are.

#include <memory>

#include "core/primitives.h"
#include "core/tiles/tile_lists.h"

namespace meniscus::tiles {

class QuadricTiles {
 public:
  /// What to draw from now on; must outlive the next call. clusters: of the same primitives.
  void setPrimitives(const Primitives* primitives, std::shared_ptr<const Clusters> clusters);
  void setPrimitives(const Primitives* primitives);
  /// Fills planes of target.area, or of the part of it that is occupied (at least one pixel). Lists are built
  /// again only if something but the sample's shift has changed.
  void cast(const TileTarget& target, const PlaneChannels& channels, Planes& planes,
            Extent extent = Extent::occupied);
  const TileLists& lists() const { return lists_; }
  /// How often lists were built.
  int builds() const { return builds_; }

 private:
  const Primitives* primitives_ = nullptr;
  std::shared_ptr<const Clusters> clusters_;
  TileLists lists_;
  TileTarget listed_;
  bool valid_ = false;
  int builds_ = 0;
};

}  // namespace meniscus::tiles

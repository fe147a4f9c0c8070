#pragma once
// Draws a metaball field from tile lists, on all processors, by the widest vectors there are: exact, with no
// limit on how many balls overlap or how deep the scene is.

#include <memory>

#include "core/tiles/field_caster.h"
#include "core/tiles/tile_lists.h"

namespace meniscus::tiles {

class FieldTiles {
 public:
  /// What to draw from now on; must outlive the next call. clusters: of the same field.
  void setField(const MetaballField* field, std::shared_ptr<const Clusters> clusters);
  void setField(const MetaballField* field);
  /// As QuadricTiles::cast().
  void cast(const TileTarget& target, const PlaneChannels& channels, Planes& planes,
            Extent extent = Extent::occupied);
  const TileLists& lists() const { return lists_; }
  /// Of memory.
  std::uint64_t bytesOfLists() const { return lists_.bytes() + whole_.bytes(); }
  int builds() const { return builds_; }
  /// Of all calls since the last one.
  FieldCounts takeCounts();

 private:
  const MetaballField* field_ = nullptr;
  std::shared_ptr<const Clusters> clusters_;
  TileLists lists_;
  TileLists whole_;  // not cut: for tiles in which a ray begins inside the surface
  TileTarget listed_;
  FieldCounts counts_;
  bool valid_ = false, wholeValid_ = false;
  int builds_ = 0;
};

}  // namespace meniscus::tiles

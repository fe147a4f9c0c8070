#pragma once
// For each screen tile the balls of a field that its rays can meet, nearest first, in buffers for shaders
// (flag TILES of shaders/include/lists_nodes.glsl).

#include <memory>

#include "core/tiles/metaball_source.h"
#include "core/tiles/tile_lists.h"
#include "render/surface/list_balls.h"
#include "render/tile_list_buffers.h"

namespace meniscus {

class TileBallLists {
 public:
  /// What to list from now on; the field and its coreShares() must outlive the next call.
  void setField(const MetaballField* field, const std::vector<float>* coreShares,
                std::shared_ptr<const tiles::Clusters> clusters);

  /// Lists for a view, if it is another than before but for the sample's shift. Throws InputError if the
  /// driver's buffers are too small for them.
  void update(const tiles::TileTarget& target);
  /// Storage 1 and 7, and what ListBalls binds.
  void bind() const;

  const ListBalls& balls() const { return balls_; }
  const TileListBuffers& lists() const { return lists_; }
  /// The part of the target that any tile's balls can be seen in.
  const tiles::PixelArea& occupied() const { return occupied_; }
  std::size_t listed() const { return listed_; }  ///< different balls in lists
  std::uint64_t bytes() const;

 private:
  void upload(const tiles::TileTarget& target, const std::vector<const tiles::TileBlock*>& blocks);

  const MetaballField* field_ = nullptr;
  const std::vector<float>* coreShares_ = nullptr;
  std::shared_ptr<const tiles::Clusters> clusters_;
  BoundingSphere bounds_;  // of all supports
  tiles::TileLists cut_, whole_;
  tiles::TileTarget target_;
  bool valid_ = false;
  ListBalls balls_;
  TileListBuffers lists_;
  tiles::PixelArea occupied_;
  std::size_t listed_ = 0;
};

}  // namespace meniscus

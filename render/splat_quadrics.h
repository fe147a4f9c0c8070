#pragma once
// Splatted quadrics (render/quadrics.h), with the levels of detail that those from tiles have, so that a GPU
// draws what the processor draws.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "core/primitives.h"
#include "core/tiles/detail_levels.h"
#include "core/tiles/tile_target.h"
#include "render/quadrics.h"

namespace meniscus {

class SplatQuadrics {
 public:
  using Apart = std::function<const Primitives&()>;
  using EachCopy = std::function<Primitives(const Primitives&)>;

  /// What to draw; gives up what was uploaded. apart: the same primitives without units; eachCopy: of balls
  /// that stand for them.
  void setPrimitives(std::shared_ptr<const Primitives> primitives, Apart apart, EachCopy eachCopy);

  /// What stands for the quadrics in such a view, which is uploaded if it is not there yet.
  const QuadricBuffers& upload(const tiles::TileTarget& target);
  /// Adds a pass for each kind of quadric there is: addQuadrics() of what upload() gives.
  void add(FrameGraph& graph, ShaderLibrary& shaders, const tiles::TileTarget& target,
           const GBufferRefs& gbuffer, const std::string& prefix = {});
  std::vector<ResourceStats> buffers() const;

 private:
  bool tooLargeToThin(const tiles::TileTarget& target);
  int levelFor(const tiles::TileTarget& target);

  std::shared_ptr<const Primitives> primitives_;
  Apart apart_;
  EachCopy eachCopy_;
  std::optional<double> largest_;                // radius [Å]; found out when it is wanted first
  std::shared_ptr<tiles::DetailLevels> levels_;  // none before something may be thinned
  std::map<int, QuadricBuffers> uploaded_;       // by level
};

}  // namespace meniscus

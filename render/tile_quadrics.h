#pragma once
// Spheres, cylinders and ellipsoids cast by the processor from tile lists (core/tiles/) and uploaded into the
// G-buffer: what is fastest where OpenGL itself runs on the processor (docs/measured/tiles.md).

#include <memory>

#include "core/primitives.h"
#include "core/tiles/quadric_tiles.h"
#include "render/frame_graph.h"
#include "render/gbuffer.h"

namespace meniscus {

/// How quadrics are drawn, and why, for --explain.
struct QuadricChoice {
  QuadricMethod method = QuadricMethod::splat;  ///< not automatic
  std::string reason;
};
/// A context must be current.
QuadricChoice chooseQuadrics(QuadricMethod method);

/// Says for --explain if fewer balls stand for quadrics that are smaller than a pixel.
void tellDetail(FrameGraph& graph, tiles::DetailLevels& levels, const tiles::TileTarget& target,
                const std::string& prefix);

class TileQuadrics {
 public:
  /// What to draw; gives up the lists of what was drawn before.
  void setPrimitives(std::shared_ptr<const Primitives> primitives);

  /// Adds one pass for all kinds of quadrics, of which there must be any; it replaces what the channels hold.
  /// `this` must live until the graph was executed. `prefix` goes before the pass's name.
  void add(FrameGraph& graph, const tiles::TileTarget& target, const GBufferRefs& gbuffer,
           const std::string& prefix = {});

 private:
  void prepare();

  std::shared_ptr<const Primitives> primitives_;
  tiles::QuadricTiles camera_, light_;  // lists of the picture outlive a shadow map
  tiles::Planes planes_;
  std::shared_ptr<tiles::DetailLevels> levels_;  // of both; none before something is drawn
};

}  // namespace meniscus

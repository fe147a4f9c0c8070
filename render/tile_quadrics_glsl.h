#pragma once
// Spheres, cylinders and ellipsoids from the tile lists that the processor makes (core/tiles/), cast by
// shaders: the same walk as render/tile_quadrics.h, for a GPU.

#include <memory>

#include "core/primitives.h"
#include "core/tiles/detail_levels.h"
#include "core/tiles/tile_lists.h"
#include "render/frame_graph.h"
#include "render/gbuffer.h"
#include "render/render_stats.h"
#include "render/surface/ball_texture.h"
#include "render/tile_list_buffers.h"
#include "render/view_block.h"

namespace meniscus {

class GlslTileQuadrics {
 public:
  /// What to draw; gives up the lists of what was drawn before.
  void setPrimitives(std::shared_ptr<const Primitives> primitives);

  /// Adds one pass for all kinds of quadrics, of which there must be any. The view's uniform block
  /// must be bound, `this` live until the graph was executed. `prefix` goes before the pass's name.
  void add(FrameGraph& graph, ShaderLibrary& shaders, const tiles::TileTarget& target,
           const GBufferRefs& gbuffer, const std::string& prefix = {});
  std::vector<ResourceStats> buffers() const;

 private:
  struct Lists {
    tiles::TileLists made;
    tiles::TileTarget target;
    bool valid = false;
    TileListBuffers buffers;
    BallTexture quadrics{6};
    gl::Storage colors;
  };
  void update(Lists& lists, const tiles::TileTarget& target);
  void draw(const PassContext& context, ShaderLibrary& shaders, const Lists& lists,
            const GBufferRefs& g) const;

  std::shared_ptr<const Primitives> primitives_;
  std::shared_ptr<tiles::DetailLevels> levels_;  // none before something is drawn
  Lists camera_, light_;                         // lists of the picture outlive a shadow map
};

}  // namespace meniscus

#pragma once
// The metaball surfaces of a scene, each drawn by the method that was asked for.

#include <memory>
#include <vector>

#include "core/primitives.h"
#include "render/render_stats.h"
#include "render/surface_method.h"

namespace meniscus {

class SurfacePasses {
 public:
  /// Makes the methods of the scene's surfaces, if they are not there yet as the settings want them.
  void prepare(std::shared_ptr<const Primitives> primitives, const SurfaceSettings& settings);
  void clear();
  /// Adds the passes of all surfaces; notes in the graph if there are none.
  void add(FrameGraph& graph, ShaderLibrary& shaders, const SurfaceTarget& target);
  /// Adds the passes that write `target.layers` instead: of all surfaces together, each joining what those
  /// before it wrote. Returns what the last one writes; not valid if there are none.
  SurfaceLayerRefs addLayers(FrameGraph& graph, ShaderLibrary& shaders, SurfaceTarget target);
  /// Adds what was counted since the last call.
  void takeStats(std::vector<SurfaceStats>& stats);
  std::vector<ResourceStats> buffers() const;

 private:
  std::shared_ptr<const Primitives> primitives_;  // the methods refer to its fields
  SurfaceSettings settings_;
  std::vector<std::unique_ptr<SurfaceMethod>> methods_;
};

}  // namespace meniscus

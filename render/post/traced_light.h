#pragma once
// Secondary rays, which the processor traces (core/traced_light.h), as planes that shading takes in the place
// of those of shadow maps and occlusion maps, or over what it says itself.

#include <memory>
#include <optional>

#include "core/traced_light.h"
#include "render/frame_graph.h"
#include "render/post/shade.h"
#include "render/view_block.h"

namespace meniscus {

class TracedLight {
 public:
  /// What is traced from now on, without units; trees are built when they are needed first, and kept for the
  /// same primitives.
  void setPrimitives(std::shared_ptr<const Primitives> primitives);
  /// Of one picture.
  void set(const TracedLightSettings& settings) { settings_ = settings; }
  /// Of the next frame: which of how many rays per pixel it is.
  void choose(int sample, int samples) {
    sample_ = sample;
    samples_ = samples;
  }
  /// Adds the pass and the planes that the settings ask for. `view` and this must outlive the graph. `watch`
  /// is called while rays are traced; what it throws ends that.
  void add(FrameGraph& graph, const View& view, const Tile& tile, glm::vec2 sampleShift, LightRefs& light,
           const std::function<void()>& watch);
  bool shadows() const { return settings_.trace.shadows > 0; }
  bool occlusion() const { return settings_.trace.occlusion > 0; }
  /// Rays since the last call, if there were any, as "traced rays".
  void takeStats(std::vector<SurfaceStats>& stats);

 private:
  std::shared_ptr<const Primitives> primitives_;
  std::optional<bvh::SceneTracer> scene_;
  TracedLightSettings settings_;
  TracedPlanes planes_;
  bvh::TraceCounts counts_;
  int sample_ = 0, samples_ = 1;
};

}  // namespace meniscus

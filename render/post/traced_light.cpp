#include "render/post/traced_light.h"

#include <utility>

namespace meniscus {

void TracedLight::setPrimitives(std::shared_ptr<const Primitives> primitives) {
  if (primitives == primitives_) return;
  primitives_ = std::move(primitives);
  scene_.reset();
}

void TracedLight::takeStats(std::vector<SurfaceStats>& stats) {
  const bvh::TraceCounts counts = std::exchange(counts_, {});
  if (counts.rays == 0) return;
  SurfaceStats some;
  some.method = "traced rays";
  some.pixels = counts.rays;
  some.pieces = counts.effort.pieces;
  some.iterations = counts.effort.iterations;
  some.grazing = counts.effort.grazing;
  some.notConverged = counts.effort.notConverged;
  some.details = {{"nodes met", static_cast<double>(counts.nodes)},
                  {"cells searched", static_cast<double>(counts.leaves)},
                  {"balls in them", static_cast<double>(counts.balls)}};
  addStats(stats, some);
}

void TracedLight::add(FrameGraph& graph, const View& view, const Tile& tile, glm::vec2 sampleShift,
                      LightRefs& light, const std::function<void()>& watch) {
  using gl::TextureFormat;
  std::vector<FrameGraph::Attachment> targets;
  const auto create = [&](const char* name, TextureFormat format) {
    const TextureRef ref = graph.create(name, {format, tile.width, tile.height});
    targets.push_back({ref, static_cast<int>(targets.size())});
    return ref;
  };
  if (shadows()) light.visibility = create("visibility", TextureFormat::r16);
  if (occlusion()) light.occlusion = create("occlusion", TextureFormat::rg16);
  if (settings_.trace.light()) light.traced = create("traced light", TextureFormat::rgba32f);
  const LightRefs refs = light;
  const TracedFrame frame{view, tile.x, tile.y, tile.width, tile.height, sampleShift, sample_, samples_};
  graph.addPass("trace", {}, targets, [this, refs, frame, watch](const PassContext& context) {
    if (!scene_) scene_.emplace(primitives_);
    traceLight(*scene_, frame, settings_, planes_, counts_, watch);
    const auto write = [&](TextureRef ref, const void* data) {
      context.texture(ref).write(frame.width, frame.height, data, 0, 0);
    };
    if (shadows()) write(refs.visibility, planes_.visibility.data());
    if (occlusion()) write(refs.occlusion, planes_.occlusion.data());
    if (settings_.trace.light()) write(refs.traced, planes_.light.data());
  });
}

}  // namespace meniscus

#include "render/tile_quadrics.h"

#include <fmt/format.h>

#include <utility>

#include "core/tiles/instruction_sets.h"
#include "core/tiles/quadric_source.h"
#include "render/tile_planes.h"

namespace meniscus {

QuadricChoice chooseQuadrics(QuadricMethod method) {
  using enum QuadricMethod;
  const std::string cast = "drawn from tiles by " + tiles::instructionSet() + " instructions: ";
  if (method == tiles) return {tiles, cast + "--quadrics tiles"};
  if (method == tilesGlsl) return {tilesGlsl, "drawn from tiles by shaders: --quadrics tiles_glsl"};
  if (method == splat) return {splat, "--quadrics splat"};
  const gl::Device device = gl::queryDevice();
  if (device.software) return {tiles, cast + device.name + " runs on the processor"};
  return {splat, device.name + " is a GPU, which splats"};
}

void TileQuadrics::setPrimitives(std::shared_ptr<const Primitives> primitives) {
  primitives_ = std::move(primitives);
  camera_ = {};
  light_ = {};
  planes_ = {};
  levels_ = nullptr;
}

// Clusters and levels of detail are made once for both, and not before something is drawn.
void TileQuadrics::prepare() {
  if (levels_) return;
  levels_ = tiles::levelsOf(*primitives_);
  camera_.setPrimitives(levels_);
  light_.setPrimitives(levels_);
}

void tellDetail(FrameGraph& graph, tiles::DetailLevels& levels, const tiles::TileTarget& target,
                const std::string& prefix) {
  const int level = levels.levelFor(target);
  if (level == 0) return;
  graph.leaveOut(prefix + "detail", fmt::format("{} balls stand for {} quadrics much smaller than a pixel",
                                                levels.level(level).primitives->counts().all(),
                                                levels.level(0).primitives->counts().all()));
}

void TileQuadrics::add(FrameGraph& graph, const tiles::TileTarget& target, const GBufferRefs& g,
                       const std::string& prefix) {
  prepare();
  tellDetail(graph, *levels_, target, prefix);
  tiles::QuadricTiles& caster = prefix.empty() ? camera_ : light_;
  // The framebuffer is bound for nothing but its clearing: the part with no block in it stays background.
  graph.addPass(prefix + "tiles", {}, attachmentsOf(g),
                [this, &caster, target, g](const PassContext& context) {
                  caster.cast(target, wantedPlanes(context, g), planes_, wantedExtent(g));
                  writePlanes(context, g, planes_, target.area);
                });
}

}  // namespace meniscus

#include "render/tile_quadrics.h"

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
  prepared_ = false;
}

// Clusters are made once for both, and not before something is drawn.
void TileQuadrics::prepare() {
  if (std::exchange(prepared_, true)) return;
  const auto clusters = std::make_shared<const tiles::Clusters>(tiles::clustersOf(*primitives_));
  camera_.setPrimitives(primitives_.get(), clusters);
  light_.setPrimitives(primitives_.get(), clusters);
}

void TileQuadrics::add(FrameGraph& graph, const View& view, const Tile& tile, glm::vec2 sampleShift,
                       const GBufferRefs& g, const std::string& prefix) {
  const tiles::TileTarget target{
      view, primitives_->origin, {tile.x, tile.y, tile.width, tile.height}, sampleShift};
  prepare();
  tiles::QuadricTiles& caster = prefix.empty() ? camera_ : light_;
  // The framebuffer is bound for nothing but its clearing: the part with no block in it stays background.
  graph.addPass(prefix + "tiles", {}, attachmentsOf(g),
                [this, &caster, target, g](const PassContext& context) {
                  caster.cast(target, wantedPlanes(context, g), planes_, wantedExtent(g));
                  writePlanes(context, g, planes_, target.area);
                });
}

}  // namespace meniscus

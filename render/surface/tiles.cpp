#include "render/surface/tiles.h"

#include <glad/gl.h>

#include <algorithm>
#include <utility>

#include "core/tiles/field_tiles.h"
#include "core/tiles/instruction_sets.h"
#include "render/post/fullscreen.h"
#include "render/tile_planes.h"

namespace meniscus {

namespace {

class Tiles : public SurfaceMethod {
 public:
  void prepare(const MetaballField& field) override {
    clusters_ = std::make_shared<const tiles::Clusters>(tiles::clustersOf(field));
    camera_.setField(&field, clusters_);
    light_.setField(&field, clusters_);
  }
  void addPasses(FrameGraph& graph, ShaderLibrary& shaders, const SurfaceTarget& target) override;
  SurfaceStats takeStats() override;
  std::vector<ResourceStats> buffers() const override { return {}; }
  std::uint64_t bytesOfBalls() const override {
    return clusters_->bytes() + camera_.bytesOfLists() + light_.bytesOfLists();
  }

 private:
  void drawOver(const PassContext& context, ShaderLibrary& shaders, const tiles::TileTarget& target,
                const GBufferRefs& g);

  std::shared_ptr<const tiles::Clusters> clusters_;
  tiles::FieldTiles camera_, light_;  // lists of the picture outlive a shadow map
  tiles::Planes planes_;
  double mostBytesPerPixel_ = 0;
};

void Tiles::addPasses(FrameGraph& graph, ShaderLibrary& shaders, const SurfaceTarget& target) {
  const GBufferRefs g = target.gbuffer;
  const Tile& tile = target.tile;
  const tiles::TileTarget cast{
      target.view, target.origin, {tile.x, tile.y, tile.width, tile.height}, target.sampleShift};
  tiles::FieldTiles& caster = target.prefix.empty() ? camera_ : light_;
  std::vector<TextureRef> reads;
  const bool alone = target.first || g.planes.valid();  // what hides the surface is not in textures
  if (!alone) reads.push_back(g.depth);
  graph.addPass(target.prefix + "surface", std::move(reads), attachmentsOf(g),
                [this, &shaders, &caster, cast, g, alone](const PassContext& context) {
                  caster.cast(cast, wantedPlanes(context, g), planes_, wantedExtent(g));
                  // In main memory, and for drawOver() in textures, too.
                  const double bytes =
                      static_cast<double>(planes_.bytes()) / planes_.area.width / planes_.area.height;
                  mostBytesPerPixel_ = std::max(mostBytesPerPixel_, alone ? bytes : 2 * bytes);
                  if (alone) {
                    writePlanes(context, g, planes_, cast.area);
                  } else {
                    drawOver(context, shaders, cast, g);
                  }
                });
}

// The depth test decides against what is there.
void Tiles::drawOver(const PassContext& context, ShaderLibrary& shaders, const tiles::TileTarget& target,
                     const GBufferRefs& g) {
  const tiles::PlaneChannels channels = wantedPlanes(context, g);
  const tiles::PixelArea& part = planes_.area;
  const int x = part.x - target.area.x, y = part.y - target.area.y;
  std::vector<TextureLease> leases;
  // As large as the target, of which the part is a different one in every view.
  const auto bind = [&](const char* name, gl::TextureFormat format, unsigned unit, const void* data) {
    leases.push_back(context.pool().lease(name, {format, target.area.width, target.area.height}));
    leases.back()->write(part.width, part.height, data, x, y);
    glBindTextureUnit(unit, leases.back()->object.name());
  };
  bind("surface depth", gl::TextureFormat::r32f, 0, planes_.depth.data());
  if (channels.albedo) bind("surface albedo", gl::TextureFormat::rgba8, 1, planes_.albedo.data());
  if (channels.normal) bind("surface normal", gl::TextureFormat::rg16, 2, planes_.normal.data());
  if (channels.id) bind("surface id", gl::TextureFormat::r32ui, 3, planes_.id.data());
  if (channels.distance) bind("surface distance", gl::TextureFormat::r32f, 4, planes_.distance.data());
  context.bindTarget();
  glEnable(GL_SCISSOR_TEST);
  glScissor(x, y, part.width, part.height);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  drawFullscreen(shaders.program("post/fullscreen.vert", "surface/tiles.frag", channelFlags(context, g)));
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_SCISSOR_TEST);
}

SurfaceStats Tiles::takeStats() {
  tiles::FieldCounts counts = camera_.takeCounts();
  counts.add(light_.takeCounts());
  SurfaceStats stats;
  stats.method = "tiles (" + tiles::instructionSet() + ")";
  stats.pixels = counts.rays;
  stats.pieces = counts.pieces;
  stats.iterations = counts.iterations;
  stats.mostIterations = counts.mostIterations;
  stats.grazing = counts.grazing;
  stats.notConverged = counts.notConverged;
  stats.details = {{"intervals bounded", static_cast<double>(counts.intervals)},
                   {"longer stretches bounded", static_cast<double>(counts.stretches)},
                   {"intervals halved", static_cast<double>(counts.splits)},
                   {"most balls kept at once", static_cast<double>(counts.mostChords)},
                   {"most bytes per pixel", mostBytesPerPixel_}};
  mostBytesPerPixel_ = 0;
  return stats;
}

}  // namespace

std::unique_ptr<SurfaceMethod> makeTiles(const SurfaceParameters&) {
  return std::make_unique<Tiles>();
}

}  // namespace meniscus

#include "render/surface/tiles_glsl.h"

#include <algorithm>

#include "render/surface/list_caster.h"
#include "render/surface/tile_ball_lists.h"

namespace meniscus {

namespace {

constexpr SurfaceParameter kTilesGlslParameters[] = {
    {"tolerance", "width to which a root is narrowed down, as a share of the smallest support around it",
     1e-5, 1e-7, 0.1, false},
    {"array", "separators that a pixel's array holds; where it is too short, the list is walked", kListArray,
     3, kListArray, true},
};

class TilesGlsl : public SurfaceMethod {
 public:
  explicit TilesGlsl(const SurfaceParameters& values)
      : caster_("tiles_glsl", values.at("tolerance"), static_cast<int>(values.at("array")), true) {}

  void prepare(const MetaballField& field) override {
    coreShares_ = coreShares(field);
    clusters_ = std::make_shared<const tiles::Clusters>(tiles::clustersOf(field));
    camera_.setField(&field, &coreShares_, clusters_);
    light_.setField(&field, &coreShares_, clusters_);
    caster_.prepare(field);
  }
  void addPasses(FrameGraph& graph, ShaderLibrary& shaders, const SurfaceTarget& target) override;
  SurfaceStats takeStats() override { return caster_.statistics().take("tiles_glsl"); }
  std::vector<ResourceStats> buffers() const override {
    return {{"surface: balls", camera_.balls().bytes() + light_.balls().bytes()},
            {"surface: lists of tiles",
             bytesOfBalls() - clusters_->bytes() - camera_.balls().bytes() - light_.balls().bytes()},
            {"surface: heads of lists", caster_.bytesOfHeads()},
            {"surface: control", caster_.bytesOfControl()}};
  }
  std::uint64_t bytesOfBalls() const override {
    return clusters_->bytes() + camera_.bytes() + light_.bytes();
  }

 private:
  void draw(const PassContext& context, ShaderLibrary& shaders, const SurfaceTarget& target);

  std::vector<float> coreShares_;
  std::shared_ptr<const tiles::Clusters> clusters_;
  TileBallLists camera_, light_;  // lists of the picture outlive a shadow map
  ListCaster caster_;
};

void TilesGlsl::addPasses(FrameGraph& graph, ShaderLibrary& shaders, const SurfaceTarget& target) {
  graph.addPass(target.prefix + "surface", {target.gbuffer.depth}, attachmentsOf(target.gbuffer),
                [this, &shaders, target](const PassContext& context) { draw(context, shaders, target); });
}

void TilesGlsl::draw(const PassContext& context, ShaderLibrary& shaders, const SurfaceTarget& target) {
  TileBallLists& lists = target.prefix.empty() ? camera_ : light_;
  const Tile& tile = target.tile;
  context.part(target.prefix + "surface: lists", [&] {
    lists.update({target.view, target.origin, {tile.x, tile.y, tile.width, tile.height}, target.sampleShift});
  });
  if (lists.lists().entries() == 0) return;
  ListsStatistics& statistics = caster_.statistics();
  statistics.ballsInView += static_cast<double>(lists.listed());
  statistics.nodes += static_cast<double>(lists.lists().entries());
  statistics.mostOfPixel = std::max(statistics.mostOfPixel, static_cast<double>(lists.lists().longest()));
  statistics.mostBytesPerPixel =
      std::max(statistics.mostBytesPerPixel, static_cast<double>(kListBytesPerPixel));
  ListTarget drawn{
      context, shaders, target.gbuffer, {}, {}, caster_.flags(false), lists.balls().placeScale()};
  drawn.flags.insert("TILES");
  caster_.setGrid(lists.lists().grid());
  const tiles::PixelArea& part = lists.occupied();
  const ScreenRect occupied{part.x - tile.x, part.y - tile.y, part.width, part.height};
  context.part(target.prefix + "surface: cast", [&] {
    for (const ScreenRect& in : splitRect(occupied, kListRegionPixels)) {
      const ListRegion region = caster_.begin(drawn, in);
      lists.bind();
      caster_.clearCores(drawn, region);
      caster_.layHidden(drawn);
      caster_.draw(drawn, region, {0, 0, in.width, in.height}, 0);
      ++statistics.bands;
    }
  });
  context.bindTarget();
}

}  // namespace

std::span<const SurfaceParameter> tilesGlslParameters() {
  return kTilesGlslParameters;
}

std::unique_ptr<SurfaceMethod> makeTilesGlsl(const SurfaceParameters& values) {
  return std::make_unique<TilesGlsl>(values);
}

}  // namespace meniscus

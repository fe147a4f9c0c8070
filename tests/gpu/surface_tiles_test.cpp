// Both casters of tile lists through the renderer, judged by the truth in the scenes that break methods.

#include <gtest/gtest.h>

#include <cmath>

#include "render/surface_method.h"
#include "tests/gpu/surface_judge.h"
#include "tests/support/exact_field.h"
#include "tests/support/paths.h"
#include "tests/support/scenes.h"

namespace meniscus {
namespace {

constexpr Projection kBoth[] = {Projection::perspective, Projection::orthographic};

class SurfaceTiles : public test::SurfaceTest, public testing::WithParamInterface<const char*> {
 protected:
  const SurfaceSettings tiles{GetParam(), {}};
};
class SurfaceOfAuto : public test::SurfaceTest {};
INSTANTIATE_TEST_SUITE_P(Both, SurfaceTiles, testing::Values("tiles", "tiles_glsl"),
                         [](const auto& caster) { return std::string(caster.param); });

TEST_P(SurfaceTiles, RandomBalls) {
  const test::SurfaceScene scene = test::randomScene(1000, 1);
  for (const Projection projection : kBoth)
    expectExact(judge(scene, viewOf(scene, {160, 120}, projection), tiles));
  EXPECT_EQ(stats.method.find(GetParam()), 0u);
  EXPECT_EQ(stats.notConverged, 0u);
}

TEST_P(SurfaceTiles, AMolecule) {
  const test::SurfaceScene scene = test::moleculeScene(test::projectFile("molecules/2hhb.pdb.gz"));
  expectExact(judge(scene, viewOf(scene, {96, 72}), tiles));
}

TEST_P(SurfaceTiles, TwoHundredCoincidentBalls) {
  const test::SurfaceScene scene = test::coincidentBalls();
  for (const Projection projection : kBoth)
    expectExact(judge(scene, viewOf(scene, {24, 18}, projection), tiles));
}

TEST_P(SurfaceTiles, AThousandBallsAlongOneRay) {
  const auto [scene, view] = test::ballsAlongOneRay();
  expectExact(judge(scene, view, tiles));
}

TEST_P(SurfaceTiles, ALatticeSeenAlongAnAxis) {
  const auto [scene, view] = test::latticeAlongAxis();
  expectExact(judge(scene, view, tiles));
}

TEST_P(SurfaceTiles, LevelNearTheMaximum) {
  for (const double below : {1e-2, 1e-3, 1e-4}) {
    SCOPED_TRACE(below);
    const auto [scene, view] = test::nearMaximum(1, below);
    expectExact(judge(scene, view, tiles));
  }
}

// Surfaces among themselves, and with quadrics however these are drawn.
TEST_P(SurfaceTiles, QuadricsAndSurfacesHideEachOther) {
  for (const QuadricMethod quadrics : {QuadricMethod::splat, QuadricMethod::tiles, QuadricMethod::tilesGlsl})
    expectSpheresAndSurfacesHideEachOther(tiles, quadrics);
}

TEST_P(SurfaceTiles, AnyTilesOfTheTargetGiveTheSameBytes) {
  expectAnyTilesGiveTheSameBytes(tiles);
}

TEST_P(SurfaceTiles, EveryKernel) {
  for (const Kernel kernel : {Kernel{KernelShape::quartic}, Kernel{KernelShape::power, 2},
                              Kernel{KernelShape::power, 7}, Kernel{KernelShape::power, 16}}) {
    SCOPED_TRACE(kernel.exponent);
    const test::SurfaceScene scene(test::randomField(kernel, 0.3, 60, 4, 0, 7));
    expectExact(judge(scene, viewOf(scene, {80, 60}), tiles));
  }
}

// Lists and what is uploaded for them serve all samples of a view, and not the next view.
TEST_P(SurfaceTiles, ASecondViewIsDrawnAsIfItWereTheFirst) {
  const test::SurfaceScene scene = test::randomScene(150, 3);
  const View views[] = {viewOf(scene, {90, 70}), viewOf(scene, {70, 90}, Projection::orthographic)};
  RenderSettings settings = test::withSamples(3);
  settings.surface = tiles;
  settings.shadows.mode = ShadowMode::hard;
  const auto picture = [&](Renderer& renderer, const View& view) {
    test::MemorySink sink;
    renderer.renderPicture(view, Lighting{}, {}, settings, PixelFormat::rgba8, sink);
    return sink.bytes;
  };
  Renderer both;
  both.setPrimitives(scene.primitives);
  for (const View& view : views) {
    Renderer fresh;
    fresh.setPrimitives(scene.primitives);
    EXPECT_EQ(picture(both, view), picture(fresh, view));
  }
}

// Of what the two casters draw: the same pixels, to rounding.
TEST_F(SurfaceOfAuto, IsWhatShadersDrawToo) {
  const test::SurfaceScene scene = test::randomScene(1000, 2);
  const View view = viewOf(scene, {160, 120});
  const HitImage a = draw(scene, view, {"tiles", {}}), b = draw(scene, view, {"tiles_glsl", {}});
  EXPECT_EQ(a.id, b.id);
  int apart = 0;
  for (std::size_t i = 0; i < a.distance.size(); ++i) {
    if (a.id[i] == 0) continue;
    apart += std::abs(a.distance[i] - b.distance[i]) > 2e-5f;
    EXPECT_NEAR(a.distance[i], b.distance[i], 5e-3f);  // where the ray grazes
  }
  EXPECT_LE(apart, 20);
}

TEST_F(SurfaceOfAuto, IsThatOfTiles) {
  EXPECT_EQ(surfaceMethodFor({}).name, "tiles");
  const test::SurfaceScene scene = test::randomScene(30, 3);
  EXPECT_EQ(draw(scene, viewOf(scene, {40, 30}), {}).distance,
            draw(scene, viewOf(scene, {40, 30}), {"tiles", {}}).distance);
}

}  // namespace
}  // namespace meniscus

// The surface method "tiles" through the renderer, judged by the truth in the scenes that break methods.

#include <gtest/gtest.h>

#include "render/surface_method.h"
#include "tests/gpu/surface_judge.h"
#include "tests/support/paths.h"

namespace meniscus {
namespace {

const SurfaceSettings kTiles{"tiles", {}};
constexpr Projection kBoth[] = {Projection::perspective, Projection::orthographic};

class SurfaceTiles : public test::SurfaceTest {};

TEST_F(SurfaceTiles, RandomBalls) {
  const test::SurfaceScene scene = test::randomScene(1000, 1);
  for (const Projection projection : kBoth)
    expectExact(judge(scene, viewOf(scene, {160, 120}, projection), kTiles));
  EXPECT_EQ(stats.method.find("tiles ("), 0u);
  EXPECT_EQ(stats.notConverged, 0u);
}

TEST_F(SurfaceTiles, AMolecule) {
  const test::SurfaceScene scene = test::moleculeScene(test::projectFile("molecules/2hhb.pdb.gz"));
  expectExact(judge(scene, viewOf(scene, {96, 72}), kTiles));
}

TEST_F(SurfaceTiles, TwoHundredCoincidentBalls) {
  const test::SurfaceScene scene = test::coincidentBalls();
  for (const Projection projection : kBoth)
    expectExact(judge(scene, viewOf(scene, {24, 18}, projection), kTiles));
}

TEST_F(SurfaceTiles, AThousandBallsAlongOneRay) {
  const auto [scene, view] = test::ballsAlongOneRay();
  expectExact(judge(scene, view, kTiles));
}

TEST_F(SurfaceTiles, ALatticeSeenAlongAnAxis) {
  const auto [scene, view] = test::latticeAlongAxis();
  expectExact(judge(scene, view, kTiles));
}

TEST_F(SurfaceTiles, LevelNearTheMaximum) {
  for (const double below : {1e-2, 1e-3, 1e-4}) {
    SCOPED_TRACE(below);
    const auto [scene, view] = test::nearMaximum(1, below);
    expectExact(judge(scene, view, kTiles));
  }
}

// Surfaces among themselves, and with quadrics however these are drawn.
TEST_F(SurfaceTiles, QuadricsAndSurfacesHideEachOther) {
  for (const QuadricMethod quadrics : {QuadricMethod::splat, QuadricMethod::tiles})
    expectSpheresAndSurfacesHideEachOther(kTiles, quadrics);
}

TEST_F(SurfaceTiles, AnyTilesOfTheTargetGiveTheSameBytes) {
  expectAnyTilesGiveTheSameBytes(kTiles);
}

TEST_F(SurfaceTiles, AreWhatAutoTakes) {
  EXPECT_EQ(surfaceMethodFor({}).name, "tiles");
  const test::SurfaceScene scene = test::randomScene(30, 3);
  EXPECT_EQ(draw(scene, viewOf(scene, {40, 30}), {}).distance,
            draw(scene, viewOf(scene, {40, 30}), kTiles).distance);
}

}  // namespace
}  // namespace meniscus

// Scenes that break methods, drawn by every method that is exact in all of them, against the truth.

#include <gtest/gtest.h>

#include "render/surface_method.h"
#include "tests/gpu/surface_judge.h"
#include "tests/support/exact_field.h"

namespace meniscus {
namespace {

constexpr Projection kBoth[] = {Projection::perspective, Projection::orthographic};

struct Method {
  const char* name;
  double normalsNearMaximum;  // RMS [degrees]: the gradient all but vanishes there
};

class SpecialScenes : public test::SurfaceTest, public testing::WithParamInterface<Method> {
 protected:
  SurfaceSettings method() const { return {GetParam().name, {}}; }
};

TEST_P(SpecialScenes, AThousandBallsAlongOneRay) {
  const auto [scene, view] = test::ballsAlongOneRay();
  expectExact(judge(scene, view, method()));
}

TEST_P(SpecialScenes, ALatticeSeenAlongAnAxis) {
  const auto [scene, view] = test::latticeAlongAxis();
  expectExact(judge(scene, view, method()));
  expectExact(judge(scene, latticeInPerspective(scene), method()));
}

TEST_P(SpecialScenes, NegativeBallsHollowTheSurface) {
  for (const Kernel kernel : {Kernel{}, Kernel{KernelShape::quartic}}) {
    const test::SurfaceScene scene(test::randomField(kernel, 0.3, 80, 4, 3, 11));
    for (const Projection projection : kBoth)
      expectExact(judge(scene, viewOf(scene, {80, 60}, projection), method()));
  }
  const auto [scene, view] = test::insideOfCavity();
  const HitErrors errors = judge(scene, view, method());
  expectExact(errors);
  EXPECT_EQ(errors.compared + errors.grazing, 64u * 48u);
}

TEST_P(SpecialScenes, CameraInsideBallsAndInsideTheSurface) {
  const test::SurfaceScene scene = test::randomScene(200, 5);
  int i = 0;
  for (const View& view : viewsFromInside(scene)) {
    SCOPED_TRACE(i);
    expectExact(judge(scene, view, method(), "inside" + std::to_string(i++)));
  }
}

TEST_P(SpecialScenes, SupportsFromAThousandthToAThousand) {
  const test::SurfaceScene scene = test::manyScales();
  for (const double radius : {1000.0, 10.0, 0.1, 0.001}) {
    SCOPED_TRACE(radius);
    expectExact(judge(scene, viewOfScale(scene, radius), method(), "radius" + std::to_string(radius)));
  }
}

TEST_P(SpecialScenes, FarAwayAndAtWideAndNarrowAngles) {
  const test::SurfaceScene scene = test::randomScene(150, 3);
  expectExact(judge(scene, viewFromAfar(scene, {96, 72}), method()));
  for (const double degrees : {1.0, 150.0})
    expectExact(judge(scene, viewOfAngle(scene, degrees), method(), "fov" + std::to_string(degrees)));
  scene.primitives->origin = {1e6, -1e6, 1e6 + 0.123456789};
  expectExact(judge(scene, viewOf(scene, {96, 72}), method(), "shifted"));
}

TEST_P(SpecialScenes, LevelsNearZero) {
  const test::SurfaceScene scene = test::randomScene(60, 6);
  for (const double level : {1e-2, 1e-4, 1e-6}) {
    scene.primitives->surfaces[0].level = level;
    SCOPED_TRACE(level);
    expectExact(judge(scene, viewOf(scene, {96, 72}), method(), "level" + std::to_string(level)));
  }
}

TEST_P(SpecialScenes, LevelsNearTheMaximum) {
  for (const unsigned balls : {1u, 2u}) {
    for (const double below : {1e-2, 1e-3, 1e-4}) {
      SCOPED_TRACE(below);
      const auto [scene, view] = test::nearMaximum(balls, below);
      const HitErrors errors =
          judge(scene, view, method(), "balls" + std::to_string(balls) + "_below" + std::to_string(below));
      EXPECT_EQ(errors.missed + errors.falseHits, 0u);
      EXPECT_GT(errors.compared, 300u);
      EXPECT_LE(errors.relativeRms, 1e-5);
      EXPECT_LE(errors.normalRmsDeg, GetParam().normalsNearMaximum);
    }
  }
}

TEST_P(SpecialScenes, TangentRaysMissAndEnd) {
  expectTangentRaysMiss(method());
}

TEST_P(SpecialScenes, AnyTilesOfTheTargetGiveTheSameBytes) {
  expectAnyTilesGiveTheSameBytes(method());
}

INSTANTIATE_TEST_SUITE_P(Surface, SpecialScenes,
                         testing::Values(Method{"bvh", 0.05}, Method{"lists", 0.1}, Method{"newton", 0.05},
                                         Method{"tiles_glsl", 0.1}),
                         [](const auto& method) { return std::string(method.param.name); });

class SurfaceBytes : public test::SurfaceTest {};

// Whatever the method keeps, at least where a ball is and how far it reaches; what pixels take does not
// count.
TEST_F(SurfaceBytes, EveryMethodSaysWhatABallTakes) {
  const test::SurfaceScene scene = test::randomScene(1000, 1);
  for (const SurfaceMethodInfo& method : surfaceMethods()) {
    SCOPED_TRACE(method.name);
    const auto bytes = [&](ImageSize size) {
      draw(scene, viewOf(scene, size), {std::string(method.name), {}});
      return detail("most bytes per ball");
    };
    const double small = bytes({24, 18}), large = bytes({96, 72});
    EXPECT_GE(small, 16);
    EXPECT_LE(large, 20'000);
    const double ofPixels = detail("most bytes per pixel");
    EXPECT_EQ(ofPixels > 0, method.name != "mesh") << ofPixels;  // whose triangles go into the G-buffer
    EXPECT_LE(ofPixels, 20'000);
    if (!method.name.starts_with("tiles")) {  // whose lists are longer for more tiles
      EXPECT_EQ(large, small);
    }
  }
}

}  // namespace
}  // namespace meniscus

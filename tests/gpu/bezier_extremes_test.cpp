// Depth-peeled Bezier clipping at the ends of the numbers: scales, distances, angles, levels.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/gpu/surface_judge.h"

namespace meniscus {
namespace {

using test::options;

class BezierExtremes : public test::SurfaceTest {};

// As a whole, and at every magnification down to the smallest ball.
TEST_F(BezierExtremes, SupportsFromAThousandthToAThousand) {
  const test::SurfaceScene scene = test::manyScales();
  for (const double radius : {1000.0, 100.0, 10.0, 1.0, 0.1, 0.01, 0.001}) {
    SCOPED_TRACE(radius);
    expectExact(judge(scene, viewOfScale(scene, radius), options(), "radius" + std::to_string(radius)));
  }
  expectExact(judge(scene, viewOf(scene, {64, 48}, Projection::orthographic), options(), "orthographic"));
}

TEST_F(BezierExtremes, ShiftedByAMillion) {
  test::SurfaceScene scene = test::randomScene(150, 3);
  scene.primitives->origin = {1e6, -1e6, 1e6 + 0.123456789};
  expectExact(judge(scene, viewOf(scene, {96, 72}), options()));
}

TEST_F(BezierExtremes, CameraAtTenThousand) {
  const test::SurfaceScene scene = test::randomScene(150, 3);
  expectExact(judge(scene, viewFromAfar(scene, {96, 72}), options()));
}

TEST_F(BezierExtremes, FieldsOfViewOfOneAndOf150Degrees) {
  const test::SurfaceScene scene = test::randomScene(150, 3);
  for (const double degrees : {1.0, 150.0}) {
    SCOPED_TRACE(degrees);
    expectExact(judge(scene, viewOfAngle(scene, degrees), options(),
                      "fov" + std::to_string(static_cast<int>(degrees))));
  }
}

TEST_F(BezierExtremes, Orthographic) {
  const test::SurfaceScene scene = test::randomScene(150, 3);
  expectExact(judge(scene, viewOf(scene, {96, 72}, Projection::orthographic), options()));
}

TEST_F(BezierExtremes, LevelNearZero) {
  for (const double level : {1e-2, 1e-4, 1e-6}) {
    test::SurfaceScene scene = test::randomScene(60, 6);
    scene.primitives->surfaces[0].level = level;
    SCOPED_TRACE(level);
    expectExact(judge(scene, viewOf(scene, {96, 72}), options(), "level" + std::to_string(level)));
  }
}

// A lone ball's largest value is 1, two coincident ones' 2.
TEST_F(BezierExtremes, LevelNearTheMaximum) {
  for (const unsigned balls : {1u, 2u}) {
    for (const double below : {1e-2, 1e-3, 1e-4}) {
      SCOPED_TRACE(below);
      const auto [scene, view] = test::nearMaximum(balls, below);
      expectExact(
          judge(scene, view, options(), "balls" + std::to_string(balls) + "_below" + std::to_string(below)));
    }
  }
}

TEST_F(BezierExtremes, NothingIsDrawnAboveEveryMaximum) {
  for (const unsigned balls : {1u, 2u, 40u}) {
    const test::SurfaceScene scene = test::nearMaximum(balls, -1e-5).scene;
    const HitImage image = draw(scene, viewOf(scene, {63, 47}), options());
    EXPECT_EQ(std::count(image.id.begin(), image.id.end(), 0u), std::ptrdiff_t{63} * 47);
  }
  test::SurfaceScene scene = test::randomScene(100, 6);
  scene.primitives->surfaces[0].level = 1000;
  const HitImage image = draw(scene, viewOf(scene, {64, 48}), options());
  EXPECT_EQ(std::count(image.id.begin(), image.id.end(), 0u), std::ptrdiff_t{64} * 48);
}

TEST_F(BezierExtremes, TangentRays) {
  expectTangentRaysMiss(options());
}

}  // namespace
}  // namespace meniscus

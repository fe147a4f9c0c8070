// Depth-peeled Bezier clipping at the ends of the numbers: scales, distances, angles, levels.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/gpu/surface_judge.h"

namespace meniscus {
namespace {

using test::options;

class BezierExtremes : public test::SurfaceTest {};

MetaballField ofManyScales(unsigned seed) {
  test::Random random(seed);
  MetaballField field;
  for (unsigned i = 1; i <= 120; ++i) {
    const double support = i == 1 ? 1e3 : i == 2 ? 1e-3 : random.logUniform(1e-3, 1e3);
    // Around the smallest ball, at distances of the size of each.
    const glm::dvec3 at = i == 2 ? glm::dvec3(0) : random.direction() * support * random.uniform(0.5, 1.5);
    field.balls.push_back({glm::vec3(at), static_cast<float>(support), 1.0f, 0x808080, i});
  }
  field.level = 0.9;
  return field;
}

// As a whole, and at every magnification down to the smallest ball.
TEST_F(BezierExtremes, SupportsFromAThousandthToAThousand) {
  const test::SurfaceScene scene(ofManyScales(21));
  for (const double radius : {1000.0, 100.0, 10.0, 1.0, 0.1, 0.01, 0.001}) {
    Camera camera;
    camera.distance = 4 * radius;
    camera.fovY = 0.6;
    const View view = makeView(camera, {64, 48}, scene.primitives->bounds());
    SCOPED_TRACE(radius);
    expectExact(judge(scene, view, options(), "radius" + std::to_string(radius)));
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
  View view = viewOf(scene, {96, 72});
  const double before = view.distance;
  view.distance = 1e4;
  view.pixelSize *= before / view.distance;
  expectExact(judge(scene, view, options()));
}

TEST_F(BezierExtremes, FieldsOfViewOfOneAndOf150Degrees) {
  const test::SurfaceScene scene = test::randomScene(150, 3);
  const double radius = scene.primitives->bounds().radius;
  for (const double degrees : {1.0, 150.0}) {
    Camera camera;
    camera.target = scene.primitives->origin;
    camera.fovY = degrees * 3.14159265358979 / 180;
    camera.distance = degrees < 90 ? radius / std::sin(camera.fovY / 2) : 0.9 * radius;
    camera.orientation = glm::normalize(glm::dquat(0.9, 0.2, -0.3, 0.1));
    SCOPED_TRACE(degrees);
    expectExact(judge(scene, makeView(camera, {96, 72}, scene.primitives->bounds()), options(),
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
      MetaballField field;
      field.level = balls * (1 - below);
      for (unsigned i = 1; i <= balls; ++i) field.balls.push_back({{3, 1, -2}, 2.0f, 1.0f, 0x808080, i});
      const test::SurfaceScene scene(field);
      Camera camera;
      camera.target = {3, 1, -2};
      camera.distance = 10;
      camera.fovY = 0.6 * std::sqrt(below);  // what is left fills the picture
      SCOPED_TRACE(below);
      expectExact(judge(scene, makeView(camera, {64, 48}, scene.primitives->bounds()), options(),
                        "balls" + std::to_string(balls) + "_below" + std::to_string(below)));
    }
  }
}

TEST_F(BezierExtremes, NothingIsDrawnAboveEveryMaximum) {
  for (const unsigned balls : {1u, 2u, 40u}) {
    MetaballField field;
    field.level = balls * (1 + 1e-5);
    for (unsigned i = 1; i <= balls; ++i) field.balls.push_back({{3, 1, -2}, 2.0f, 1.0f, 0x808080, i});
    const test::SurfaceScene scene(field);
    const HitImage image = draw(scene, viewOf(scene, {63, 47}), options());
    EXPECT_EQ(std::count(image.id.begin(), image.id.end(), 0u), std::ptrdiff_t{63} * 47);
  }
  test::SurfaceScene scene = test::randomScene(100, 6);
  scene.primitives->surfaces[0].level = 1000;
  const HitImage image = draw(scene, viewOf(scene, {64, 48}), options());
  EXPECT_EQ(std::count(image.id.begin(), image.id.end(), 0u), std::ptrdiff_t{64} * 48);
}

// Touching without crossing is no hit, and is never looped on.
TEST_F(BezierExtremes, TangentRays) {
  MetaballField field;
  field.level = 1;  // reached at the centres alone
  for (unsigned i = 0; i < 9; ++i)
    field.balls.push_back({{3 * static_cast<float>(i % 3) - 3, 3 * static_cast<float>(i / 3) - 3, 0},
                           1.0f,
                           1.0f,
                           0x808080,
                           i + 1});
  field.balls.push_back({{0, 0, 3}, 1.0f, 0.5f, 0x808080, 10});
  field.balls.push_back({{0, 0, 3}, 1.0f, 0.5f, 0x808080, 11});
  const test::SurfaceScene scene(field);
  View view = test::alongZ(0, 0, 10);
  view.size = {15, 15};
  view.pixelSize = 0.5;
  view.center = {7.5, 7.5};
  const HitImage image = draw(scene, view, options());
  // Of two balls' sum, which is the level to the last bit, rounding decides.
  for (int i = 0; i < 15 * 15; ++i) {
    const bool sum = i == 7 * 15 + 7;
    EXPECT_TRUE(sum || image.id[static_cast<std::size_t>(i)] == 0) << i;
  }
  EXPECT_EQ(stats.notConverged, 0u);
}

}  // namespace
}  // namespace meniscus

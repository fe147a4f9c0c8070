// Spheres and cylinders on the GPU against brute force in extended precision.

#include <gtest/gtest.h>

#include <cmath>

#include "render/renderer.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/scenes.h"

namespace meniscus {
namespace {

using test::exactHit;
using test::ExactHit;

class Quadrics : public test::GlTest, public testing::WithParamInterface<QuadricMethod> {
 protected:
  // Every pixel is right: the same thing is met, at the same distance, unless the ray grazes something or two
  // things are met within `tolerance` [Å] of each other. Returns how many pixels show something.
  int expectExact(const std::shared_ptr<Primitives>& primitives, const View& view, double tolerance = 1e-4) {
    Renderer renderer;
    renderer.setPrimitives(primitives);
    const HitImage image =
        renderer.renderHits(view, {.distance = true, .normal = true, .id = true}, {}, GetParam());
    int shown = 0, excused = 0;
    for (int y = 0; y < view.size.height; ++y) {
      for (int x = 0; x < view.size.width; ++x) {
        const auto i = static_cast<std::size_t>(y * view.size.width + x);
        const ExactHit truth = exactHit(*primitives, view, {x + 0.5, y + 0.5}, tolerance);
        shown += truth.id != 0;
        if (truth.clearance < tolerance || truth.runnerUp - truth.distance < tolerance) {
          ++excused;
          continue;
        }
        EXPECT_EQ(image.id[i], truth.id) << "pixel " << x << ", " << y;
        if (truth.id == 0) {
          EXPECT_TRUE(std::isinf(image.distance[i]));
          EXPECT_EQ(image.normal[i], glm::vec3(0));
          continue;
        }
        const double half = std::nextafter(image.distance[i], INFINITY) - image.distance[i];
        EXPECT_NEAR(static_cast<double>(image.distance[i]), truth.distance, tolerance + half)
            << "pixel " << x << ", " << y;
        const Ray ray = rayThrough(view, {x + 0.5, y + 0.5});
        EXPECT_LE(glm::dot(glm::dvec3(image.normal[i]), ray.direction), 1e-4)
            << "normal away from the viewer";
        if (testing::Test::HasFailure()) return shown;
      }
    }
    EXPECT_LT(excused, view.size.width * view.size.height / 50 + 2) << "most pixels must be judged";
    return shown;
  }
};

INSTANTIATE_TEST_SUITE_P(By, Quadrics, testing::Values(QuadricMethod::splat, QuadricMethod::tiles),
                         [](const auto& each) {
                           return each.param == QuadricMethod::splat ? "splat" : "tiles";
                         });

TEST_P(Quadrics, SpheresArePixelExactInPerspective) {
  const auto scene = test::randomSpheres(300, 1);
  EXPECT_GT(expectExact(scene, test::viewOf(*scene, {160, 120})), 5000);
}

TEST_P(Quadrics, SpheresArePixelExactInOrthographicViews) {
  const auto scene = test::randomSpheres(300, 2);
  EXPECT_GT(expectExact(scene, test::viewOf(*scene, {160, 120}, Projection::orthographic)), 5000);
}

TEST_P(Quadrics, BallsAndSticksArePixelExact) {
  const auto scene = test::randomChain(60, 3);
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    EXPECT_GT(expectExact(scene, test::viewOf(*scene, {200, 150}, projection)), 3000);
  }
}

TEST_P(Quadrics, WideAndNarrowFieldsOfView) {
  const auto scene = test::randomChain(40, 4);
  for (const double degrees : {0.01, 1.0, 120.0, 170.0}) {
    const View view =
        test::viewOf(*scene, {120, 90}, Projection::perspective, degrees * 0.017453292519943295);
    EXPECT_GT(expectExact(scene, view, degrees < 0.1 ? 1e-3 : 1e-4), 300) << degrees;
  }
}

TEST_P(Quadrics, NoFalseMissAndNoErrorAbove1e3AngstromAt10000Angstrom) {
  const auto scene = test::randomSpheres(200, 5);
  View view = test::viewOf(*scene, {200, 150});
  view.pixelSize *= view.distance / 10000;
  view.distance = 10000;
  Renderer renderer;
  renderer.setPrimitives(scene);
  const HitImage image = renderer.renderHits(view, {}, {}, GetParam());
  int shown = 0;
  double worst = 0;
  for (int y = 0; y < 150; ++y) {
    for (int x = 0; x < 200; ++x) {
      const ExactHit truth = exactHit(*scene, view, {x + 0.5, y + 0.5});
      const auto i = static_cast<std::size_t>(y * 200 + x);
      if (truth.clearance < 1e-6 || truth.runnerUp - truth.distance < 1e-3) continue;
      ASSERT_EQ(image.id[i], truth.id) << x << ", " << y;
      if (truth.id == 0) continue;
      ++shown;
      worst = std::max(worst, std::abs(static_cast<double>(image.distance[i]) - truth.distance));
    }
  }
  EXPECT_GT(shown, 10000);
  EXPECT_LT(worst, 1e-3);
}

TEST_P(Quadrics, CameraInsideASphereSeesItsInside) {
  auto scene = std::make_shared<Primitives>();
  scene->spheres = {{{0, 0, 0}, 5, 0xFF0000, 1}, {{0, 0, -3}, 0.5f, 0x00FF00, 2}};
  Camera camera;
  camera.distance = 1;  // 1 Å from the centre
  camera.fovY = 1.2;
  const View view = makeView(camera, {64, 48}, scene->bounds());
  EXPECT_EQ(expectExact(scene, view), 64 * 48);
}

TEST_P(Quadrics, SpheresAndSticksAcrossTheNearPlaneAreCutOpen) {
  const auto scene = test::randomChain(60, 6);
  for (const double distance : {0.0, 0.7, 3.0}) {
    Camera camera;
    camera.target = scene->origin;
    camera.distance = distance + 1e-3;
    camera.fovY = 1.5;
    View view = makeView(camera, {120, 90}, scene->bounds());
    expectExact(scene, view);
    view.projection = Projection::orthographic;
    view.pixelSize = 0.05;
    view.nearZ = distance;
    expectExact(scene, view);
  }
}

TEST_P(Quadrics, ZeroLengthBondsAndZeroRadiiDrawNothing) {
  auto scene = std::make_shared<Primitives>();
  scene->spheres = {{{0, 0, 0}, 1, 0xFF0000, 1}, {{0.5f, 2, 0}, 0, 0xFF0000, 2}};
  scene->cylinders = {{{2, 0, 0}, 0.2f, {2, 0, 0}, 1, 1, 3, 3}, {{-2, 0, 0}, 0, {-2, 1, 0}, 1, 1, 4, 4}};
  Renderer renderer;
  renderer.setPrimitives(scene);
  const HitImage image = renderer.renderHits(test::viewOf(*scene, {90, 70}), {}, {}, GetParam());
  int shown = 0;
  for (const std::uint32_t id : image.id) {
    EXPECT_LE(id, 1u);
    shown += id == 1;
  }
  EXPECT_GT(shown, 100);
}

TEST_P(Quadrics, SingleAtomOnePixel) {
  auto scene = std::make_shared<Primitives>();
  scene->spheres = {{{0, 0, 0}, 1.7f, 0xFF0000, 1}};
  const View view = test::viewOf(*scene, {1, 1});
  EXPECT_EQ(expectExact(scene, view), 1);
}

TEST_P(Quadrics, EmptySceneIsAllBackground) {
  Renderer renderer;
  const HitImage image = renderer.renderHits(makeView(Camera{}, {7, 5}, {}),
                                             {.distance = true, .normal = true, .id = true}, {}, GetParam());
  ASSERT_EQ(image.id.size(), 35u);
  for (const std::uint32_t id : image.id) EXPECT_EQ(id, 0u);
  for (const float distance : image.distance) EXPECT_TRUE(std::isinf(distance));
}

TEST_P(Quadrics, MoleculeAMillionAngstromAwayFromTheOrigin) {
  auto scene = test::randomSpheres(100, 8);
  scene->origin = {1e6 + 0.123456789, -1e6, 1e6};
  EXPECT_GT(expectExact(scene, test::viewOf(*scene, {120, 90})), 2000);
}

TEST_P(Quadrics, NeedleSticksOfExtremeLength) {
  for (const float length : {1e-6f, 1e-3f, 1e4f}) {
    auto scene = std::make_shared<Primitives>();
    const float radius = length / 50;
    scene->cylinders = {{{0, 0, 0}, radius, {length, length / 3, length / 7}, 1, 2, 1, 2}};
    scene->spheres = {{{0, 0, 0}, 2 * radius, 1, 1}, {{length, length / 3, length / 7}, 2 * radius, 2, 2}};
    View view = test::viewOf(*scene, {160, 120});
    EXPECT_GT(expectExact(scene, view, static_cast<double>(length) * 1e-5), 100) << length;
  }
}

}  // namespace
}  // namespace meniscus

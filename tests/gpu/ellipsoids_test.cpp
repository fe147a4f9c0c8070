// Ellipsoids on the GPU: against brute force in extended precision, against spheres, in shadow maps, and what
// is left out where a scene has none.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "render/renderer.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/scenes.h"

namespace meniscus {
namespace {

using test::exactHit;
using test::ExactHit;

constexpr HitChannels kAll{.distance = true, .normal = true, .id = true};

class Ellipsoids : public test::GlTest, public testing::WithParamInterface<QuadricMethod> {
 protected:
  // As in quadrics_test.cpp: every pixel is right unless the ray grazes something or two things are met
  // within `tolerance` [Å] of each other. Returns how many pixels show something.
  int expectExact(const std::shared_ptr<Primitives>& primitives, const View& view, double tolerance = 1e-4,
                  double mostExcused = 0.02) {
    Renderer renderer;
    renderer.setPrimitives(primitives);
    const HitImage image = renderer.renderHits(view, kAll, {}, GetParam());
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
          continue;
        }
        const double half = std::nextafter(image.distance[i], INFINITY) - image.distance[i];
        EXPECT_NEAR(static_cast<double>(image.distance[i]), truth.distance, 2 * tolerance + half)
            << "pixel " << x << ", " << y;
        const Ray ray = rayThrough(view, {x + 0.5, y + 0.5});
        EXPECT_LE(glm::dot(glm::dvec3(image.normal[i]), ray.direction), 1e-4) << "away from the viewer";
        if (testing::Test::HasFailure()) return shown;
      }
    }
    EXPECT_LT(excused, view.size.width * view.size.height * mostExcused + 2) << "most pixels must be judged";
    return shown;
  }
  static std::vector<std::byte> draw(const std::shared_ptr<const Primitives>& primitives, const View& view,
                                     const RenderSettings& settings, RenderStats* stats = nullptr) {
    Renderer renderer;
    renderer.setPrimitives(primitives);
    test::MemorySink sink;
    renderer.renderPicture(view, Lighting{}, Background{}, settings, {PixelFormat::rgba8, {}}, sink);
    if (stats != nullptr) *stats = renderer.stats();
    return sink.bytes;
  }
};

INSTANTIATE_TEST_SUITE_P(By, Ellipsoids, testing::Values(QuadricMethod::splat, QuadricMethod::tiles),
                         [](const auto& each) {
                           return each.param == QuadricMethod::splat ? "splat" : "tiles";
                         });

TEST_P(Ellipsoids, ArePixelExactInPerspectiveAndOrthographicViews) {
  const auto scene = test::randomEllipsoids(200, 1, 0.2);
  for (const Projection projection : {Projection::perspective, Projection::orthographic})
    EXPECT_GT(expectExact(scene, test::viewOf(*scene, {160, 120}, projection)), 4000);
}

TEST_P(Ellipsoids, AmongSpheresAndSticks) {
  const auto scene = test::randomChain(60, 3);
  scene->ellipsoids = test::randomEllipsoids(60, 4, 0.1)->ellipsoids;
  for (EllipsoidPrimitive& e : scene->ellipsoids) e.id += 60;
  EXPECT_GT(expectExact(scene, test::viewOf(*scene, {200, 150})), 5000);
}

TEST_P(Ellipsoids, WideAndNarrowFieldsOfView) {
  const auto scene = test::randomEllipsoids(40, 5, 0.1);
  for (const double degrees : {0.01, 1.0, 120.0, 170.0}) {
    const View view =
        test::viewOf(*scene, {120, 90}, Projection::perspective, degrees * 0.017453292519943295);
    EXPECT_GT(expectExact(scene, view, degrees < 0.1 ? 1e-3 : 1e-4), 200) << degrees;
  }
}

TEST_P(Ellipsoids, AcrossTheNearPlaneAreCutOpen) {
  const auto scene = test::randomEllipsoids(60, 6, 0.2);
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

TEST_P(Ellipsoids, CameraInsideOneSeesItsInside) {
  auto scene = std::make_shared<Primitives>();
  scene->ellipsoids = {{{0, 0, 0}, 3, {0, 6, 0}, {0, 0, 5}, 0xFF0000, 1}};
  scene->spheres = {{{0, 0, -3}, 0.5f, 0x00FF00, 2}};
  Camera camera;
  camera.distance = 1;
  camera.fovY = 1.2;
  EXPECT_EQ(expectExact(scene, makeView(camera, {64, 48}, scene->bounds())), 64 * 48);
}

TEST_P(Ellipsoids, NeedlesAndDiscsOfEverySize) {
  for (const float longest : {1e-6f, 1e-2f, 1.0f, 1e4f}) {
    for (const float thin : {1e-4f, 1e-2f}) {
      auto scene = std::make_shared<Primitives>();
      const glm::vec3 a = longest * glm::normalize(glm::vec3(3, 1, 0.5f)),
                      b = longest * glm::normalize(glm::vec3(-1, 3, 0));
      scene->ellipsoids = {{{0, 0, 0}, thin * longest, a, thin * b, 1, 1},                       // needle
                           {{0, 0.6f * longest, 0}, thin * longest, 0.5f * a, 0.5f * b, 2, 2}};  // disc
      const View view = test::viewOf(*scene, {160, 120});
      EXPECT_GT(expectExact(scene, view, static_cast<double>(longest) * 5e-6, 0.05), 300)
          << longest << " " << thin;
    }
  }
}

TEST_P(Ellipsoids, KeepTheirShapeAt10000Angstrom) {
  const auto scene = test::randomEllipsoids(150, 7, 0.1);
  View view = test::viewOf(*scene, {200, 150});
  view.pixelSize *= view.distance / 10000;
  view.distance = 10000;
  EXPECT_GT(expectExact(scene, view), 5000);
}

TEST_P(Ellipsoids, OfEqualSemiAxesDrawTheSpheresPicture) {
  const auto balls = test::randomSpheres(200, 8);
  const auto ellipsoids = test::randomEllipsoids(200, 8, 1);
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    const View view = test::viewOf(*balls, {200, 150}, projection);
    const auto a = draw(balls, view, test::withSamples(1, GetParam())),
               b = draw(ellipsoids, view, test::withSamples(1, GetParam()));
    ASSERT_EQ(a.size(), b.size());
    std::size_t different = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (std::abs(std::to_integer<int>(a[i]) - std::to_integer<int>(b[i])) > 1) ++different;
    }
    EXPECT_LE(different, 8u) << "some rays that graze, at most";
  }
}

TEST_P(Ellipsoids, CastTheSpheresShadow) {
  const auto balls = test::randomSpheres(100, 9);
  const auto ellipsoids = test::randomEllipsoids(100, 9, 1);
  const View view = test::viewOf(*balls, {160, 120});
  RenderSettings settings = test::withSamples(1, GetParam()), none = settings;
  settings.shadows.mode = ShadowMode::hard;
  RenderStats stats;
  const auto a = draw(balls, view, settings), b = draw(ellipsoids, view, settings, &stats);
  EXPECT_NE(b, draw(ellipsoids, view, none)) << "there are shadows";
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    different += std::abs(std::to_integer<int>(a[i]) - std::to_integer<int>(b[i])) > 1;
  EXPECT_LE(different, a.size() / 500);
  EXPECT_EQ(stats.passes.front().name,
            GetParam() == QuadricMethod::splat ? "shadow map: ellipsoids" : "shadow map: tiles");
}

TEST_P(Ellipsoids, OccludeAsSpheresDo) {
  const auto balls = test::randomSpheres(60, 12);
  const auto ellipsoids = test::randomEllipsoids(60, 12, 1);
  const View view = test::viewOf(*balls, {80, 60});
  RenderSettings settings = test::withSamples(1, GetParam()), none = settings;
  settings.occlusion.on = true;
  const auto a = draw(balls, view, settings), b = draw(ellipsoids, view, settings);
  EXPECT_NE(b, draw(ellipsoids, view, none)) << "there is occlusion";
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    different += std::abs(std::to_integer<int>(a[i]) - std::to_integer<int>(b[i])) > 2;
  EXPECT_LE(different, a.size() / 200);
}

TEST_P(Ellipsoids, CostNothingWhereThereAreNone) {
  const auto balls = test::randomSpheres(20, 10);
  RenderStats stats;
  draw(balls, test::viewOf(*balls, {40, 30}), test::withSamples(1, GetParam()), &stats);
  for (const PassStats& pass : stats.passes) EXPECT_EQ(pass.name.find("ellipsoid"), std::string::npos);
  for (const std::string& program : stats.programs) EXPECT_EQ(program.find("ellipsoid"), std::string::npos);
  for (const ResourceStats& buffer : stats.buffers) EXPECT_NE(buffer.name, "ellipsoids");
  EXPECT_TRUE(std::any_of(stats.omissions.begin(), stats.omissions.end(),
                          [](const OmissionStats& o) { return o.what == "pass ellipsoids"; }));

  const auto ellipsoids = test::randomEllipsoids(20, 10, 0.5);
  draw(ellipsoids, test::viewOf(*ellipsoids, {40, 30}), test::withSamples(1, GetParam()), &stats);
  ASSERT_EQ(stats.passes.size(), 2u);
  if (GetParam() == QuadricMethod::tiles) {
    EXPECT_EQ(stats.passes[0].name, "tiles");
    for (const std::string& program : stats.programs)
      EXPECT_EQ(program.find("quadrics/"), std::string::npos) << program;
    EXPECT_TRUE(stats.buffers.empty());
    return;
  }
  EXPECT_EQ(stats.passes[0].name, "ellipsoids");
  EXPECT_EQ(stats.programs[0], "quadrics/ellipsoid ALBEDO NORMAL");
  ASSERT_EQ(stats.buffers.size(), 1u);
  EXPECT_EQ(stats.buffers[0].bytes, 20 * sizeof(EllipsoidPrimitive));
}

TEST_P(Ellipsoids, WithoutThicknessOrTinyOrHugeAreNoTrouble) {
  auto scene = std::make_shared<Primitives>();
  scene->ellipsoids = {{{0, 0, 0}, 1, {2, 0, 0}, {0, 1.5f, 0}, 1, 1},
                       {{0, 2, 0}, 0, {1, 0, 0}, {0, 1, 0}, 1, 2},  // a disc without thickness
                       {{0, 2, 0}, 0, {0, 0, 0}, {0, 0, 0}, 1, 3},  // a point
                       {{0, -2, 0}, 1e-20f, {1e-20f, 0, 0}, {0, 1e-20f, 0}, 1, 4},
                       {{3, 0, 0}, 1e-18f, {1, 0, 0}, {0, 1e-9f, 0}, 1, 5}};
  Renderer renderer;
  renderer.setPrimitives(scene);
  const HitImage image = renderer.renderHits(test::viewOf(*scene, {90, 70}), kAll, {}, GetParam());
  int shown = 0;
  for (std::size_t i = 0; i < image.id.size(); ++i) {
    EXPECT_NE(image.id[i], 2u);
    EXPECT_NE(image.id[i], 3u);
    EXPECT_FALSE(std::isnan(image.distance[i]));
    EXPECT_FALSE(std::isnan(image.normal[i].x));
    shown += image.id[i] == 1;
  }
  EXPECT_GT(shown, 100);
}

TEST_P(Ellipsoids, OneOnOnePixel) {
  auto scene = std::make_shared<Primitives>();
  scene->ellipsoids = {{{0, 0, 0}, 0.2f, {1, 0, 0}, {0, 0.5f, 0}, 0xFF0000, 1}};
  EXPECT_EQ(expectExact(scene, test::viewOf(*scene, {1, 1})), 1);
}

TEST_P(Ellipsoids, InTilesGiveTheSameBytes) {
  const auto scene = test::randomEllipsoids(80, 11, 0.2);
  Renderer whole, tiled(RendererOptions{.shaderDir = {}, .timePasses = false, .maxTileSize = 37});
  whole.setPrimitives(scene);
  tiled.setPrimitives(scene);
  const View view = test::viewOf(*scene, {200, 150});
  const HitImage a = whole.renderHits(view, kAll, {}, GetParam()),
                 b = tiled.renderHits(view, kAll, {}, GetParam());
  EXPECT_EQ(a.distance, b.distance);
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.id, b.id);
}

}  // namespace
}  // namespace meniscus

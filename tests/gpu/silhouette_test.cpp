// Lines on surfaces whose steps, creases and groups are known.

#include "render/post/silhouette.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "tests/support/gl_fixture.h"
#include "tests/support/synthetic_gbuffer.h"

namespace meniscus {
namespace {

using test::SurfaceFunction;
using test::SurfaceSample;

constexpr ImageSize kSize{64, 40};

class Silhouette : public test::GlTest {
 protected:
  // Share of each pixel that is line; rows from the bottom.
  static std::vector<double> lines(const View& view, const SurfaceFunction& surface,
                                   const SilhouetteSettings& settings,
                                   const std::vector<std::uint32_t>& groups = {}) {
    const test::SyntheticGBuffer gbuffer(view, surface);
    TexturePool pool;
    ShaderLibrary shaders{{}};
    SilhouetteUniforms uniforms;
    uniforms.set(settings, view);
    uniforms.setGroups(groups);
    FrameGraph graph(pool);
    return test::run(graph, addSilhouette(graph, settings, uniforms, shaders, gbuffer.import(graph),
                                          view.size.width, view.size.height));
  }
  static double total(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum;
  }
  // Checks that every row is the same and returns it.
  static std::vector<double> row(const std::vector<double>& values, int width) {
    const auto w = static_cast<std::size_t>(width);
    for (std::size_t i = w; i < values.size(); ++i) EXPECT_EQ(values[i], values[i - w]) << i;
    return {values.begin(), values.begin() + width};
  }
};

SilhouetteSettings silhouettes(double width = 1) {
  SilhouetteSettings s;
  s.silhouettes = true;
  s.width = width;
  return s;
}
SilhouetteSettings creases(double width = 2) {
  SilhouetteSettings s;
  s.creases = true;
  s.width = width;
  return s;
}

// Left of the middle at height 0, right of it lower by `height`.
SurfaceFunction stepOf(double height) {
  return [=](const Ray& ray) { return SurfaceSample{ray.origin.x < 0 ? 0.0 : -height, {0, 0, 1}, 1}; };
}

// Two planes that meet in the middle, each inclined by half of `angleDeg`; a groove, or a ridge.
SurfaceFunction fold(double angleDeg, bool ridge) {
  const double slope = std::tan(glm::radians(angleDeg) / 2) * (ridge ? -1 : 1);
  return [=](const Ray& ray) {
    const double x = ray.origin.x, side = x < 0 ? -slope : slope;
    return SurfaceSample{side * x, glm::normalize(glm::dvec3(-side, 0, 1)), 1};
  };
}

TEST_F(Silhouette, APlaneRaisesNoLineHoweverGrazing) {
  SilhouetteSettings all = silhouettes(3);
  all.creases = true;
  all.gap = 0;
  for (const double angleDeg : {0.0, 45.0, 80.0, 89.0, 89.9}) {
    for (const double turnDeg : {0.0, 30.0, 90.0, 217.0}) {
      const double a = glm::radians(angleDeg), t = glm::radians(turnDeg);
      const glm::dvec3 normal(std::sin(a) * std::cos(t), std::sin(a) * std::sin(t), std::cos(a));
      const View straight = test::orthographicView(kSize, 0.1, 3000, -3000);
      EXPECT_EQ(total(lines(straight, test::planeThrough({0, 0, 0}, normal), all)), 0)
          << angleDeg << " " << turnDeg;
    }
  }
  // Ground up to the horizon's neighbourhood, seen in perspective.
  const View eye = test::perspectiveView(kSize, 0.005, 100, 90, -10000);
  const auto ground = test::planeThrough({0, -12, 0}, {0, 1, 0});
  const auto nearGround = [&](const Ray& ray) -> std::optional<SurfaceSample> {
    return ray.direction.y < -0.005 ? ground(ray) : SurfaceSample{-9000, {0, 0, 1}, 1};
  };
  const std::vector<double> picture = lines(eye, nearGround, all);
  for (int y = 0; y < kSize.height / 2 - 8; ++y) {
    for (int x = 0; x < kSize.width; ++x)
      ASSERT_EQ(picture[static_cast<std::size_t>(y * kSize.width + x)], 0) << x << " " << y;
  }
}

TEST_F(Silhouette, AStepRaisesOneLineOfTheAskedWidthOnTheSideInFront) {
  const View view = test::orthographicView(kSize, 0.1);
  const int middle = kSize.width / 2;
  for (const double width : {0.5, 1.0, 1.5, 2.0, 3.0, 7.25, 16.0}) {
    const std::vector<double> line = row(lines(view, stepOf(5), silhouettes(width)), kSize.width);
    double sum = 0;
    for (int x = 0; x < kSize.width; ++x) {
      const double expected = x < middle ? std::clamp(width - (middle - 1 - x), 0.0, 1.0) : 0.0;
      EXPECT_NEAR(line[static_cast<std::size_t>(x)], expected, 2e-5) << width << " at " << x;
      sum += line[static_cast<std::size_t>(x)];
    }
    EXPECT_NEAR(sum, width, 1e-4);
  }
}

TEST_F(Silhouette, TheGapDecidesWhichStepsCount) {
  const View view = test::orthographicView(kSize, 0.1);
  SilhouetteSettings settings = silhouettes();
  EXPECT_EQ(total(lines(view, stepOf(0.99), settings)), 0) << "1 Å unless set";
  EXPECT_EQ(total(lines(view, stepOf(1.01), settings)), kSize.height);
  settings.gap = 0;
  EXPECT_EQ(total(lines(view, stepOf(0.19), settings)), 0) << "two pixels at least";
  EXPECT_EQ(total(lines(view, stepOf(0.21), settings)), kSize.height);
  EXPECT_EQ(total(lines(view, stepOf(5), creases())), 0) << "a step is no crease";
}

TEST_F(Silhouette, FoldsRaiseACreaseFromTheAskedAngleOn) {
  const View view = test::orthographicView(kSize, 0.1);
  SilhouetteSettings settings = creases();
  for (const bool ridge : {false, true}) {
    for (const double least : {20.0, 30.0, 90.0}) {
      settings.creaseAngleDeg = least;
      EXPECT_EQ(total(lines(view, fold(least - 0.5, ridge), settings)), 0) << least;
      const std::vector<double> line = row(lines(view, fold(least + 0.5, ridge), settings), kSize.width);
      for (int x = 0; x < kSize.width; ++x) {
        const bool beside = x == kSize.width / 2 - 1 || x == kSize.width / 2;
        EXPECT_EQ(line[static_cast<std::size_t>(x)], beside ? 1 : 0) << least << " at " << x;
      }
      EXPECT_EQ(total(lines(view, fold(least + 0.5, ridge), silhouettes())), 0) << "a fold is no step";
    }
  }
}

TEST_F(Silhouette, ASphereHasARingOfTheAskedWidthAndNothingElse) {
  constexpr int kSide = 128;
  const View view = test::orthographicView({kSide, kSide}, 0.1);
  for (const double width : {1.0, 2.5, 6.0}) {
    SilhouetteSettings settings = silhouettes(width);
    settings.creases = true;
    const double radius = 50;
    const std::vector<double> ring = lines(view, test::sphereAt({0.013, -0.02, 0}, 0.1 * radius), settings);
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const double r = std::hypot(x + 0.5 - kSide / 2 - 0.13, y + 0.5 - kSide / 2 + 0.2);
        const double line = ring[static_cast<std::size_t>(y * kSide + x)];
        if (r > radius || r < radius - width - 1.5) {
          ASSERT_EQ(line, 0) << r;
        }
        if (r < radius && r > radius - width + 1) {
          ASSERT_EQ(line, 1) << r;
        }
      }
    }
    EXPECT_NEAR(total(ring) / (M_PI * width * (2 * radius - width)), 1, 0.05) << width;
  }
}

// A sphere's own surface is no step and no crease, whatever its size in pixels.
TEST_F(Silhouette, SpheresOfAnySizeHaveNoCreaseAndNoStep) {
  SilhouetteSettings settings = silhouettes();
  settings.creases = true;
  settings.gap = 0;
  for (const double radius : {3.0, 4.7, 8.0, 19.3, 70.0, 1e3}) {
    const View view = test::orthographicView(kSize, 0.1, 200, -200);
    const double r = 0.1 * radius;
    // Off centre, so that the limb passes through the picture.
    const double shift = radius > 15 ? r - 1.0 : 0.021;
    settings.silhouettes = false;
    EXPECT_EQ(total(lines(view, test::sphereAt({shift, 0.033, 0}, r), settings)), 0) << radius;
    settings.silhouettes = true;
    const std::vector<double> ring = lines(view, test::sphereAt({shift, 0.033, 0}, r), settings);
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        const double px = x + 0.5 - kSize.width / 2.0 - 10 * shift, py = y + 0.5 - kSize.height / 2.0 - 0.33;
        if (std::hypot(px, py) < radius - 1.6) {
          ASSERT_EQ(ring[static_cast<std::size_t>(y * kSize.width + x)], 0) << radius;
        }
      }
    }
  }
}

TEST_F(Silhouette, LinesBetweenGroupsLieHalfOnEach) {
  const View view = test::orthographicView(kSize, 0.1);
  const auto halves = [](const Ray& ray) { return SurfaceSample{0, {0, 0, 1}, ray.origin.x < 0 ? 1u : 2u}; };
  SilhouetteSettings settings;
  settings.width = 2;
  settings.groups = LineGroups::atoms;
  EXPECT_EQ(total(lines(view, halves, settings)), 2 * kSize.height);
  settings.groups = LineGroups::chains;
  EXPECT_EQ(total(lines(view, halves, settings, {0, 7, 8})), 2 * kSize.height);
  EXPECT_EQ(total(lines(view, halves, settings, {0, 7, 7})), 0);
  // Where one stands in front, all of it lies there.
  const auto stepped = [&](const Ray& ray) {
    SurfaceSample s = halves(ray);
    s.z = ray.origin.x < 0 ? 0 : 5;
    return s;
  };
  const std::vector<double> line = row(lines(view, stepped, settings, {0, 7, 8}), kSize.width);
  for (int x = 0; x < kSize.width; ++x) {
    const int middle = kSize.width / 2;
    EXPECT_EQ(line[static_cast<std::size_t>(x)], x == middle || x == middle + 1 ? 1 : 0) << x;
  }
  EXPECT_EQ(total(lines(view, stepped, settings, {0, 7, 7})), 0) << "a step within a chain is not asked for";
}

TEST_F(Silhouette, OutlinesAgainstTheBackgroundStayOnTheObject) {
  const View view = test::orthographicView(kSize, 0.1);
  const auto half = [](const Ray& ray) -> std::optional<SurfaceSample> {
    if (ray.origin.x < 0) return SurfaceSample{};
    return std::nullopt;
  };
  SilhouetteSettings settings = silhouettes(3);
  settings.gap = 1e5;
  EXPECT_EQ(total(lines(view, half, settings)), 3 * kSize.height) << "the background is behind any gap";
  settings.silhouettes = false;
  settings.groups = LineGroups::chains;
  EXPECT_EQ(total(lines(view, half, settings, {0, 4})), 3 * kSize.height);
  EXPECT_EQ(total(lines(view, half, creases(3))), 0);
}

TEST_F(Silhouette, ExtremesStayFinite) {
  SilhouetteSettings all = silhouettes(16);
  all.creases = true;
  all.groups = LineGroups::atoms;
  const auto nothing = [](const Ray&) { return std::optional<SurfaceSample>(); };
  const View pixel = test::orthographicView({1, 1}, 0.1);
  EXPECT_EQ(total(lines(pixel, nothing, all)), 0);
  EXPECT_EQ(total(lines(pixel, stepOf(1), all)), 0) << "nothing beside it";
  for (const double scale : {1e-3, 1.0, 1e5}) {
    const View view = test::orthographicView(kSize, 0.05 * scale, 2 * scale, -2 * scale);
    for (const double value : lines(view, test::sphereAt({0, 0, 0}, scale), all)) {
      ASSERT_TRUE(value >= 0 && value <= 1);
    }
  }
}

}  // namespace
}  // namespace meniscus

// Depth unsharp masking against the Gaussian's own integrals.

#include "render/post/depth_unsharp.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/gl_fixture.h"
#include "tests/support/synthetic_gbuffer.h"

namespace meniscus {
namespace {

using test::SurfaceFunction;
using test::SurfaceSample;

class DepthUnsharp : public test::GlTest {
 protected:
  static std::vector<double> differences(const View& view, const SurfaceFunction& surface, double sigma) {
    const test::SyntheticGBuffer gbuffer(view, surface);
    const Tile whole{0, 0, view.size.width, view.size.height};
    TexturePool pool;
    ShaderLibrary shaders{{}};
    DepthUnsharpUniforms uniforms;
    uniforms.set(unsharpKernel(sigma), whole);
    FrameGraph graph(pool);
    return test::run(
        graph, addDepthUnsharp(graph, unsharpKernel(sigma), uniforms, shaders, gbuffer.import(graph), whole));
  }
};

// Integral of the unit Gaussian beyond x >= 0.
double beyond(double x) {
  return 0.5 * std::erfc(x / std::sqrt(2.0));
}

TEST_F(DepthUnsharp, AStepBecomesTheConvolvedStep) {
  const ImageSize size{300, 24};
  for (const Projection projection : {Projection::orthographic, Projection::perspective}) {
    View view = test::orthographicView(size, 0.1, 40, -60);
    if (projection == Projection::perspective) view = test::perspectiveView(size, 0.001, 100, 40, -60);
    const double height = 30, share = height / 100;
    for (const double sigma : {1.0, 2.9, 5.9, 12.5, 33.0}) {
      for (const double at : {150.0, 157.0}) {  // two places of the step on the grid of blocks
        const double edge = (at - size.width / 2) * view.pixelSize;
        const auto step = [&](const Ray& ray) {
          const double x =
              projection == Projection::perspective ? -ray.direction.x / ray.direction.z : ray.origin.x;
          return SurfaceSample{x < edge ? 10 : 10 - height, {0, 0, 1}, 1};
        };
        const std::vector<double> values = differences(view, step, sigma);
        for (int x = 0; x < size.width; ++x) {
          const double away = x + 0.5 - at;
          if (std::abs(away) > 2 * sigma + 5) continue;
          const double exact = (away < 0 ? 1 : -1) * share * beyond(std::abs(away) / sigma);
          ASSERT_NEAR(values[static_cast<std::size_t>(12 * size.width + x)], exact, 0.012 * share)
              << sigma << " at " << away;
        }
      }
    }
  }
}

TEST_F(DepthUnsharp, TheBackgroundLeavesNoRim) {
  const View view = test::orthographicView({80, 60}, 0.1);
  const auto disc = [](const Ray& ray) -> std::optional<SurfaceSample> {
    if (std::hypot(ray.origin.x, ray.origin.y) < 2) return SurfaceSample{12, {0, 0, 1}, 1};
    return std::nullopt;
  };
  for (const double sigma : {1.5, 4.0, 25.0}) {
    for (const double value : differences(view, disc, sigma)) ASSERT_NEAR(value, 0, 1e-6) << sigma;
  }
}

TEST_F(DepthUnsharp, APlaneIsItsOwnMean) {
  const ImageSize size{200, 120};
  const View view = test::orthographicView(size, 0.1);
  const std::vector<double> values = differences(view, test::planeThrough({0, 0, 0}, {0.5, -0.3, 1}), 6.4);
  for (int y = 25; y < size.height - 25; ++y) {
    for (int x = 25; x < size.width - 25; ++x)
      ASSERT_NEAR(values[static_cast<std::size_t>(y * size.width + x)], 0, 1e-5);
  }
}

TEST_F(DepthUnsharp, EmptyAndTinyPicturesAreZero) {
  const auto nothing = [](const Ray&) { return std::optional<SurfaceSample>(); };
  const auto flat = [](const Ray&) { return SurfaceSample{}; };
  for (const double sigma : {0.0, 0.3, 2.0, kMaxUnsharpSigma}) {
    EXPECT_EQ(differences(test::orthographicView({7, 5}, 0.1), nothing, sigma), std::vector<double>(35, 0.0));
    EXPECT_NEAR(differences(test::orthographicView({1, 1}, 0.1), flat, sigma).at(0), 0, 1e-6);
  }
}

TEST(UnsharpKernel, KeepsTheVarianceAndFewTaps) {
  for (double sigma = 0.01; sigma <= kMaxUnsharpSigma; sigma *= 1.1) {
    const UnsharpKernel kernel = unsharpKernel(sigma);
    EXPECT_LE(kernel.taps, 20);
    const double blocks = kernel.sigma * kernel.block;
    EXPECT_NEAR(blocks * blocks + 0.25 * (kernel.block * kernel.block - 1), sigma * sigma,
                1e-9 + 1e-9 * sigma);
    EXPECT_GE((kernel.taps - 1) * kernel.block, 2.9 * sigma * (kernel.block > 1 ? 0.98 : 1)) << sigma;
  }
}

TEST(UnsharpSigma, IsAShareOfTheSmallerSideOrAngstrom) {
  DepthUnsharpSettings settings;
  settings.radius = 0.03;
  EXPECT_DOUBLE_EQ(unsharpSigma(settings, test::orthographicView({900, 500}, 0.1)), 15);
  EXPECT_DOUBLE_EQ(unsharpSigma(settings, test::orthographicView({500, 900}, 7)), 15);
  settings.radius = 2.5;
  settings.radiusInAngstrom = true;
  EXPECT_DOUBLE_EQ(unsharpSigma(settings, test::orthographicView({900, 500}, 0.1)), 25);
  // At the middle of the scene, 110 Å away.
  EXPECT_DOUBLE_EQ(unsharpSigma(settings, test::perspectiveView({900, 500}, 0.001, 100, 20, -40)),
                   2.5 / 0.11);
  settings.radius = 1e9;
  EXPECT_EQ(unsharpSigma(settings, test::orthographicView({900, 500}, 0.1)), kMaxUnsharpSigma);
}

}  // namespace
}  // namespace meniscus

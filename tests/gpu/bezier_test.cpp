// The surface as depth-peeled Bezier clipping draws it, against the truth: molecules, random scenes, scenes
// that break the paper's list.

#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"
#include "tests/gpu/surface_judge.h"
#include "tests/support/exact_field.h"

namespace meniscus {
namespace {

using test::options;
using Parameters = std::map<std::string, double>;

class Bezier : public test::SurfaceTest {};

const Kernel kSextic{};
constexpr Projection kBoth[] = {Projection::perspective, Projection::orthographic};

// 1,000 balls of random radii (Kanamori et al. 2008, Figure 1).
TEST_F(Bezier, RandomBallsOfThePaper) {
  const test::SurfaceScene scene = test::randomScene(1000, 1);
  for (const Projection projection : kBoth)
    expectExact(judge(scene, viewOf(scene, {160, 120}, projection), options()));
}

TEST_F(Bezier, EveryMolecule) {
  const auto files = test::moleculeFiles();
  EXPECT_GE(files.size(), 15u);
  for (const auto& file : files) {
    const std::string name = file.filename().string();
    SCOPED_TRACE(name);
    const test::SurfaceScene scene = test::moleculeScene(file);
    expectExact(judge(scene, viewOf(scene, {96, 72}), options(), name));
  }
}

TEST_F(Bezier, EveryKernel) {
  for (const Kernel kernel :
       {Kernel{KernelShape::sextic}, Kernel{KernelShape::quartic}, Kernel{KernelShape::power, 2},
        Kernel{KernelShape::power, 3}, Kernel{KernelShape::power, 7}, Kernel{KernelShape::power, 16}}) {
    const std::string name =
        "kernel" + std::to_string(static_cast<int>(kernel.shape)) + "_" + std::to_string(kernel.exponent);
    SCOPED_TRACE(name);
    const test::SurfaceScene scene(test::randomField(kernel, 0.3, 60, 4, 0, 7));
    expectExact(judge(scene, viewOf(scene, {80, 60}), options(), name));
  }
}

TEST_F(Bezier, EveryOptionGivesTheSameSurface) {
  const test::SurfaceScene scene = test::randomScene(150, 3);
  const View view = viewOf(scene, {80, 60});
  for (const Parameters& parameters :
       {Parameters{{"culling", 0}}, Parameters{{"tiles", 0}}, Parameters{{"tiles", 17}},
        Parameters{{"clipping", 0}}, Parameters{{"list", 1}}, Parameters{{"list", 3}, {"tiles", 0}},
        Parameters{{"tolerance", 1e-3}}}) {
    SCOPED_TRACE(parameters.begin()->first);
    expectExact(judge(scene, view, options(parameters)));
  }
}

TEST_F(Bezier, PixelsWithShortListsGoOnWithoutAndAreCounted) {
  const test::SurfaceScene scene = test::randomScene(150, 3);
  const View view = viewOf(scene, {80, 60});
  judge(scene, view, options({{"list", 4}}));
  EXPECT_GT(stats.overflow, 100u);
  EXPECT_EQ(detail("pixels without lists"), static_cast<double>(stats.overflow));
  const std::uint64_t pixels = stats.pixels;
  judge(scene, view, options());
  EXPECT_EQ(stats.overflow, 0u);
  EXPECT_EQ(stats.pixels, pixels) << "a pixel counts once, however often it is done";
  // The paper's way (§7) takes the ball that does not fit for the surface: too near, never a hole.
  const HitErrors paper = judge(scene, view, options({{"list", 4}, {"repair", 0}}));
  EXPECT_GT(paper.largestDistance, 0.1);
  EXPECT_EQ(paper.missed, 0u);
  EXPECT_GT(stats.overflow, 100u);
  EXPECT_EQ(detail("pixels without lists"), 0);
}

TEST_F(Bezier, TwoHundredCoincidentBalls) {
  const test::SurfaceScene scene = test::coincidentBalls();
  for (const Projection projection : kBoth) {
    expectExact(judge(scene, viewOf(scene, {24, 18}, projection), options()));
    EXPECT_GT(stats.overflow, 50u);
    EXPECT_EQ(detail("longest list"), 200);
    EXPECT_LE(detail("looks at their balls"), 4.0 * static_cast<double>(stats.overflow));
  }
}

// Whatever the kernel and the signs, with hardly a list at all.
TEST_F(Bezier, PixelsWithoutListsAreExact) {
  for (const Kernel kernel : {kSextic, Kernel{KernelShape::quartic}, Kernel{KernelShape::power, 3},
                              Kernel{KernelShape::power, 16}}) {
    for (const double level : {0.3, 1e-6}) {
      SCOPED_TRACE(fmt::format("kernel {} {}", static_cast<int>(kernel.shape), level));
      const test::SurfaceScene scene(test::randomField(kernel, level, 80, 4, 3, 11));
      for (const Projection projection : kBoth)
        expectExact(judge(scene, viewOf(scene, {48, 36}, projection), options({{"list", 1}})));
      EXPECT_GT(detail("pixels without lists"), 200);
    }
  }
}

// Their events lie close together, but in as many places as there are balls: where there is no surface among
// them, they are not looked at one by one.
TEST_F(Bezier, AThousandNearlyCoincidentBalls) {
  struct Case {
    double apart, sum;
    double looks;  // at all balls, per pixel
  };
  for (const Case& c : {Case{0, 1000, 4}, Case{1e-4, 1000, 8}, Case{1e-4, 2, 8}, Case{0.1, 1000, 60}}) {
    SCOPED_TRACE(fmt::format("apart {} sum {}", c.apart, c.sum));
    const test::SurfaceScene scene = test::nearlyCoincidentBalls(1000, c.apart, c.sum);
    expectExact(judge(scene, viewOf(scene, {24, 18}), options()));
    EXPECT_EQ(detail("balls left after culling"), 1000);
    EXPECT_LE(detail("layers"), 64);
    EXPECT_GT(detail("pixels without lists"), 200);
    EXPECT_LE(detail("looks at their balls"), c.looks * detail("pixels without lists"));
    EXPECT_LE(static_cast<double>(stats.pieces), (c.looks + 14) * static_cast<double>(stats.pixels));
  }
}

// Twenty balls in one place, and before them, to one side, far more small ones than a pixel passes at once.
TEST_F(Bezier, TwentyThousandBallsAreLeftBehind) {
  test::SurfaceScene scene = test::nearlyCoincidentBalls(20, 0, 2);
  std::vector<Metaball>& balls = scene.primitives->surfaces[0].balls;
  for (unsigned i = 0; i < 20000; ++i)
    balls.push_back({{1.5f, 1, 10 - 2.5e-4f * static_cast<float>(i)}, 0.05f, 1e-4f, 0x808080, i + 21});
  View view = test::alongZ(0, 0, 20);
  view.size = {12, 9};
  view.pixelSize = 0.4;
  view.center = {6, 4.5};
  expectExact(judge(scene, view, options({{"culling", 0}})));
  EXPECT_GE(detail("draws without lists"), 3);
}

// Software drivers end loops: what they have left out is never taken for a picture.
TEST_F(Bezier, MoreBallsThanLoopsAllowAreExactOrRefused) {
  test::SurfaceScene scene = test::nearlyCoincidentBalls(300, 0, 2);
  scene.primitives->surfaces[0].kernel = {KernelShape::power, 16};
  for (const double list : {14, 300}) {
    try {
      expectExact(judge(scene, viewOf(scene, {24, 18}), options({{"list", list}})));
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find("surface method bezier: more balls overlap in"), 0u);
    }
  }
}

TEST_F(Bezier, AThousandBallsAlongOneRay) {
  const auto [scene, view] = test::ballsAlongOneRay();
  expectExact(judge(scene, view, options()));
  // A hundred pixels; what is behind so many layers is not peeled.
  EXPECT_EQ(detail("layers"), 64);
  EXPECT_GT(detail("pixels without lists"), 50);
  EXPECT_LT(detail("looks at their balls"), 100 * detail("pixels without lists"));
}

TEST_F(Bezier, ALatticeSeenAlongAnAxis) {
  const auto [scene, view] = test::latticeAlongAxis();
  expectExact(judge(scene, view, options()));
  expectExact(judge(scene, view, options({{"culling", 0}})));
  expectExact(judge(scene, latticeInPerspective(scene), options()));
}

TEST_F(Bezier, NegativeBallsHollowTheSurface) {
  for (const Kernel kernel : {kSextic, Kernel{KernelShape::quartic}}) {
    const test::SurfaceScene scene(test::randomField(kernel, 0.3, 80, 4, 3, 11));
    for (const Projection projection : kBoth)
      expectExact(judge(scene, viewOf(scene, {80, 60}, projection), options()));
    EXPECT_EQ(detail("balls left after culling"), detail("balls in view")) << "cores hide nothing";
  }
  const auto [scene, view] = test::insideOfCavity();
  const HitErrors errors = judge(scene, view, options());
  expectExact(errors);
  EXPECT_EQ(errors.compared + errors.grazing, 64u * 48u);
}

TEST_F(Bezier, CameraInsideBallsAndInsideTheSurface) {
  const test::SurfaceScene scene = test::randomScene(200, 5);
  const std::vector<View> views = viewsFromInside(scene);
  for (std::size_t i = 0; i < views.size(); ++i) {
    SCOPED_TRACE(i);
    expectExact(judge(scene, views[i], options(), "inside" + std::to_string(i)));
  }
}

TEST_F(Bezier, SpheresAndSurfacesHideEachOther) {
  expectSpheresAndSurfacesHideEachOther(options());
  // What lies behind quadrics need not be drawn.
  EXPECT_LT(detail("balls left after culling"), detail("balls in view"));
}

TEST_F(Bezier, AnyTilesOfTheTargetGiveTheSameBytes) {
  expectAnyTilesGiveTheSameBytes(options());
}

TEST_F(Bezier, RefusesNumbersThatAreNotFinite) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    test::SurfaceScene scene = test::randomScene(10, 1);
    const View view = viewOf(scene, {16, 12});
    scene.primitives->surfaces[0].balls[3].center.y = bad;
    EXPECT_THROW(draw(scene, view, options()), InputError);
    scene = test::randomScene(10, 1);
    scene.primitives->surfaces[0].balls[3].support = bad;
    EXPECT_THROW(draw(scene, view, options()), InputError);
  }
}

TEST_F(Bezier, UnknownOptionsAreNamed) {
  const test::SurfaceScene scene = test::randomScene(10, 1);
  EXPECT_THROW(draw(scene, viewOf(scene, {16, 12}), options({{"lists", 3}})), UsageError);
  EXPECT_THROW(draw(scene, viewOf(scene, {16, 12}), options({{"list", 0}})), UsageError);
  EXPECT_THROW(draw(scene, viewOf(scene, {16, 12}), options({{"repair", 0.5}})), UsageError);
}

}  // namespace
}  // namespace meniscus

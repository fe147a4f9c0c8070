// The surface as fragment lists draw it, against the truth: molecules, random scenes, scenes that break
// lists.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "tests/gpu/surface_judge.h"
#include "tests/support/exact_field.h"

namespace meniscus {
namespace {

constexpr Projection kBoth[] = {Projection::perspective, Projection::orthographic};

SurfaceSettings lists(std::map<std::string, double> parameters = {}) {
  return {"lists", std::move(parameters)};
}

class Lists : public test::SurfaceTest {};

TEST_F(Lists, RandomBalls) {
  const test::SurfaceScene scene = test::randomScene(1000, 1);
  for (const Projection projection : kBoth)
    expectExact(judge(scene, viewOf(scene, {120, 90}, projection), lists()));
  EXPECT_EQ(stats.notConverged, 0u);
  EXPECT_EQ(stats.overflow, 0u);
  // The running polynomial settles most pieces.
  EXPECT_LT(detail("pieces looked at for roots"), 0.5 * static_cast<double>(stats.pieces));
}

TEST_F(Lists, EveryMolecule) {
  const auto files = test::moleculeFiles();
  EXPECT_GE(files.size(), 15u);
  for (const auto& file : files) {
    const std::string name = file.filename().string();
    SCOPED_TRACE(name);
    const test::SurfaceScene scene = test::moleculeScene(file);
    expectExact(judge(scene, viewOf(scene, {96, 72}), lists(), name));
  }
}

TEST_F(Lists, EveryKernel) {
  for (const Kernel kernel :
       {Kernel{KernelShape::sextic}, Kernel{KernelShape::quartic}, Kernel{KernelShape::power, 2},
        Kernel{KernelShape::power, 7}, Kernel{KernelShape::power, 16}}) {
    const std::string name =
        "kernel" + std::to_string(static_cast<int>(kernel.shape)) + "_" + std::to_string(kernel.exponent);
    SCOPED_TRACE(name);
    const test::SurfaceScene scene(test::randomField(kernel, 0.3, 60, 4, 0, 7));
    const View view = viewOf(scene, {80, 60});
    expectExact(judge(scene, view, lists(), name));
    expectExact(judge(scene, view, lists({{"array", 3}}), name + "walked"));
  }
}

TEST_F(Lists, EveryOptionGivesTheSameSurface) {
  const test::SurfaceScene scene = test::randomScene(150, 3);
  const View view = viewOf(scene, {80, 60});
  for (const std::map<std::string, double>& parameters : {std::map<std::string, double>{{"culling", 0}},
                                                          {{"order", 0}},
                                                          {{"array", 3}},
                                                          {{"array", 20}},
                                                          {{"tolerance", 1e-3}}}) {
    SCOPED_TRACE(parameters.begin()->first);
    expectExact(judge(scene, view, lists(parameters)));
  }
}

// Walking the list finds what the array finds, whatever the array could not hold.
TEST_F(Lists, ShortArraysAreRepairedAndCounted) {
  const test::SurfaceScene scene = test::randomScene(150, 3);
  const View view = viewOf(scene, {80, 60});
  expectExact(judge(scene, view, lists()));
  EXPECT_EQ(stats.overflow, 0u);
  const std::uint64_t pixels = stats.pixels;
  expectExact(judge(scene, view, lists({{"array", 8}})));
  EXPECT_GT(stats.overflow, 100u);
  EXPECT_LT(stats.overflow, pixels);
  EXPECT_EQ(stats.pixels, pixels) << "a pixel counts once, however often it is done";
}

// OpenGL promises no order of fragments; the lists promise theirs.
TEST_F(Lists, AreInOrderHoweverTheyAreGathered) {
  const test::SurfaceScene scene = test::randomScene(150, 3);
  const View view = viewOf(scene, {80, 60});
  const HitImage ordered = draw(scene, view, lists());
  EXPECT_EQ(detail("lists put in order"), 0);
  const HitImage turned = draw(scene, view, lists({{"order", 0}}));
  EXPECT_GT(detail("lists put in order"), 100);
  EXPECT_EQ(turned.distance, ordered.distance);
  EXPECT_EQ(turned.id, ordered.id);
}

TEST_F(Lists, BandsGiveTheSameBytes) {
  const test::SurfaceScene scene = test::randomScene(3000, 3);
  const View view = viewOf(scene, {160, 120});
  const HitImage whole = draw(scene, view, lists({{"culling", 0}}));
  EXPECT_EQ(detail("bands"), 1);
  const HitImage banded = draw(scene, view, lists({{"culling", 0}, {"memory", 0.5}}));
  EXPECT_GT(detail("bands"), 2);
  EXPECT_EQ(banded.distance, whole.distance);
  EXPECT_EQ(banded.id, whole.id);
}

// A row of pixels whose lists do not fit is parted, a pixel whose list does not is refused.
TEST_F(Lists, ListsLongerThanTheMemory) {
  MetaballField field;
  for (unsigned i = 1; i <= 2000; ++i) field.balls.push_back({{0, 0, 0}, 2.0f, 1e-3f, 0x808080, i});
  const test::SurfaceScene scene(field);
  View view = test::alongZ(0, 0, 10);
  view.size = {3, 2};
  view.pixelSize = 0.2;
  view.center = {1.5, 1};
  expectExact(judge(scene, view, lists()));
  EXPECT_EQ(detail("longest list"), 2000);
  EXPECT_EQ(detail("bands"), 1);
  expectExact(judge(scene, view, lists({{"memory", 0.02}})));
  EXPECT_EQ(detail("bands"), 6);
  try {
    draw(scene, view, lists({{"memory", 0.01}}));
    ADD_FAILURE() << "drew it";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("2000 balls lie behind one pixel"), std::string::npos);
  }
}

// Mesa's software driver ends loops that run too often; where it has, the picture is refused.
TEST_F(Lists, MoreOverlapThanTheDriverCanLoopOver) {
  MetaballField field;
  for (unsigned i = 1; i <= 70000; ++i) field.balls.push_back({{0, 0, 0}, 2.0f, 1e-4f, 0x808080, i});
  View view = test::alongZ(0, 0, 10);
  view.pixelSize = 0.2;
  try {
    expectExact(judge(test::SurfaceScene(field), view, lists()));
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("more balls overlap in 1 pixels"), std::string::npos);
  }
}

TEST_F(Lists, TwoHundredCoincidentBalls) {
  const test::SurfaceScene scene = test::coincidentBalls();
  for (const Projection projection : kBoth) {
    expectExact(judge(scene, viewOf(scene, {24, 18}, projection), lists()));
    EXPECT_GT(stats.overflow, 50u);
    EXPECT_EQ(detail("longest list"), 200);
  }
}

// What tests/gpu/special_scenes_test.cpp asks of every method, of options that change how it is drawn.
TEST_F(Lists, AThousandBallsAlongOneRayThatIsWalked) {
  const auto [scene, view] = test::ballsAlongOneRay();
  expectExact(judge(scene, view, lists({{"array", 3}})));
}

TEST_F(Lists, ALatticeSeenAlongAnAxisWithoutCulling) {
  const auto [scene, view] = test::latticeAlongAxis();
  expectExact(judge(scene, view, lists({{"culling", 0}})));
}

TEST_F(Lists, WalkedFromInsideBallsAndInsideTheSurface) {
  const test::SurfaceScene scene = test::randomScene(200, 5);
  int i = 0;
  for (const View& view : viewsFromInside(scene)) {
    SCOPED_TRACE(i);
    expectExact(judge(scene, view, lists({{"array", 3}}), "inside" + std::to_string(i++)));
  }
}

TEST_F(Lists, SpheresAndSurfacesHideEachOther) {
  expectSpheresAndSurfacesHideEachOther(lists());
}

TEST_F(Lists, RefusesNumbersThatAreNotFinite) {
  test::SurfaceScene scene = test::randomScene(10, 1);
  const View view = viewOf(scene, {16, 12});
  scene.primitives->surfaces[0].balls[3].support = std::numeric_limits<float>::infinity();
  EXPECT_THROW(draw(scene, view, lists()), InputError);
}

TEST_F(Lists, SupportsFromAThousandthToAThousandInOnePicture) {
  const test::SurfaceScene scene = test::manyScales();
  expectExact(judge(scene, viewOf(scene, {64, 48}, Projection::orthographic), lists()));
}

TEST_F(Lists, NothingIsDrawnAboveEveryMaximum) {
  for (const unsigned balls : {1u, 2u, 40u}) {
    const test::SurfaceScene scene = test::nearMaximum(balls, -1e-5).scene;
    const HitImage image = draw(scene, viewOf(scene, {63, 47}), lists());
    EXPECT_EQ(std::count(image.id.begin(), image.id.end(), 0u), std::ptrdiff_t{63} * 47);
  }
}

}  // namespace
}  // namespace meniscus

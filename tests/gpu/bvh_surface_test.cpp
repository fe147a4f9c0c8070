// The method "bvh" against the truth: exact with the guaranteed search; what the paper's misses is counted.

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "core/error.h"
#include "core/generated_scenes.h"
#include "tests/gpu/surface_judge.h"
#include "tests/support/exact_field.h"

namespace meniscus {
namespace {

SurfaceSettings bvh(std::map<std::string, double> parameters = {}) {
  return {"bvh", std::move(parameters)};
}

test::SurfaceView stabilityScene(std::string_view name) {
  for (const StabilityRecipe& recipe : stabilityRecipes()) {
    if (recipe.name != name) continue;
    const StabilityScene scene = recipe.make(1, {48, 36});
    return {std::make_shared<Primitives>(*scene.surface), scene.view};
  }
  throw std::out_of_range(std::string(name));
}

constexpr Projection kBoth[] = {Projection::perspective, Projection::orthographic};

class BvhSurface : public test::SurfaceTest {};

TEST_F(BvhSurface, RandomBalls) {
  const test::SurfaceScene scene = test::randomScene(1000, 1);
  for (const Projection projection : kBoth)
    expectExact(judge(scene, viewOf(scene, {160, 120}, projection), bvh()));
  EXPECT_EQ(stats.notConverged, 0u);
  EXPECT_EQ(stats.overflow, 0u);
  EXPECT_GT(detail("nodes met"), detail("cells searched"));
  EXPECT_GT(stats.pixels, detail("hits"));
}

TEST_F(BvhSurface, EveryTree) {
  const test::SurfaceScene scene = test::randomScene(300, 4);
  for (const char* off : {"square", "fit", "tight", "discard"}) {
    SCOPED_TRACE(off);
    expectExact(judge(scene, viewOf(scene, {64, 48}), bvh({{off, 0}})));
  }
}

TEST_F(BvhSurface, EveryMolecule) {
  for (const auto& file : test::moleculeFiles()) {
    SCOPED_TRACE(file.filename().string());
    const test::SurfaceScene scene = test::moleculeScene(file);
    expectExact(judge(scene, viewOf(scene, {96, 72}), bvh(), file.filename().string()));
  }
}

TEST_F(BvhSurface, EveryKernel) {
  for (const Kernel kernel : {Kernel{KernelShape::quartic}, Kernel{KernelShape::power, 7}}) {
    SCOPED_TRACE(kernel.exponent);
    const test::SurfaceScene scene(test::randomField(kernel, 0.3, 60, 4, 0, 7));
    expectExact(judge(scene, viewOf(scene, {80, 60}), bvh()));
  }
}

// More than a shader's array holds: the processor casts what is left to it.
TEST_F(BvhSurface, TwoHundredCoincidentBalls) {
  const test::SurfaceScene scene = test::coincidentBalls();
  for (const Projection projection : kBoth) {
    expectExact(judge(scene, viewOf(scene, {24, 18}, projection), bvh()));
    EXPECT_GT(stats.overflow, 0u);
    EXPECT_EQ(stats.overflow, static_cast<std::uint64_t>(detail("cast by the processor")));
  }
}

// Kernels of degree 32, whose loops a software driver may end for a whole group of pixels, and lone balls at
// levels next to 0 and next to the most that they reach.
TEST_F(BvhSurface, StiffScenes) {
  for (const char* name : {"power-16", "steep-field", "level-low", "level-high"}) {
    SCOPED_TRACE(name);
    const test::SurfaceView s = stabilityScene(name);
    expectExact(judge(s.scene, s.view, bvh(), name));
  }
}

// The loop over a cell's members has turns of the kernel's own in it.
TEST_F(BvhSurface, AsManyBallsInACellAsTheKernelAllows) {
  MetaballField field;
  field.kernel = {KernelShape::power, 16};
  for (unsigned i = 1; i <= 1500; ++i) field.balls.push_back({{0, 0, 0}, 2.0f, 1e-3f, 0x808080, i});
  const View view = test::alongZ(0, 0, 10);
  expectExact(judge(test::SurfaceScene(field), view, bvh()));
  for (unsigned i = 1501; i <= 1600; ++i) field.balls.push_back({{0, 0, 0}, 2.0f, 1e-3f, 0x808080, i});
  try {
    draw(test::SurfaceScene(field), view, bvh());
    ADD_FAILURE() << "drew it";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("1600 balls of a surface overlap in one place, of which 1562"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(BvhSurface, SpheresAndTwoSurfacesHideEachOther) {
  const test::SurfaceScene scene = test::twoSurfaces();
  expectExact(judge(scene, viewOf(scene, {96, 72}), bvh()));
  expectSpheresAndSurfacesHideEachOther(bvh(), QuadricMethod::automatic, 1e-5f);
}

// Rays that dip into the surface between two projections are missed, and nothing else.
TEST_F(BvhSurface, ThePapersSearchMissesNearlyTangentRaysOnly) {
  const test::SurfaceScene scene = test::randomScene(300, 3);
  const HitErrors e = judge(scene, viewOf(scene, {160, 120}), bvh({{"search", 1}}));
  EXPECT_EQ(e.falseHits, 0u);
  EXPECT_GT(e.missed, 0u);
  EXPECT_LE(e.missed, e.compared / 50);
  EXPECT_EQ(stats.method, "bvh (the paper's search)");
}

TEST_F(BvhSurface, UnknownOptionsAreNamed) {
  const test::SurfaceScene scene = test::randomScene(10, 1);
  EXPECT_THROW(draw(scene, viewOf(scene, {16, 12}), bvh({{"search", 2}})), UsageError);
  EXPECT_THROW(draw(scene, viewOf(scene, {16, 12}), bvh({{"depth", 2}})), UsageError);
}

}  // namespace
}  // namespace meniscus

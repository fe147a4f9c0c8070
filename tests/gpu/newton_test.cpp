// The method "newton" against the truth: with its bracket and all terms it is exact; as the poster has it,
// and with an ambient field, its errors are counted and bounded.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/ambient_field.h"
#include "core/error.h"
#include "tests/gpu/surface_judge.h"
#include "tests/support/exact_field.h"

namespace meniscus {
namespace {

using Parameters = std::map<std::string, double>;

SurfaceSettings newton(Parameters parameters = {}) {
  return {"newton", std::move(parameters)};
}

constexpr Projection kBoth[] = {Projection::perspective, Projection::orthographic};

class Newton : public test::SurfaceTest {};

TEST_F(Newton, RandomBalls) {
  const test::SurfaceScene scene = test::randomScene(1000, 1);
  for (const Projection projection : kBoth)
    expectExact(judge(scene, viewOf(scene, {160, 120}, projection), newton()));
  EXPECT_EQ(stats.notConverged, 0u);
  EXPECT_GT(stats.iterations, stats.pixels);
  EXPECT_GT(stats.pixels, detail("hits"));
}

TEST_F(Newton, EveryMolecule) {
  for (const auto& file : test::moleculeFiles()) {
    SCOPED_TRACE(file.filename().string());
    const test::SurfaceScene scene = test::moleculeScene(file);
    expectExact(judge(scene, viewOf(scene, {96, 72}), newton(), file.filename().string()));
  }
}

TEST_F(Newton, EveryKernel) {
  for (const Kernel kernel : {Kernel{KernelShape::quartic}, Kernel{KernelShape::power, 2},
                              Kernel{KernelShape::power, 7}, Kernel{KernelShape::power, 16}}) {
    SCOPED_TRACE(kernel.exponent);
    const test::SurfaceScene scene(test::randomField(kernel, 0.3, 60, 4, 0, 7));
    expectExact(judge(scene, viewOf(scene, {80, 60}), newton()));
  }
}

TEST_F(Newton, TwoHundredCoincidentBalls) {
  const test::SurfaceScene scene = test::coincidentBalls();
  for (const Projection projection : kBoth)
    expectExact(judge(scene, viewOf(scene, {24, 18}, projection), newton()));
}

TEST_F(Newton, SpheresAndTwoSurfacesHideEachOther) {
  const test::SurfaceScene scene = test::twoSurfaces();
  expectExact(judge(scene, viewOf(scene, {96, 72}), newton()));
  expectSpheresAndSurfacesHideEachOther(newton(), QuadricMethod::automatic, 1e-5f);
}

// The poster's iteration: pixels are lost, counted, and shown.
TEST_F(Newton, ThePostersIterationFailsAndSaysSo) {
  const test::SurfaceScene scene = test::randomScene(150, 3);
  const View view = viewOf(scene, {96, 72});
  std::uint64_t before = ~std::uint64_t{0};
  for (const double iterations : {3, 8, 32}) {
    const HitErrors e =
        judge(scene, view, newton({{"safeguard", 0}, {"debug", 0}, {"iterations", iterations}}));
    EXPECT_LT(stats.notConverged, before);
    before = stats.notConverged;
    EXPECT_GT(e.compared, 500u);
  }
  EXPECT_LT(before, 96 * 72 / 20);
  const Parameters few{{"safeguard", 0}, {"debug", 0}, {"iterations", 3}};
  const HitImage holes = draw(scene, view, newton(few));
  Parameters shown = few;
  shown["debug"] = 1;
  const HitImage magenta = draw(scene, view, newton(shown));
  std::size_t filled = 0;
  for (std::size_t i = 0; i < holes.id.size(); ++i) filled += holes.id[i] == 0 && magenta.id[i] != 0 ? 1 : 0;
  EXPECT_EQ(filled, stats.notConverged);
  EXPECT_GT(filled, 50u);
}

// With as many terms as are ever active nothing is left to the ambient field.
TEST_F(Newton, ManyTermsAreAllTerms) {
  const test::SurfaceScene scene = test::randomScene(150, 3);
  const View view = viewOf(scene, {64, 48});
  const HitErrors e = judge(scene, view, newton({{"terms", 32}, {"ambient", 0}}));
  EXPECT_EQ(e.falseHits, 0u);
  EXPECT_LE(e.missed, 2u);
  EXPECT_LE(e.relativeRms, 1e-4);
}

TEST_F(Newton, AFinerAmbientFieldAndMoreTermsAreMoreExact) {
  const test::SurfaceScene scene = test::randomScene(150, 3);
  const View view = viewOf(scene, {64, 48});
  double before = 1e9;
  for (const double cells : {8, 32, 128}) {
    const HitErrors e = judge(scene, view, newton({{"terms", 2}, {"ambient", cells}}));
    EXPECT_LT(e.distanceP99, before);
    before = e.distanceP99;
  }
  EXPECT_LT(before, 0.05);
  const HitErrors none = judge(scene, view, newton({{"terms", 2}, {"ambient", 0}}));
  EXPECT_GT(none.distanceP99, 0.2) << "what the texture is for";
  const HitErrors more = judge(scene, view, newton({{"terms", 4}, {"ambient", 128}}));
  EXPECT_LT(more.distanceP99, before);
}

TEST_F(Newton, UnknownOptionsAreNamed) {
  const test::SurfaceScene scene = test::randomScene(10, 1);
  EXPECT_THROW(draw(scene, viewOf(scene, {16, 12}), newton({{"terms", 33}})), UsageError);
  EXPECT_THROW(draw(scene, viewOf(scene, {16, 12}), newton({{"steps", 1}})), UsageError);
}

}  // namespace
}  // namespace meniscus

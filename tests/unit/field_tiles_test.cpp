// Metaballs cast from tiles against the double-precision truth, against uncut lists, and by every instruction
// set and in every cutting of the picture to the same bits.

#include "core/tiles/field_tiles.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/hit_errors.h"
#include "core/reference_tracer.h"
#include "core/shared_math.h"
#include "core/tiles/instruction_sets.h"
#include "tests/support/exact_field.h"
#include "tests/support/random.h"

namespace meniscus::tiles {
namespace {

constexpr PlaneChannels kAll{true, true, true, true};
const glm::dvec3 kOrigin(-4, 17, 3);

struct Case {
  const char* name;
  Kernel kernel;
  double level;
  int hollow;  ///< every so many balls one takes away
};
const Case kCases[] = {{"sextic", {KernelShape::sextic}, 0.5, 0},
                       {"sextic, hollow", {KernelShape::sextic}, 0.2, 3},
                       {"quartic", {KernelShape::quartic}, 0.5, 0},
                       {"quartic, hollow", {KernelShape::quartic}, 0.3, 2},
                       {"power 2, hollow", {KernelShape::power, 2}, 0.1, 3},
                       {"power 3", {KernelShape::power, 3}, 0.4, 0},
                       {"power 7, hollow", {KernelShape::power, 7}, 0.05, 3},
                       {"power 16", {KernelShape::power, 16}, 0.02, 0},
                       {"power 16, hollow", {KernelShape::power, 16}, 0.01, 3}};

TileTarget targetOf(const View& view) {
  return {view, kOrigin, {0, 0, view.size.width, view.size.height}, {0, 0}};
}

// The whole picture as data.
HitImage cast(const MetaballField& field, const TileTarget& target, FieldCounts* counts = nullptr,
              std::vector<std::uint32_t>* albedo = nullptr) {
  FieldTiles caster;
  caster.setField(&field);
  Planes planes;
  caster.cast(target, kAll, planes);
  if (counts != nullptr) *counts = caster.takeCounts();
  HitImage image;
  image.size = {target.area.width, target.area.height};
  const auto pixels = static_cast<std::size_t>(target.area.width * target.area.height);
  image.distance.assign(pixels, std::numeric_limits<float>::infinity());
  image.id.assign(pixels, 0);
  image.normal.assign(pixels, glm::vec3(0.0f));
  if (albedo != nullptr) albedo->assign(pixels, 0);
  for (int y = 0; y < planes.area.height; ++y) {
    for (int x = 0; x < planes.area.width; ++x) {
      const auto from = static_cast<std::size_t>(y * planes.area.width + x);
      const auto to = static_cast<std::size_t>((y + planes.area.y - target.area.y) * target.area.width + x +
                                               planes.area.x - target.area.x);
      EXPECT_EQ(planes.depth[from] > 0, planes.id[from] != 0);
      if (!(planes.depth[from] > 0)) continue;
      image.distance[to] = planes.distance[from];
      image.id[to] = planes.id[from];
      const std::uint32_t n = planes.normal[from];
      image.normal[to] = f32::decodeNormal(glm::vec2(n & 0xFFFFu, n >> 16) / 65535.0f);
      if (albedo != nullptr) (*albedo)[to] = planes.albedo[from];
    }
  }
  return image;
}

void expectTrue(const MetaballField& field, const View& view, const char* what) {
  const ReferenceImage truth = traceReference(field, kOrigin, view);
  FieldCounts counts;
  const HitErrors errors = compareHits(cast(field, targetOf(view), &counts), truth);
  EXPECT_EQ(errors.missed, 0u) << what;
  EXPECT_EQ(errors.falseHits, 0u) << what;
  EXPECT_LE(errors.relativeRms, 1e-5) << what;
  EXPECT_LE(errors.normalRmsDeg, 0.02) << what;
  EXPECT_LE(errors.idsDiffer, errors.compared / 1000 + 1) << what;
  EXPECT_EQ(counts.notConverged, 0u) << what;
  EXPECT_GT(errors.compared, 100u) << what;
}

// The middle of a scene that reaches `reach` [Å] in front and behind, from so far away that rays are all but
// parallel; height: of the picture [Å].
View viewFromAfar(Projection projection, ImageSize size, double height, double distance, double reach) {
  Camera camera;
  camera.projection = projection;
  camera.target = kOrigin;
  camera.distance = distance;
  camera.fovY = height / distance;
  return makeView(camera, size, {kOrigin, reach});
}

class FieldTilesTest : public testing::TestWithParam<Projection> {
 protected:
  void TearDown() override { useInstructionSet(""); }
};
INSTANTIATE_TEST_SUITE_P(Projections, FieldTilesTest,
                         testing::Values(Projection::perspective, Projection::orthographic),
                         [](const auto& each) {
                           return each.param == Projection::perspective ? "perspective" : "orthographic";
                         });

TEST_P(FieldTilesTest, HitsAreTheTruth) {
  unsigned seed = 100;
  for (const Case& c : kCases) {
    const MetaballField field = test::randomField(c.kernel, c.level, 60, 6, c.hollow, ++seed);
    expectTrue(field, test::viewOfBall(GetParam(), {120, 90}, kOrigin, 15), c.name);
  }
}

TEST_P(FieldTilesTest, HitsAreTheTruthWhereTheNearPlaneCuts) {
  unsigned seed = 200;
  for (const Case& c : kCases) {
    const MetaballField field = test::randomField(c.kernel, c.level, 60, 6, c.hollow, ++seed);
    View view = test::viewOfBall(GetParam(), {80, 60}, kOrigin, 15);
    view.nearZ = 0;
    expectTrue(field, view, c.name);
  }
}

// Tiles that are wide and deep, balls of every size, some of which take away, far apart in depth: no tile's
// rays begin behind what they meet.
TEST_P(FieldTilesTest, NothingIsPassedOver) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    test::Random random(400 + seed);
    MetaballField field;
    field.kernel = kCases[seed % std::size(kCases)].kernel;
    field.level = kCases[seed % std::size(kCases)].level;
    for (int i = 0; i < 600; ++i) {
      const double depth = i % 3 == 0 ? random.uniform(-2000, 0) : random.uniform(-30, 30);
      const double across = 25 + (GetParam() == Projection::perspective ? std::max(-depth, 0.0) : 0.0);
      const glm::vec3 center(random.uniform(-1, 1) * across, random.uniform(-1, 1) * across, depth);
      field.balls.push_back({center, static_cast<float>(random.logUniform(0.3, 8)), i % 7 == 6 ? -0.5f : 1.0f,
                             0x808080, static_cast<std::uint32_t>(i + 1)});
    }
    Camera camera;
    camera.projection = GetParam();
    camera.target = kOrigin;
    camera.distance = 70;
    camera.fovY = GetParam() == Projection::perspective ? 2.2 : 1;
    expectTrue(field, makeView(camera, {100, 75}, {kOrigin, 2200}), field.allPositive() ? "added" : "hollow");
  }
}

// Specks too faint to be seen, 1e5 Å in front of most tiles: what lies behind is as exact as without them.
TEST_P(FieldTilesTest, WhatIsNotSeenInFrontCostsNoDigits) {
  MetaballField field = test::randomField({KernelShape::sextic}, 0.5, 60, 6, 0, 500);
  test::Random random(501);
  for (std::uint32_t i = 0; i < 150; ++i) {
    const glm::vec3 center(random.uniform(-7, 7), random.uniform(-7, 7), 1e5 + random.uniform(-20, 20));
    field.balls.push_back({center, 0.2f, 0.4f, 0x808080, 1000 + i});
  }
  const View view = viewFromAfar(GetParam(), {160, 120}, 20, 4e6, 1.1e5);
  const HitErrors errors = compareHits(cast(field, targetOf(view)), traceReference(field, kOrigin, view));
  EXPECT_EQ(errors.missed, 0u);
  EXPECT_EQ(errors.falseHits, 0u);
  EXPECT_LE(errors.normalRmsDeg, 0.02);
  EXPECT_GT(errors.compared, 5000u);
}

// Rays that have met something wait for those beside them, but not while these pass through balls without
// end.
TEST_P(FieldTilesTest, NoRayWaitsForAll) {
  MetaballField field;
  field.level = 0.5;
  for (int i = 0; i < 400; ++i)  // 10 at a place, all rays through all of them
    field.balls.push_back({{0, 0, -5 - 0.8f * static_cast<float>(i)}, 4, 0.04f, 0x808080, 1});
  field.balls.push_back({{0, 0, -335}, 6, 1, 0x808080, 2});
  for (int i = 0; i < 36; ++i)
    field.balls.push_back(
        {{static_cast<float>(i % 6) * 0.7f - 1.75f, static_cast<float>(i / 6) * 0.7f - 1.75f, 10},
         0.4f,
         1,
         0,
         3});
  const View view = viewFromAfar(GetParam(), {40, 40}, 4, 1e5, 400);
  FieldCounts counts;
  const HitErrors errors =
      compareHits(cast(field, targetOf(view), &counts), traceReference(field, kOrigin, view));
  EXPECT_EQ(errors.missed, 0u);
  EXPECT_EQ(errors.falseHits, 0u);
  EXPECT_GT(errors.compared, 1400u);
  EXPECT_LT(counts.mostChords, 100u);
}

TEST_P(FieldTilesTest, HitsAreTheTruthFromWithin) {
  test::Random random(3);
  for (int i = 0; i < 6; ++i) {
    const MetaballField field = test::randomField({KernelShape::sextic}, 0.3, 60, 6, i % 2 == 0 ? 0 : 3,
                                                  300u + static_cast<unsigned>(i));
    Camera camera;
    camera.projection = GetParam();
    camera.orientation = random.rotation();
    camera.target = kOrigin + random.inBox(3);
    camera.distance = random.logUniform(0.01, 3);
    camera.fovY = random.uniform(0.5, 2);
    const View view = makeView(camera, {60, 50}, {kOrigin, 15});
    const ReferenceImage truth = traceReference(field, kOrigin, view);
    const HitErrors errors = compareHits(cast(field, targetOf(view)), truth);
    EXPECT_EQ(errors.missed, 0u) << i;
    EXPECT_EQ(errors.falseHits, 0u) << i;
    EXPECT_LE(errors.relativeRms, 1e-5) << i;
  }
}

TEST_P(FieldTilesTest, InstructionSetsGiveTheSameBits) {
  struct Crowd {
    Case kind;
    double spread;
  };
  // In the last ones so many overlap that whole stretches of rays are looked at.
  for (const auto& [c, spread] : {Crowd{kCases[1], 9}, Crowd{kCases[2], 9}, Crowd{kCases[6], 9},
                                  Crowd{kCases[1], 2}, Crowd{kCases[3], 2}}) {
    MetaballField field = test::randomField(c.kernel, c.level, 200, spread, c.hollow, 5);
    if (spread < 9)
      for (Metaball& ball : field.balls) ball.coefficient *= 0.3f;
    const View view = test::viewOfBall(GetParam(), {130, 100}, kOrigin, 20);
    std::vector<std::uint32_t> albedo, other;
    const HitImage widest = cast(field, targetOf(view), nullptr, &albedo);
    for (const std::string& set : instructionSets()) {
      useInstructionSet(set);
      const HitImage image = cast(field, targetOf(view), nullptr, &other);
      EXPECT_EQ(image.distance, widest.distance) << set << ' ' << c.name;
      EXPECT_EQ(image.id, widest.id) << set << ' ' << c.name;
      EXPECT_EQ(image.normal, widest.normal) << set << ' ' << c.name;
      EXPECT_EQ(other, albedo) << set << ' ' << c.name;
    }
    useInstructionSet("");
  }
}

TEST_P(FieldTilesTest, AreasGiveTheSameBits) {
  const MetaballField field = test::randomField({KernelShape::sextic}, 0.5, 100, 7, 4, 9);
  const View view = test::viewOfBall(GetParam(), {100, 90}, kOrigin, 17);
  const HitImage whole = cast(field, targetOf(view));
  for (int y = 0; y < 90; y += 37) {
    for (int x = 0; x < 100; x += 37) {
      TileTarget target = targetOf(view);
      target.area = {x, y, std::min(37, 100 - x), std::min(37, 90 - y)};
      const HitImage part = cast(field, target);
      for (int row = 0; row < target.area.height; ++row) {
        for (int column = 0; column < target.area.width; ++column) {
          const auto here = static_cast<std::size_t>(row * target.area.width + column),
                     there = static_cast<std::size_t>((y + row) * 100 + x + column);
          ASSERT_EQ(part.distance[here], whole.distance[there]);
          ASSERT_EQ(part.id[here], whole.id[there]);
        }
      }
    }
  }
}

// Of a ball alone the surface is a sphere, where the field is too flat for float32, too; from outside and
// from its middle.
TEST_P(FieldTilesTest, LoneBallsAreTheirCores) {
  for (const Kernel kernel : {Kernel{}, Kernel{KernelShape::quartic}, Kernel{KernelShape::power, 2},
                              Kernel{KernelShape::power, 16}}) {
    for (const double below : {0.1, 1e-3, 1e-6}) {
      SCOPED_TRACE(below);
      MetaballField field;
      field.kernel = kernel;
      field.level = 1.5 * (1 - below);
      const double core = 2 * coreShare(kernel, field.level, 1.5);
      const auto apart = static_cast<float>(1.5 * core);
      // The third takes away and reaches into the first, but not to its core.
      field.balls = {{{0, 0, 0}, 2, 1.5f, 0xFFFFFF, 1}, {{9, 0, 0}, 2, 1.5f, 0xFFFFFF, 2}};
      if (below > 0.01) field.balls.push_back({{0, apart + 2, 0}, 2, -0.5f, 0xFFFFFF, 3});
      const View outside = test::viewOfBall(GetParam(), {60, 50}, kOrigin, 1.3 * core);
      expectTrue(field, outside, "outside");

      Camera camera;
      camera.projection = GetParam();
      camera.target = kOrigin;
      camera.distance = 0.01 * core;
      camera.fovY = 1.5;
      const View within = makeView(camera, {40, 30}, {kOrigin, 15});
      const ReferenceImage truth = traceReference(field, kOrigin, within);
      const HitErrors errors = compareHits(cast(field, targetOf(within)), truth);
      EXPECT_EQ(errors.missed + errors.falseHits, 0u);
      EXPECT_LE(errors.relativeRms, 1e-5);
      if (GetParam() == Projection::perspective) {
        EXPECT_EQ(errors.compared, 1200u) << "a wall all around";
      }
    }
  }
}

// Thousands of balls in one place: the window holds 128 at first and grows.
TEST_P(FieldTilesTest, AnyNumberOfBallsMayOverlap) {
  MetaballField field;
  field.level = 300;
  test::Random random(1);
  for (std::uint32_t i = 1; i <= 1000; ++i)
    field.balls.push_back({glm::vec3(random.inBox(1)), 4, 1, 0xFFFFFF, i});
  const View view = test::viewOfBall(GetParam(), {24, 16}, kOrigin, 5);
  FieldCounts counts;
  const HitErrors errors =
      compareHits(cast(field, targetOf(view), &counts), traceReference(field, kOrigin, view));
  EXPECT_EQ(errors.missed + errors.falseHits, 0u);
  EXPECT_LE(errors.relativeRms, 1e-5);
}

// Balls almost in one place, some of which may take away, seen from outside and from within: a ray passes
// their entries and exits in a few steps, and not one by one.
TEST_P(FieldTilesTest, ManyEntriesArePassedAtOnce) {
  struct Heap {
    double spread;
    double level;
    int hollow;
    bool within;
  };
  for (const Heap& heap : {Heap{1e-3, 0.5, 0, false}, Heap{1, 0.5, 0, false}, Heap{1, 150, 0, false},
                           Heap{0.5, 10, 3, false}, Heap{0.5, 10, 0, true}}) {
    SCOPED_TRACE(fmt::format("{} A, level {}, {}", heap.spread, heap.level, heap.within));
    constexpr std::uint32_t kBalls = 500;
    MetaballField field;
    field.level = heap.level;
    test::Random random(7);
    for (std::uint32_t i = 1; i <= kBalls; ++i) {
      const bool takes = heap.hollow > 0 && i % static_cast<std::uint32_t>(heap.hollow) == 0;
      field.balls.push_back({glm::vec3(random.inBox(heap.spread)), 4, takes ? -1.0f : 1.0f, 0xFFFFFF, i});
    }
    View view = test::viewOfBall(GetParam(), {24, 16}, kOrigin, 5);
    if (heap.within) {
      Camera camera;
      camera.projection = GetParam();
      camera.target = kOrigin;
      camera.distance = 0.1;
      camera.fovY = 1;
      view = makeView(camera, {24, 16}, {kOrigin, 6});
    }
    FieldCounts counts;
    const HitErrors errors =
        compareHits(cast(field, targetOf(view), &counts), traceReference(field, kOrigin, view));
    EXPECT_EQ(errors.missed + errors.falseHits, 0u);
    EXPECT_LE(errors.relativeRms, 1e-5);
    EXPECT_GT(errors.compared, 30u);
    EXPECT_LT(counts.intervals, 8 * counts.rays);
    EXPECT_LT(counts.pieces, 4 * counts.rays);
    EXPECT_LT(counts.stretches, 10 * counts.rays);
  }
}

// Balls in a heap that rays pass at once, whether it shows or not, and a wall behind.
TEST_P(FieldTilesTest, WhatLiesBehindManyEntriesIsMet) {
  for (const bool faint : {true, false}) {
    MetaballField field;
    field.level = 0.5;
    test::Random random(11);
    std::uint32_t id = 0;
    for (int i = 0; i < 120; ++i)
      field.balls.push_back({glm::vec3(random.inBox(0.5)), 4,
                             faint        ? 0.004f
                             : i % 2 == 0 ? 0.05f
                                          : -0.05f,
                             0xFFFFFF, ++id});
    for (int x = -6; x <= 6; ++x)
      for (int y = -6; y <= 6; ++y)
        field.balls.push_back({glm::vec3(1.5 * x, 1.5 * y, -20), 3, 1, 0xFFFFFF, ++id});
    const View view = viewFromAfar(GetParam(), {64, 48}, 8, 500, 25);
    const HitErrors errors = compareHits(cast(field, targetOf(view)), traceReference(field, kOrigin, view));
    EXPECT_EQ(errors.missed + errors.falseHits, 0u);
    EXPECT_LE(errors.relativeRms, 1e-5);
    EXPECT_EQ(errors.compared, 64u * 48u) << "the wall fills the picture";
  }
}

// A ball of one colour beside one of another: between them the colour is in between, by squares.
TEST(FieldTilesColor, IsBlendedBySquares) {
  MetaballField field;
  field.level = 0.5;
  const View view = test::viewOfBall(Projection::orthographic, {101, 101}, kOrigin, 6);
  const glm::vec3 right(glm::transpose(view.rotation) * glm::dvec3(1, 0, 0));
  field.balls = {{-right, 4, 1, 0xFF0000, 1}, {right, 4, 1, 0x0000FF, 2}};
  std::vector<std::uint32_t> albedo;
  const HitImage image = cast(field, targetOf(view), nullptr, &albedo);
  const auto middle = static_cast<std::size_t>(50 * 101 + 50);
  ASSERT_NE(image.id[middle], 0u);
  EXPECT_NEAR(static_cast<int>(albedo[middle] & 0xFFu), std::lround(255 * std::sqrt(0.5)), 2);
  EXPECT_NEAR(static_cast<int>(albedo[middle] >> 16 & 0xFFu), std::lround(255 * std::sqrt(0.5)), 2);
  EXPECT_EQ(albedo[middle] >> 8 & 0xFFu, 0u);
  EXPECT_EQ(albedo[middle] >> 24, 0xFFu);
}

}  // namespace
}  // namespace meniscus::tiles

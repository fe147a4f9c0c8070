// Levels of detail: pictures of quadrics smaller than a pixel cover as much and have the same colours, on
// average, as if each was drawn.

#include "core/tiles/detail_levels.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/srgb.h"
#include "core/tiles/quadric_source.h"
#include "tests/support/random.h"
#include "tests/unit/tile_casts.h"

namespace meniscus::tiles {
namespace {

// As dense as a protein: a disturbed grid 2.6 Å apart, in a ball of so many. Red below, blue above.
std::vector<SpherePrimitive> dense(int count, unsigned seed) {
  test::Random random(seed);
  const double radius = 2.6 * std::cbrt(count * 3 / (4 * 3.14159265358979));
  const int reach = static_cast<int>(radius / 2.6) + 1;
  std::vector<SpherePrimitive> out;
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) {
      for (int z = -reach; z <= reach; ++z) {
        const glm::dvec3 p = 2.6 * glm::dvec3(x, y, z) + random.inBox(0.9);
        if (glm::length(p) > radius) continue;
        const auto id = static_cast<std::uint32_t>(out.size() + 1);
        out.push_back(
            {glm::vec3(p), static_cast<float>(random.uniform(1.2, 1.9)), y < 0 ? 0xC03020u : 0x2030C0u, id});
      }
    }
  }
  return out;
}

struct Means {
  double covered = 0;       // share of all rays
  glm::dvec3 color{0.0};    // linear, of those
  std::size_t entries = 0;  // of the lists
};

// Over 16 rays for each pixel.
Means meansOf(const Primitives& primitives, const View& view, bool thinned) {
  QuadricTiles caster;
  caster.setPrimitives(&primitives);
  Means means;
  double rays = 0;
  for (int i = 0; i < 16; ++i) {
    TileTarget target = targetOf(primitives, view, glm::vec2(glm::dvec2(i % 4 - 1.5, i / 4 - 1.5) / 4.0));
    target.thinned = thinned;
    Planes planes;
    caster.cast(target, kAll, planes, Extent::whole);
    const auto& linear = linearOfBytes();
    for (std::size_t p = 0; p < planes.pixels(); ++p) {
      if (planes.id[p] == 0) continue;
      const std::uint32_t c = planes.albedo[p];
      means.color += glm::dvec3(linear[c & 255], linear[c >> 8 & 255], linear[c >> 16 & 255]);
      ++means.covered;
    }
    rays += static_cast<double>(planes.pixels());
  }
  means.color /= means.covered;
  means.covered /= rays;
  means.entries = caster.lists().entryCount();
  return means;
}

// share: of the coverage; color: of linear light; fewer: share of the entries that lists may keep.
void expectAlike(const Primitives& primitives, const View& view, double share, double color, double fewer) {
  const Means all = meansOf(primitives, view, false), thinned = meansOf(primitives, view, true);
  EXPECT_LT(static_cast<double>(thinned.entries), fewer * static_cast<double>(all.entries));
  EXPECT_NEAR(thinned.covered / all.covered, 1, share);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(thinned.color[i], all.color[i], color) << i;
}

class Detail : public testing::TestWithParam<Projection> {};
INSTANTIATE_TEST_SUITE_P(Projections, Detail,
                         testing::Values(Projection::perspective, Projection::orthographic),
                         [](const auto& each) {
                           return each.param == Projection::perspective ? "perspective" : "orthographic";
                         });

TEST_P(Detail, ASolidCoversAsMuch) {
  Primitives primitives;
  primitives.origin = {100, -20, 3};
  primitives.spheres = dense(40000, 1);
  for (const int size : {4, 9, 15}) {
    SCOPED_TRACE(size);
    expectAlike(primitives, test::viewOf(primitives, {size, size}, GetParam()), size == 4 ? 0.05 : 0.02, 0.02,
                0.8);
  }
}

// Of about a pixel each, far from each other.
TEST_P(Detail, MoleculesCoverAsMuch) {
  Primitives primitives;
  QuadricUnit& unit = primitives.units.emplace_back();
  unit.spheres = dense(150, 2);
  test::Random random(9);
  for (std::uint32_t i = 0; i < 200; ++i)
    unit.copies.push_back({{glm::mat3_cast(random.rotation()), random.inBox(400)}, 150 * i});
  const View view = viewOfBounds(primitives, {40, 40}, GetParam());
  expectAlike(primitives, view, 0.05, 0.05, 0.5);  // by one ball each, which has a single colour
}

TEST_P(Detail, RodsAndEllipsoidsCoverAsMuch) {
  Primitives primitives;
  for (const SpherePrimitive& s : dense(24000, 4)) {
    if (s.id % 5 == 0) {
      primitives.ellipsoids.push_back({s.center, 0.3f, {1.2f, 0, 0}, {0, 0.8f, 0}, s.color, s.id});
    } else {
      primitives.cylinders.push_back({s.center, 0.3f,
                                      s.center + 0.8f * glm::vec3(s.radius, s.radius, -s.radius), s.color,
                                      s.color, s.id, s.id});
    }
  }
  expectAlike(primitives, viewOfBounds(primitives, {12, 12}, GetParam()), 0.05, 0.02, 0.8);
}

// Most of them farther apart than a ball may reach, and much smaller.
TEST_P(Detail, WhatIsAloneStaysAsItIs) {
  Primitives primitives;
  test::Random random(3);
  for (std::uint32_t id = 1; id <= 25000; ++id)
    primitives.spheres.push_back({glm::vec3(random.inBox(500)), 1.2f, 0x808080u + id, id});
  const View view = test::viewOf(primitives, {200, 200}, GetParam());
  TileTarget target = targetOf(primitives, view);
  const Planes all = castByLists(primitives, target);
  target.thinned = true;
  const Planes thinned = castByLists(primitives, target);
  std::size_t different = 0;
  for (std::size_t i = 0; i < all.id.size(); ++i) different += all.id[i] != thinned.id[i] ? 1 : 0;
  EXPECT_GT(hitCount(all), 1000u);
  EXPECT_LT(static_cast<double>(different), 0.15 * static_cast<double>(hitCount(all)));
}

TEST_P(Detail, NothingLargerIsThinned) {
  Primitives primitives;
  primitives.spheres = dense(40000, 1);
  const std::shared_ptr<DetailLevels> levels = levelsOf(primitives);
  int last = 100;
  for (const int size : {6, 12, 25, 50, 100, 200, 400}) {
    const View view = test::viewOf(primitives, {size, size}, GetParam());
    TileTarget target = targetOf(primitives, view);
    EXPECT_EQ(levels->levelFor(target), 0) << "not wanted";
    target.thinned = true;
    const int level = levels->levelFor(target);
    EXPECT_LE(level, last) << size;
    last = level;
    // In the middle of the scene; in front it may be half as large again.
    const double pixels =
        1 / (view.pixelSize * (GetParam() == Projection::perspective ? view.distance : 1.0));
    if (1.9 * pixels > 0.36) {
      EXPECT_EQ(level, 0) << size;
    }
    if (1.9 * pixels < 0.2) {
      EXPECT_GT(level, 0) << size;
    }
    float largest = 0;
    for (const SpherePrimitive& s : levels->level(level).primitives->spheres)
      largest = std::max(largest, s.radius);
    if (level > 0) {
      EXPECT_LE(static_cast<double>(largest) * pixels, kThinnedRadius);
    } else {
      EXPECT_EQ(levels->level(level).primitives, &primitives);
    }
    target.view.nearZ = 0;  // cuts off what is nearest
    EXPECT_GE(levels->levelFor(target), level);
  }
  EXPECT_EQ(last, 0);
  // The eye within the scene.
  TileTarget within = targetOf(primitives, test::viewOf(primitives, {6, 6}, GetParam()));
  within.thinned = true;
  within.view.distance = 1;
  EXPECT_EQ(levels->levelFor(within) == 0, GetParam() == Projection::perspective);
}

TEST(DetailLevels, FewHaveNone) {
  Primitives primitives;
  primitives.spheres = dense(500, 1);
  TileTarget target = targetOf(primitives, test::viewOf(primitives, {1, 1}));
  target.thinned = true;
  EXPECT_EQ(levelsOf(primitives)->levelFor(target), 0);
}

TEST(DetailLevels, AreTheSameEveryTime) {
  Primitives primitives;
  primitives.spheres = dense(30000, 5);
  TileTarget target = targetOf(primitives, test::viewOf(primitives, {10, 10}));
  target.thinned = true;
  const std::shared_ptr<DetailLevels> first = levelsOf(primitives), second = levelsOf(primitives);
  TileTarget smaller = targetOf(primitives, test::viewOf(primitives, {4, 4}));
  smaller.thinned = true;
  ASSERT_GT(second->levelFor(smaller), second->levelFor(target)) << "whatever was made before";
  const int level = first->levelFor(target);
  ASSERT_GT(level, 0);
  ASSERT_EQ(second->levelFor(target), level);
  const auto &a = first->level(level).primitives->spheres, &b = second->level(level).primitives->spheres;
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].center, b[i].center);
    ASSERT_EQ(a[i].radius, b[i].radius);
    ASSERT_EQ(a[i].color, b[i].color);
  }
}

}  // namespace
}  // namespace meniscus::tiles

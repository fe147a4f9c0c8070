// Units that stand in several places: what is cast from them is what is cast from every copy by itself.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/random.h"
#include "tests/unit/tile_casts.h"

namespace meniscus::tiles {
namespace {

// Spheres, rods and ellipsoids in places at random, some of them mirrored.
Primitives manyCopies(int perKind, int copies, unsigned seed, double extent) {
  Primitives out;
  out.origin = {-300, 40, 7};
  QuadricUnit& unit = out.units.emplace_back();
  static_cast<Quadrics&>(unit) = allKinds(perKind, seed);
  std::uint32_t ids = 0;
  for (const EllipsoidPrimitive& e : unit.ellipsoids) ids = std::max(ids, e.id);
  test::Random random(seed);
  for (int i = 0; i < copies; ++i) {
    glm::dmat3 turn = glm::mat3_cast(random.rotation());
    if (i % 5 == 4) turn[0] = -turn[0];
    unit.copies.push_back({{turn, random.inBox(extent)}, static_cast<std::uint32_t>(i) * ids});
  }
  return out;
}

// Pixels that show something else, or the same at a distance that rounding does not explain.
std::size_t differences(const Planes& a, const Planes& b, float rounding) {
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.id.size(); ++i) {
    different += a.id[i] != b.id[i] || a.albedo[i] != b.albedo[i] ||
                 (a.id[i] != 0 && !(std::abs(a.distance[i] - b.distance[i]) <= rounding));
  }
  return different;
}

class TileCopies : public testing::TestWithParam<Projection> {};
INSTANTIATE_TEST_SUITE_P(Projections, TileCopies,
                         testing::Values(Projection::perspective, Projection::orthographic),
                         [](const auto& each) {
                           return each.param == Projection::perspective ? "perspective" : "orthographic";
                         });

TEST_P(TileCopies, ShowWhatEachCopyByItselfShows) {
  for (const int copies : {3, 90}) {  // without clusters, and with
    const Primitives shared = manyCopies(80, copies, 3, 60);
    ASSERT_EQ(clustersOf(shared).empty(), copies == 3);
    const Primitives apart = copiesApart(shared);
    const TileTarget target = targetOf(shared, viewOfBounds(shared, {500, 400}, GetParam()));
    const Planes planes = castByLists(shared, target);
    EXPECT_LE(differences(planes, castByLists(apart, target), 2e-4f), 500u * 400 / 100000);
    EXPECT_GT(hitCount(planes), copies == 3 ? 3000u : 10000u);
  }
}

TEST_P(TileCopies, ListsHideNothingThatIsSeen) {
  const Primitives shared = manyCopies(50, 110, 8, 40);
  ASSERT_FALSE(clustersOf(shared).empty());
  View view = viewOfBounds(shared, sizeForForce(96, 80), GetParam());
  for (const double nearZ : {view.nearZ, 0.0}) {
    view.nearZ = nearZ;
    const TileTarget target = targetOf(shared, view);
    expectSame(castByLists(shared, target), castByForce(shared, target), "lists and brute force");
  }
}

TEST_P(TileCopies, OneWhereItIsAreTheQuadricsThemselves) {
  Primitives plain = allKinds(7000, 5), shared;
  shared.origin = plain.origin;
  QuadricUnit& unit = shared.units.emplace_back();
  static_cast<Quadrics&>(unit) = plain;
  unit.copies.push_back({});
  const BoundingSphere bounds = plain.bounds(), same = shared.bounds();
  EXPECT_EQ(bounds.center, same.center);
  EXPECT_EQ(bounds.radius, same.radius);
  const TileTarget target = targetOf(plain, viewOfBounds(plain, {200, 150}, GetParam()));
  expectSame(castByLists(plain, target), castByLists(shared, target), "one copy");
}

// A copy a million Å away, where float32 knows sixteenths of an Å, looks as one at the origin.
TEST_P(TileCopies, LoseNothingFarFromTheOrigin) {
  Primitives here = manyCopies(150, 1, 2, 0), there = here;
  const glm::dvec3 far(1e6, -4e5, 3e5);
  there.units[0].copies[0].motion.shift += far;
  const View view = viewOfBounds(here, {300, 300}, GetParam());
  View moved = view;
  moved.pivot += far;
  const Planes planes = castByLists(here, targetOf(here, view));
  EXPECT_LE(differences(planes, castByLists(there, targetOf(there, moved)), 4e-5f), 1u);
  const Primitives apart = copiesApart(there);
  EXPECT_GT(differences(planes, castByLists(apart, targetOf(apart, moved)), 4e-5f), 10000u)
      << "rounded to float32 there";
}

// A wall of copies, a column of them behind it, and others beside the picture.
TEST_P(TileCopies, HiddenAndOutsideAreNotOpened) {
  Primitives scene;
  QuadricUnit& unit = scene.units.emplace_back();
  static_cast<Quadrics&>(unit) = *test::randomSpheres(400, 1);
  for (int y = -2; y <= 2; ++y) {
    for (int x = -2; x <= 2; ++x) {
      for (int z = 0; z < 40; ++z)
        unit.copies.push_back({{glm::dmat3(1.0), {x * 14.0, y * 14.0, -30.0 * z}}, 0});
      unit.copies.push_back({{glm::dmat3(1.0), {1000 + x * 14.0, y * 14.0, 0}}, 0});
    }
  }
  Camera camera;
  camera.projection = GetParam();
  camera.target = scene.origin;
  camera.distance = 60;
  camera.fovY = 0.3;
  const View view = makeView(camera, {256, 256}, scene.bounds());
  const TileTarget target = targetOf(scene, view);
  const QuadricSource source(scene, target);
  TileLists lists;
  lists.build(source, clustersOf(scene), target);
  EXPECT_GE(lists.openedCopies(), 9u);
  EXPECT_LE(lists.openedCopies(), unit.copies.size() / 4);
  EXPECT_LE(differences(castByLists(scene, target), castByLists(copiesApart(scene), target), 1e-3f), 1u);
}

}  // namespace
}  // namespace meniscus::tiles

// Tile lists and the quadric caster: nothing that can be seen is missing from a list, and every instruction
// set, every way to cut a picture into areas and brute force give the same bits.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "core/tiles/instruction_sets.h"
#include "tests/support/random.h"
#include "tests/unit/tile_casts.h"

namespace meniscus::tiles {
namespace {

class Tiles : public testing::TestWithParam<Projection> {
 protected:
  void TearDown() override { useInstructionSet(""); }
};
INSTANTIATE_TEST_SUITE_P(Projections, Tiles,
                         testing::Values(Projection::perspective, Projection::orthographic),
                         [](const auto& each) {
                           return each.param == Projection::perspective ? "perspective" : "orthographic";
                         });

TEST_P(Tiles, ListsHideNothingThatIsSeen) {
  for (const int count : {1, 30, 2000}) {
    const Primitives primitives = allKinds(count, 7);
    for (const double fovY : {0.1, 0.5, 1.5}) {
      const View view = test::viewOf(primitives, sizeForForce(157, 123), GetParam(), fovY);
      for (const glm::vec2 shift : {glm::vec2(0, 0), glm::vec2(-0.47f, 0.49f)}) {
        const TileTarget target = targetOf(primitives, view, shift);
        expectSame(castByLists(primitives, target), castByForce(primitives, target), "lists and brute force");
      }
    }
  }
}

TEST_P(Tiles, ListsHideNothingFromWithin) {
  const Primitives primitives = allKinds(400, 3);
  test::Random random(5);
  for (int i = 0; i < 8; ++i) {
    Camera camera;
    camera.projection = GetParam();
    camera.orientation = random.rotation();
    camera.target = primitives.origin + random.inBox(6);
    camera.distance = random.logUniform(0.01, 10);
    camera.fovY = random.uniform(0.3, 2.5);
    const View view = makeView(camera, {96, 80}, primitives.bounds());
    const TileTarget target = targetOf(primitives, view);
    const Planes planes = castByLists(primitives, target);
    expectSame(planes, castByForce(primitives, target), "from within");
    EXPECT_GT(hitCount(planes), 0u);
  }
}

// Enough primitives to be grouped; small enough on the screen to be many to a tile.
TEST_P(Tiles, ClustersHideNothingThatIsSeen) {
  const Primitives primitives = allKinds(9000, 21);
  ASSERT_FALSE(clustersOf(primitives).list().empty());
  const View view = test::viewOf(primitives, sizeForForce(96, 96), GetParam());
  const TileTarget target = targetOf(primitives, view);
  expectSame(castByLists(primitives, target), castByForce(primitives, target), "clusters and brute force");
  View within = view;
  within.nearZ = 0;
  const TileTarget cutOpen = targetOf(primitives, within);
  expectSame(castByLists(primitives, cutOpen), castByForce(primitives, cutOpen), "from within");
}

// A cut list serves every sample of its pixels.
TEST_P(Tiles, ListsAreBuiltOncePerView) {
  const auto primitives = test::randomSpheres(3000, 1);
  const View view = test::viewOf(*primitives, {128, 96}, GetParam());
  QuadricTiles caster;
  caster.setPrimitives(primitives.get());
  Planes planes;
  for (const glm::vec2 shift : {glm::vec2(0, 0), glm::vec2(0.4f, -0.4f), glm::vec2(-0.5f, 0.5f)}) {
    caster.cast(targetOf(*primitives, view, shift), kAll, planes);
    const TileTarget target = targetOf(*primitives, view, shift);
    expectSame(spread(planes, target), castByForce(*primitives, target), "kept lists");
  }
  EXPECT_EQ(caster.builds(), 1);
  View closer = view;
  closer.distance *= 0.9;
  caster.cast(targetOf(*primitives, closer), kAll, planes);
  EXPECT_EQ(caster.builds(), 2);
}

TEST_P(Tiles, InstructionSetsGiveTheSameBits) {
  const Primitives primitives = allKinds(500, 11);
  const TileTarget target = targetOf(primitives, test::viewOf(primitives, {200, 160}, GetParam()));
  const std::vector<std::string> sets = instructionSets();
  ASSERT_GE(sets.size(), 1u);
  const Planes widest = castByLists(primitives, target);
  EXPECT_GT(hitCount(widest), 5000u);
  for (const std::string& set : sets) {
    useInstructionSet(set);
    EXPECT_EQ(instructionSet(), set);
    expectSame(castByLists(primitives, target), widest, set.c_str());
  }
}

// So near to each other and so large on the screen that rounding decides which is in front: no bound of one
// may.
TEST_P(Tiles, CoincidentEllipsoidsGiveTheSameBits) {
  test::Random random(11);
  const bool perspective = GetParam() == Projection::perspective;
  for (int i = 0; i < 150; ++i) {
    const glm::dmat3 axes(glm::mat3_cast(random.rotation()));
    const glm::dvec3 a = axes[0], b = 0.95 * axes[1], c = 0.2 * axes[2];
    // The point nearest to the viewer, and a few rays around it.
    const glm::dvec3 top = (a * a.z + b * b.z + c * c.z) / std::sqrt(a.z * a.z + b.z * b.z + c.z * c.z);
    Primitives primitives;
    for (std::uint32_t k = 1; k <= 8; ++k)
      primitives.ellipsoids.push_back(
          {glm::vec3(0), 0.2f, glm::vec3(a * (1 + random.uniform(-1e-7, 1e-7))), glm::vec3(b), 0xFFFFFF, k});
    View view;
    view.projection = GetParam();
    view.distance = 30;
    const double depth = perspective ? view.distance - top.z : 1;
    view.pixelSize = 2e-5 / depth;
    view.size = {16, 8};
    view.center = glm::dvec2(8, 4) - glm::dvec2(top) / (depth * view.pixelSize);
    view.nearZ = 20;
    view.farZ = -20;
    const TileTarget target = targetOf(primitives, view);
    const Planes force = castByForce(primitives, target);
    for (const std::string& set : instructionSets()) {
      useInstructionSet(set);
      expectSame(castByLists(primitives, target), force, set.c_str());
    }
    useInstructionSet("");
  }
}

TEST_P(Tiles, AreasGiveTheSameBits) {
  const Primitives primitives = allKinds(300, 2);
  const View view = test::viewOf(primitives, {150, 110}, GetParam());
  const Planes whole = castByLists(primitives, targetOf(primitives, view));
  for (const int size : {13, 64, 71}) {
    for (int y = 0; y < view.size.height; y += size) {
      for (int x = 0; x < view.size.width; x += size) {
        TileTarget target = targetOf(primitives, view);
        target.area = {x, y, std::min(size, view.size.width - x), std::min(size, view.size.height - y)};
        const Planes part = castByLists(primitives, target);
        for (int row = 0; row < target.area.height; ++row) {
          for (int column = 0; column < target.area.width; ++column) {
            const auto here = static_cast<std::size_t>(row * target.area.width + column);
            const auto there = static_cast<std::size_t>((y + row) * view.size.width + x + column);
            ASSERT_EQ(part.depth[here], whole.depth[there]);
            ASSERT_EQ(part.id[here], whole.id[there]);
            ASSERT_EQ(part.normal[here], whole.normal[there]);
            ASSERT_EQ(part.distance[here], whole.distance[there]);
          }
        }
      }
    }
  }
}

TEST_P(Tiles, HitsAreThoseOfExactRays) {
  const Primitives primitives = allKinds(200, 4);
  const View view = test::viewOf(primitives, {80, 60}, GetParam());
  const Planes planes = castByLists(primitives, targetOf(primitives, view));
  int compared = 0;
  for (int y = 0; y < view.size.height; ++y) {
    for (int x = 0; x < view.size.width; ++x) {
      const test::ExactHit exact = test::exactHit(primitives, view, {x + 0.5, y + 0.5});
      if (exact.clearance < 1e-4 || exact.runnerUp - exact.distance < 1e-4) continue;
      const auto pixel = static_cast<std::size_t>(y * view.size.width + x);
      ASSERT_EQ(planes.id[pixel], exact.id) << x << ' ' << y;
      if (exact.id != 0) {
        EXPECT_NEAR(static_cast<double>(planes.distance[pixel]), exact.distance, 2e-5 * exact.distance);
      }
      ++compared;
    }
  }
  EXPECT_GT(compared, 4000);
}

// A deep scene's lists hold little more than what can be seen.
TEST(TileLists, DeepScenesAreCut) {
  const auto primitives = test::randomSpheres(60000, 1);
  const View view = test::viewOf(*primitives, {512, 512}, Projection::perspective);
  const TileTarget target = targetOf(*primitives, view);
  const QuadricSource source(*primitives, target);
  TileLists cut, whole;
  const Clusters clusters = clustersOf(*primitives);
  ASSERT_FALSE(clusters.list().empty());
  cut.build(source, clusters, target);
  whole.build(source, {}, target, false);
  EXPECT_LT(cut.entryCount() * 4, whole.entryCount());
  EXPECT_LT(cut.placedCount() * 4, whole.placedCount() * 3);
  const TileLists all = [&] {
    TileLists lists;
    lists.build(source, clusters, target, false);
    return lists;
  }();
  EXPECT_GE(all.entryCount(), whole.entryCount());
  EXPECT_LE(1000 * all.entryCount(), 1001 * whole.entryCount())
      << "bounds found by vectors are a little wider";
}

// Atoms of half a pixel, few of which hide a pixel by themselves.
TEST(TileLists, SmallAtomsHideTogether) {
  const auto primitives = test::randomSpheres(100000, 2);
  const View view = test::viewOf(*primitives, {54, 54}, Projection::perspective);
  const TileTarget target = targetOf(*primitives, view);
  const QuadricSource source(*primitives, target);
  const Occluder nearest = source.occluder(0);
  EXPECT_GT(nearest.radius, 0.3f);
  EXPECT_LT(nearest.radius, 0.8f);
  TileLists cut, whole;
  const Clusters clusters = clustersOf(*primitives);
  cut.build(source, clusters, target);
  whole.build(source, clusters, target, false);
  EXPECT_LT(cut.entryCount() * 2, whole.entryCount());
  expectSame(castByLists(*primitives, target), castByForce(*primitives, target), "lists and brute force");
}

// From afar, close by and from within: bounds of whole clusters against each ball's own.
TEST_P(Tiles, BallsOfClustersArePlacedAsEachAlone) {
  const auto primitives = test::randomSpheres(20500, 4);
  const Clusters clusters = clustersOf(*primitives);
  ASSERT_FALSE(clusters.list().empty());
  int seen = 0;
  for (const double fovY : {4e-5, 0.02, 0.5, 2.0}) {
    for (const std::string& set : instructionSets()) {
      useInstructionSet(set);
      const TileTarget target =
          targetOf(*primitives, test::viewOf(*primitives, {700, 500}, GetParam(), fovY));
      const QuadricSource source(*primitives, target);
      std::array<Placement, kClusterSize> found;
      for (const Cluster& cluster : clusters.list()) {
        const auto balls = clusters.balls().subspan(cluster.first, cluster.last - cluster.first);
        source.placeBalls(RigidMotion{}, cluster, balls, found.data());
        for (std::size_t i = 0; i < balls.size(); ++i) {
          const Placement alone = source.place(clusters.order()[cluster.first + i]);
          ASSERT_EQ(found[i].visible(), alone.visible());
          if (!alone.visible()) continue;
          ++seen;
          ASSERT_LE(found[i].x0, alone.x0);
          ASSERT_LE(found[i].y0, alone.y0);
          ASSERT_GE(found[i].x1, alone.x1);
          ASSERT_GE(found[i].y1, alone.y1);
          ASSERT_NEAR(found[i].front, alone.front, 1e-6f * (target.view.nearZ - target.view.farZ));
        }
      }
    }
  }
  EXPECT_GT(seen, 50000);
}

TEST(TileLists, EmptyScenesAndNonsenseAreNotDrawn) {
  Primitives primitives;
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, infinity, -1.0f, 0.0f}) primitives.spheres.push_back({{0, 0, 0}, bad, 0, 1});
  for (const float bad : {nan, infinity, -infinity}) {
    primitives.spheres.push_back({{bad, 0, 0}, 1, 0, 1});
    primitives.cylinders.push_back({{bad, 0, 0}, 1, {0, 1, 0}, 0, 0, 1, 1});
    primitives.ellipsoids.push_back({{0, bad, 0}, 1, {1, 0, 0}, {0, 1, 0}, 0, 1});
    primitives.ellipsoids.push_back({{0, 0, 0}, 1, {bad, 0, 0}, {0, 1, 0}, 0, 1});
  }
  primitives.cylinders.push_back({{0, 0, 0}, 1, {0, 0, 0}, 0, 0, 1, 1});
  View view;
  view.size = {64, 48};
  view.center = {32, 24};
  view.pixelSize = 0.02;
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    view.projection = projection;
    EXPECT_EQ(hitCount(castByLists(primitives, targetOf(primitives, view))), 0u);
  }
  EXPECT_EQ(hitCount(castByLists({}, targetOf({}, view))), 0u);
}

}  // namespace
}  // namespace meniscus::tiles

// Tile lists and the quadric caster: nothing that can be seen is missing from a list, and every instruction
// set, every way to cut a picture into areas and brute force give the same bits.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/tiles/instruction_sets.h"
#include "core/tiles/quadric_caster.h"
#include "core/tiles/quadric_tiles.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace meniscus::tiles {
namespace {

constexpr PlaneChannels kAll{true, true, true, true};

TileTarget targetOf(const Primitives& primitives, const View& view, glm::vec2 shift = {0, 0}) {
  return {view, primitives.origin, {0, 0, view.size.width, view.size.height}, shift};
}

// Planes of the whole area, background where there was nothing.
Planes spread(const Planes& part, const TileTarget& target) {
  Planes whole;
  whole.resize(target.area, kAll);
  const TileGrid grid(target.area);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column)
      clearTile(grid.x + column * kTileSize, grid.y + row * kTileSize, whole);
  }
  for (int y = 0; y < part.area.height; ++y) {
    for (int x = 0; x < part.area.width; ++x) {
      const auto from = static_cast<std::size_t>(y * part.area.width + x);
      const auto to = static_cast<std::size_t>((y + part.area.y - target.area.y) * target.area.width + x +
                                               part.area.x - target.area.x);
      whole.depth[to] = part.depth[from];
      whole.albedo[to] = part.albedo[from];
      whole.normal[to] = part.normal[from];
      whole.id[to] = part.id[from];
      whole.distance[to] = part.distance[from];
    }
  }
  return whole;
}

Planes castByLists(const Primitives& primitives, const TileTarget& target) {
  QuadricTiles caster;
  caster.setPrimitives(&primitives);
  Planes planes;
  caster.cast(target, kAll, planes);
  return spread(planes, target);
}

// Every tile's rays against every primitive.
Planes castByForce(const Primitives& primitives, const TileTarget& target) {
  const QuadricSource source(primitives, target);
  std::vector<QuadricRecord> records;
  for (std::size_t i = 0; i < source.size(); ++i) {
    if (source.place(i).visible()) source.record(i, records.emplace_back());
  }
  std::vector<std::uint32_t> list(records.size());
  std::iota(list.begin(), list.end(), 0u);
  Planes planes;
  planes.resize(target.area, kAll);
  const TileGrid grid(target.area);
  TileRays rays = makeRays(target, LaneOrder::rows);
  TilePixels pixels;
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const int x = grid.x + column * kTileSize, y = grid.y + row * kTileSize;
      moveRays(rays, target, x, y);
      castQuadrics(records, list, std::numeric_limits<float>::infinity(), rays, kAll, pixels);
      storeTile(pixels, x, y, planes);
    }
  }
  return planes;
}

void expectSame(const Planes& a, const Planes& b, const char* what) {
  std::size_t different = 0;
  ASSERT_EQ(a.depth.size(), b.depth.size());
  for (std::size_t i = 0; i < a.depth.size(); ++i) {
    different += a.depth[i] != b.depth[i] || a.id[i] != b.id[i] || a.albedo[i] != b.albedo[i] ||
                 a.normal[i] != b.normal[i] || a.distance[i] != b.distance[i];
  }
  EXPECT_EQ(different, 0u) << what;
}

std::size_t hitCount(const Planes& planes) {
  return static_cast<std::size_t>(
      std::count_if(planes.id.begin(), planes.id.end(), [](std::uint32_t id) { return id != 0; }));
}

Primitives allKinds(int count, unsigned seed) {
  Primitives all = *test::randomChain(count, seed);
  const auto ellipsoids = test::randomEllipsoids(count, seed + 1, 0.2);
  const auto spheres = test::randomSpheres(count, seed + 2);
  all.ellipsoids = ellipsoids->ellipsoids;
  all.spheres.insert(all.spheres.end(), spheres->spheres.begin(), spheres->spheres.end());
  std::uint32_t id = 0;
  for (SpherePrimitive& s : all.spheres) s.id = ++id;
  for (CylinderPrimitive& c : all.cylinders) {
    c.idA = ++id;
    c.idB = ++id;
  }
  for (EllipsoidPrimitive& e : all.ellipsoids) e.id = ++id;
  return all;
}

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
      const View view = test::viewOf(primitives, {157, 123}, GetParam(), fovY);
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
  const View view = test::viewOf(primitives, {96, 96}, GetParam());
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
        source.placeBalls(cluster, balls, found.data());
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

#pragma once
// Scenes cast from tile lists and by brute force, as planes of the whole picture.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "core/tiles/quadric_caster.h"
#include "core/tiles/quadric_tiles.h"
#include "tests/support/scenes.h"

namespace meniscus::tiles {

inline constexpr PlaneChannels kAll{true, true, true, true};

// Pictures that brute force casts, too: by 20 times as slow code under the sanitizers, where a ninth of the
// pixels says as much.
inline ImageSize sizeForForce(int width, int height) {
#ifdef MENISCUS_SANITIZED
  return {width / 3, height / 3};
#else
  return {width, height};
#endif
}

inline TileTarget targetOf(const Primitives& primitives, const View& view, glm::vec2 shift = {0, 0}) {
  return {view, primitives.origin, {0, 0, view.size.width, view.size.height}, shift};
}

inline View viewOfBounds(const Primitives& primitives, ImageSize size, Projection projection) {
  Camera camera;
  camera.projection = projection;
  camera.orientation = glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, -1)));
  const BoundingSphere bounds = primitives.bounds();
  return makeView(fitted(camera, size, std::vector<FitSphere>{{bounds.center, bounds.radius}}), size, bounds);
}

// Planes of the whole area, background where there was nothing.
inline Planes spread(const Planes& part, const TileTarget& target) {
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

inline Planes castByLists(const Primitives& primitives, const TileTarget& target) {
  QuadricTiles caster;
  caster.setPrimitives(&primitives);
  Planes planes;
  caster.cast(target, kAll, planes);
  return spread(planes, target);
}

// Every ray of every tile against every primitive.
inline Planes castByForce(const Primitives& primitives, const TileTarget& target) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  const QuadricSource source(primitives, target);
  std::vector<QuadricRecord> records;
  for (std::size_t i = 0; i < source.size(); ++i) {
    if (!source.place(i).visible()) continue;
    QuadricRecord& record = records.emplace_back();
    source.record(i, record);
    record.lowY = -kFar;
    record.highY = record.front = kFar;
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
      castQuadrics(records, list, kFar, rays, kAll, pixels);
      storeTile(pixels, x, y, planes);
    }
  }
  return planes;
}

inline void expectSame(const Planes& a, const Planes& b, const char* what) {
  std::size_t different = 0;
  ASSERT_EQ(a.depth.size(), b.depth.size());
  for (std::size_t i = 0; i < a.depth.size(); ++i) {
    different += a.depth[i] != b.depth[i] || a.id[i] != b.id[i] || a.albedo[i] != b.albedo[i] ||
                 a.normal[i] != b.normal[i] || a.distance[i] != b.distance[i];
  }
  EXPECT_EQ(different, 0u) << what;
}

inline std::size_t hitCount(const Planes& planes) {
  return static_cast<std::size_t>(
      std::count_if(planes.id.begin(), planes.id.end(), [](std::uint32_t id) { return id != 0; }));
}

inline Primitives allKinds(int count, unsigned seed) {
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

}  // namespace meniscus::tiles

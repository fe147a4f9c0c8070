// Tiles at extremes: cameras up to 1e5 Å away, scenes from thousandths to thousands of ångström, things far
// smaller than a pixel, against extended precision and the double-precision truth.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/hit_errors.h"
#include "core/reference_tracer.h"
#include "core/tiles/field_tiles.h"
#include "core/tiles/quadric_tiles.h"
#include "tests/support/exact_field.h"
#include "tests/support/scenes.h"

namespace meniscus::tiles {
namespace {

const glm::dvec3 kOrigin(-4, 17, 3);

template <typename Caster>
HitImage hitsOf(Caster& caster, const View& view, const glm::dvec3& origin) {
  const TileTarget target{view, origin, {0, 0, view.size.width, view.size.height}, {0, 0}};
  Planes planes;
  caster.cast(target, {false, false, true, true}, planes);
  HitImage image;
  image.size = view.size;
  const auto pixels = static_cast<std::size_t>(view.size.width * view.size.height);
  image.distance.assign(pixels, std::numeric_limits<float>::infinity());
  image.id.assign(pixels, 0);
  for (int y = 0; y < planes.area.height; ++y) {
    for (int x = 0; x < planes.area.width; ++x) {
      const auto from = static_cast<std::size_t>(y * planes.area.width + x);
      const auto to = static_cast<std::size_t>((y + planes.area.y) * view.size.width + x + planes.area.x);
      EXPECT_FALSE(std::isnan(planes.distance[from]) || std::isnan(planes.depth[from]));
      image.distance[to] = planes.distance[from];
      image.id[to] = planes.id[from];
    }
  }
  return image;
}

void expectExact(const Primitives& primitives, const View& view, double margin) {
  QuadricTiles caster;
  caster.setPrimitives(&primitives);
  const HitImage image = hitsOf(caster, view, primitives.origin);
  int compared = 0;
  for (int y = 0; y < view.size.height; ++y) {
    for (int x = 0; x < view.size.width; ++x) {
      const auto pixel = static_cast<std::size_t>(y * view.size.width + x);
      const test::ExactHit exact = test::exactHit(primitives, view, {x + 0.5, y + 0.5}, margin);
      if (exact.clearance < margin || exact.runnerUp - exact.distance < margin) continue;
      ASSERT_EQ(image.id[pixel], exact.id) << x << ' ' << y;
      if (exact.id != 0) {
        EXPECT_NEAR(static_cast<double>(image.distance[pixel]), exact.distance,
                    2e-7 * exact.distance + margin);
      }
      ++compared;
    }
  }
  EXPECT_GT(compared, view.size.width * view.size.height * 9 / 10);
}

TEST(TilesExtremes, QuadricsFromAfar) {
  const auto chain = test::randomChain(60, 3);
  const auto ellipsoids = test::randomEllipsoids(60, 4, 0.2);
  for (const double fovY : {2e-3, 2e-4, 4e-5}) {
    expectExact(*chain, test::viewOf(*chain, {50, 40}, Projection::perspective, fovY), 1e-4);
    expectExact(*ellipsoids, test::viewOf(*ellipsoids, {50, 40}, Projection::perspective, fovY), 1e-4);
  }
}

TEST(TilesExtremes, QuadricsFarSmallerThanAPixel) {
  Primitives primitives = *test::randomChain(40, 5);
  for (SpherePrimitive& s : primitives.spheres) s.radius = 1e-6f;
  for (CylinderPrimitive& c : primitives.cylinders) c.radius = 1e-6f;
  expectExact(primitives, test::viewOf(*test::randomChain(40, 5), {60, 50}), 1e-5);
}

TEST(TilesExtremes, SurfacesOfEveryScaleFromEveryDistance) {
  unsigned seed = 0;
  for (const double scale : {1e-3, 1.0, 1e3}) {
    for (const double far : {3.0, 1e3, 1e4}) {
      ++seed;
      MetaballField field = test::randomField({KernelShape::sextic}, 0.4, 40, 6, seed % 2 == 0 ? 4 : 0, seed);
      for (Metaball& ball : field.balls) {
        ball.center *= static_cast<float>(scale);
        ball.support *= static_cast<float>(scale);
      }
      Camera camera;
      camera.target = kOrigin;
      camera.distance = 15 * scale * far;
      camera.fovY = 2 * std::atan(1.0 / far);
      const View view = makeView(camera, {60, 50}, {kOrigin, 15 * scale});
      FieldTiles caster;
      caster.setField(&field);
      const HitErrors errors =
          compareHits(hitsOf(caster, view, kOrigin), traceReference(field, kOrigin, view));
      EXPECT_EQ(errors.missed, 0u) << scale << ' ' << far;
      EXPECT_EQ(errors.falseHits, 0u) << scale << ' ' << far;
      EXPECT_LE(errors.relativeRms, 1e-5) << scale << ' ' << far;
      EXPECT_EQ(caster.takeCounts().notConverged, 0u);
      EXPECT_GT(errors.compared, 100u);
    }
  }
}

// Balls far smaller than a pixel, and one in whose middle the camera stands.
TEST(TilesExtremes, SurfacesFarSmallerThanAPixelAndAroundTheCamera) {
  MetaballField dust = test::randomField({KernelShape::quartic}, 0.4, 60, 6, 0, 77);
  for (Metaball& ball : dust.balls) ball.support *= 1e-5f;
  FieldTiles caster;
  caster.setField(&dust);
  const View view = test::viewOfBall(Projection::perspective, {50, 40}, kOrigin, 12);
  const HitErrors errors = compareHits(hitsOf(caster, view, kOrigin), traceReference(dust, kOrigin, view));
  EXPECT_EQ(errors.missed + errors.falseHits, 0u);

  MetaballField around;
  around.level = 0.5;
  around.balls = {{{0, 0, 0}, 1000, 1, 0xFFFFFF, 1}, {{1, 1, 0}, 4, -2, 0xFFFFFF, 2}};
  FieldTiles within;
  within.setField(&around);
  Camera camera;
  camera.target = kOrigin;
  camera.distance = 1;
  camera.fovY = 2.5;
  const View inside = makeView(camera, {50, 40}, {kOrigin, 1000});
  const ReferenceImage truth = traceReference(around, kOrigin, inside);
  const HitErrors found = compareHits(hitsOf(within, inside, kOrigin), truth);
  EXPECT_EQ(found.missed + found.falseHits, 0u);
  EXPECT_GT(found.compared, 1900u);
  EXPECT_LE(found.relativeRms, 1e-5);
}

}  // namespace
}  // namespace meniscus::tiles

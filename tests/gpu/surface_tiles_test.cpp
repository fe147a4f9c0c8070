// The surface method "tiles" through the renderer, judged by the truth in the scenes that break methods.

#include <gtest/gtest.h>

#include <cmath>

#include "core/assembly.h"
#include "io/structure_reader.h"
#include "render/surface_method.h"
#include "tests/gpu/surface_judge.h"

namespace meniscus {
namespace {

const SurfaceSettings kTiles{"tiles", {}};
constexpr Projection kBoth[] = {Projection::perspective, Projection::orthographic};

class SurfaceTiles : public test::SurfaceTest {};

TEST_F(SurfaceTiles, RandomBalls) {
  const test::SurfaceScene scene = test::randomScene(1000, 1);
  for (const Projection projection : kBoth)
    expectExact(judge(scene, viewOf(scene, {160, 120}, projection), kTiles));
  EXPECT_EQ(stats.method.find("tiles ("), 0u);
  EXPECT_EQ(stats.notConverged, 0u);
}

TEST_F(SurfaceTiles, AMolecule) {
  Logger logger;
  StructureOptions read;
  read.waters = Waters::automatic;
  Molecule molecule = readStructure(MENISCUS_MOLECULES "/2hhb.pdb.gz", read, logger).models.front();
  SceneObject object;
  object.molecule = std::make_shared<const Molecule>(std::move(molecule));
  object.placements = placeOnce(*object.molecule);
  object.representation = Representation::surface;
  Scene all;
  all.objects = {object};
  test::SurfaceScene scene{std::make_shared<Primitives>(buildPrimitives(all))};
  expectExact(judge(scene, viewOf(scene, {96, 72}), kTiles));
}

TEST_F(SurfaceTiles, TwoHundredCoincidentBalls) {
  MetaballField field;
  for (unsigned i = 1; i <= 200; ++i) field.balls.push_back({{0.25f, -0.5f, 1}, 2.0f, 0.01f, 0x808080, i});
  const test::SurfaceScene scene(field);
  for (const Projection projection : kBoth)
    expectExact(judge(scene, viewOf(scene, {24, 18}, projection), kTiles));
}

// The surface lies behind hundreds of others that do not reach the level.
TEST_F(SurfaceTiles, AThousandBallsAlongOneRay) {
  MetaballField field;
  for (unsigned i = 0; i < 1000; ++i) {
    const float z = 60 - 0.12f * static_cast<float>(i);
    field.balls.push_back(
        {{0.01f * static_cast<float>(i % 7), 0, z}, 2.0f, i < 990 ? 0.005f : 1.0f, 0x808080, i + 1});
  }
  View view = test::alongZ(0, 0, 70);
  view.size = {12, 9};
  view.pixelSize = 0.4;
  view.center = {6, 4.5};
  expectExact(judge(test::SurfaceScene(field), view, kTiles));
}

// Thousands of events at exactly the same places.
TEST_F(SurfaceTiles, ALatticeSeenAlongAnAxis) {
  MetaballField field;
  for (unsigned i = 0; i < 512; ++i) {
    const glm::vec3 at(i % 8, i / 8 % 8, i / 64);
    field.balls.push_back({(at - 3.5f) * 1.5f, 2.5f, 0.4f, 0x808080, i + 1});
  }
  View view = test::alongZ(0, 0, 20);
  view.size = {64, 48};
  view.pixelSize = 0.375;  // every fourth ray meets a row of centres
  view.center = {32.5, 24.5};
  expectExact(judge(test::SurfaceScene(field), view, kTiles));
}

TEST_F(SurfaceTiles, LevelNearTheMaximum) {
  for (const double below : {1e-2, 1e-3, 1e-4}) {
    MetaballField field;
    field.level = 1 - below;
    field.balls.push_back({{3, 1, -2}, 2.0f, 1.0f, 0x808080, 1});
    const test::SurfaceScene scene(field);
    Camera camera;
    camera.target = {3, 1, -2};
    camera.distance = 10;
    camera.fovY = 0.6 * std::sqrt(below);  // what is left fills the picture
    SCOPED_TRACE(below);
    expectExact(judge(scene, makeView(camera, {64, 48}, scene.primitives->bounds()), kTiles));
  }
}

// Surfaces among themselves, and with quadrics however these are drawn.
TEST_F(SurfaceTiles, QuadricsAndSurfacesHideEachOther) {
  test::SurfaceScene scene = test::randomScene(60, 12);
  scene.primitives->surfaces.push_back(test::randomField({KernelShape::sextic}, 0.4, 40, 6, 0, 13));
  for (Metaball& ball : scene.primitives->surfaces[1].balls) ball.id += 60;
  const View view = viewOf(scene, {96, 72});
  const HitImage surfaces = draw(scene, view, kTiles);
  auto spheres = std::make_shared<Primitives>();
  spheres->origin = scene.primitives->origin;
  test::Random random(14);
  for (unsigned i = 0; i < 30; ++i)
    spheres->spheres.push_back(
        {glm::vec3(random.inBox(6)), static_cast<float>(random.uniform(0.5, 2)), 0xFFFFFF, 101 + i});
  scene.primitives->spheres = spheres->spheres;
  for (const QuadricMethod quadrics : {QuadricMethod::splat, QuadricMethod::tiles}) {
    const auto hits = [&](const std::shared_ptr<Primitives>& primitives) {
      Renderer renderer;
      renderer.setPrimitives(primitives);
      return renderer.renderHits(view, {.distance = true, .normal = false, .id = true}, kTiles, quadrics);
    };
    const HitImage alone = hits(spheres), both = hits(scene.primitives);
    int fromSpheres = 0, fromSurfaces = 0;
    for (std::size_t i = 0; i < both.id.size(); ++i) {
      const bool sphere = alone.distance[i] < surfaces.distance[i];
      if (std::abs(alone.distance[i] - surfaces.distance[i]) < 1e-4f) continue;
      EXPECT_EQ(both.id[i], sphere ? alone.id[i] : surfaces.id[i]);
      EXPECT_EQ(both.distance[i], sphere ? alone.distance[i] : surfaces.distance[i]);
      ++(sphere ? fromSpheres : fromSurfaces);
    }
    EXPECT_GT(fromSpheres, 100);
    EXPECT_GT(fromSurfaces, 100);
  }
}

TEST_F(SurfaceTiles, AnyTilesOfTheTargetGiveTheSameBytes) {
  const test::SurfaceScene scene = test::randomScene(150, 3);
  const View view = viewOf(scene, {90, 70});
  const HitImage whole = draw(scene, view, kTiles);
  RendererOptions small;
  small.maxTileSize = 33;
  Renderer renderer(small);
  renderer.setPrimitives(scene.primitives);
  const HitImage parts = renderer.renderHits(view, {}, kTiles);
  EXPECT_EQ(parts.id, whole.id);
  EXPECT_EQ(parts.distance, whole.distance);
  EXPECT_EQ(draw(scene, view, kTiles).distance, whole.distance) << "the same every time";
}

TEST_F(SurfaceTiles, AreWhatAutoTakes) {
  EXPECT_EQ(surfaceMethodFor({}).name, "tiles");
  const test::SurfaceScene scene = test::randomScene(30, 3);
  EXPECT_EQ(draw(scene, viewOf(scene, {40, 30}), {}).distance,
            draw(scene, viewOf(scene, {40, 30}), kTiles).distance);
}

}  // namespace
}  // namespace meniscus

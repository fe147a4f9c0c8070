// The surface as depth-peeled Bezier clipping draws it, against the truth: molecules, random scenes, scenes
// that break the paper's list.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "core/error.h"
#include "io/structure_reader.h"
#include "tests/gpu/surface_judge.h"
#include "tests/support/scenes.h"

namespace meniscus {
namespace {

using test::options;
using Parameters = std::map<std::string, double>;

class Bezier : public test::SurfaceTest {};

const Kernel kSextic{};
constexpr Projection kBoth[] = {Projection::perspective, Projection::orthographic};

// 1,000 balls of random radii (Kanamori et al. 2008, Figure 1).
TEST_F(Bezier, RandomBallsOfThePaper) {
  const test::SurfaceScene scene = test::randomScene(1000, 1);
  for (const Projection projection : kBoth)
    expectExact(judge(scene, viewOf(scene, {160, 120}, projection), options()));
}

TEST_F(Bezier, EveryMolecule) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(MENISCUS_MOLECULES))
    if (entry.path().extension() != ".md") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  EXPECT_GE(files.size(), 15u);
  for (const auto& file : files) {
    SCOPED_TRACE(file.filename().string());
    Logger logger;
    StructureOptions read;
    read.waters = Waters::automatic;
    Molecule molecule = readStructure(file, read, logger).models.front();
    SceneObject object;
    object.molecule = std::make_shared<const Molecule>(std::move(molecule));
    object.placements = placeOnce(*object.molecule);
    object.representation = Representation::surface;
    Scene all;
    all.objects = {object};
    test::SurfaceScene scene{std::make_shared<Primitives>(buildPrimitives(all))};
    expectExact(judge(scene, viewOf(scene, {96, 72}), options(), file.filename().string()));
  }
}

TEST_F(Bezier, EveryKernel) {
  for (const Kernel kernel :
       {Kernel{KernelShape::sextic}, Kernel{KernelShape::quartic}, Kernel{KernelShape::power, 2},
        Kernel{KernelShape::power, 3}, Kernel{KernelShape::power, 7}, Kernel{KernelShape::power, 16}}) {
    const std::string name =
        "kernel" + std::to_string(static_cast<int>(kernel.shape)) + "_" + std::to_string(kernel.exponent);
    SCOPED_TRACE(name);
    const test::SurfaceScene scene(test::randomField(kernel, 0.3, 60, 4, 0, 7));
    expectExact(judge(scene, viewOf(scene, {80, 60}), options(), name));
  }
}

TEST_F(Bezier, EveryOptionGivesTheSameSurface) {
  const test::SurfaceScene scene = test::randomScene(150, 3);
  const View view = viewOf(scene, {80, 60});
  for (const Parameters& parameters :
       {Parameters{{"culling", 0}}, Parameters{{"tiles", 0}}, Parameters{{"tiles", 17}},
        Parameters{{"clipping", 0}}, Parameters{{"list", 1}}, Parameters{{"list", 3}, {"tiles", 0}},
        Parameters{{"tolerance", 1e-3}}}) {
    SCOPED_TRACE(parameters.begin()->first);
    expectExact(judge(scene, view, options(parameters)));
  }
}

TEST_F(Bezier, ShortListsAreRepairedAndCounted) {
  const test::SurfaceScene scene = test::randomScene(150, 3);
  const View view = viewOf(scene, {80, 60});
  judge(scene, view, options({{"list", 4}}));
  EXPECT_GT(stats.overflow, 100u);
  EXPECT_GE(detail("repairs"), 1);
  const std::uint64_t pixels = stats.pixels;
  judge(scene, view, options());
  EXPECT_EQ(stats.overflow, 0u);
  EXPECT_EQ(stats.pixels, pixels) << "a pixel counts once, however often it is done";
  // The paper's way (§7) takes the ball that does not fit for the surface: too near, never a hole.
  const HitErrors paper = judge(scene, view, options({{"list", 4}, {"repair", 0}}));
  EXPECT_GT(paper.largestDistance, 0.1);
  EXPECT_EQ(paper.missed, 0u);
  EXPECT_GT(stats.overflow, 100u);
  EXPECT_EQ(detail("repairs"), 0);
}

// Figure 9 (a) and (b).
TEST_F(Bezier, TwoHundredCoincidentBalls) {
  MetaballField field;
  for (unsigned i = 1; i <= 200; ++i) field.balls.push_back({{0.25f, -0.5f, 1}, 2.0f, 0.01f, 0x808080, i});
  const test::SurfaceScene scene(field);
  for (const Projection projection : kBoth) {
    expectExact(judge(scene, viewOf(scene, {24, 18}, projection), options()));
    EXPECT_GT(stats.overflow, 50u);
    EXPECT_EQ(detail("longest list"), 200);
  }
}

// Figure 9 (c): the surface lies behind hundreds of others that do not reach the level.
TEST_F(Bezier, AThousandBallsAlongOneRay) {
  MetaballField field;
  for (unsigned i = 0; i < 1000; ++i) {
    const float z = 60 - 0.12f * static_cast<float>(i);
    const float q = i < 990 ? 0.005f : 1.0f;
    field.balls.push_back({{0.01f * static_cast<float>(i % 7), 0, z}, 2.0f, q, 0x808080, i + 1});
  }
  const test::SurfaceScene scene(field);
  View view = test::alongZ(0, 0, 70);
  view.size = {12, 9};
  view.pixelSize = 0.4;
  view.center = {6, 4.5};
  expectExact(judge(scene, view, options()));
  EXPECT_GT(detail("events peeled"), 1900.0);
}

// Thousands of events at exactly the same places.
TEST_F(Bezier, ALatticeSeenAlongAnAxis) {
  MetaballField field;
  for (unsigned i = 0; i < 512; ++i) {
    const glm::vec3 at(i % 8, i / 8 % 8, i / 64);
    field.balls.push_back({(at - 3.5f) * 1.5f, 2.5f, 0.4f, 0x808080, i + 1});
  }
  const test::SurfaceScene scene(field);
  View view = test::alongZ(0, 0, 20);
  view.size = {64, 48};
  view.pixelSize = 0.375;  // every fourth ray meets a row of centres
  view.center = {32.5, 24.5};
  expectExact(judge(scene, view, options()));
  expectExact(judge(scene, view, options({{"culling", 0}})));
  Camera camera;  // and perspective, down the same axis
  camera.distance = 40;
  camera.fovY = 0.5;
  expectExact(judge(scene, makeView(camera, {64, 48}, scene.primitives->bounds()), options()));
}

TEST_F(Bezier, NegativeBallsHollowTheSurface) {
  for (const Kernel kernel : {kSextic, Kernel{KernelShape::quartic}}) {
    const test::SurfaceScene scene(test::randomField(kernel, 0.3, 80, 4, 3, 11));
    for (const Projection projection : kBoth)
      expectExact(judge(scene, viewOf(scene, {80, 60}, projection), options()));
    EXPECT_EQ(detail("balls left after culling"), detail("balls in view")) << "cores hide nothing";
  }
  // A cavity in a ball, seen from within it.
  MetaballField cavity;
  cavity.balls = {{{0, 0, 0}, 6.0f, 1.0f, 0xFF0000, 1}, {{0.5f, 0, 0}, 2.0f, -2.0f, 0x00FF00, 2}};
  const test::SurfaceScene scene(cavity);
  Camera camera;
  camera.target = {0.5, 0, 0};
  camera.distance = 0.3;
  camera.fovY = 1.5;
  const HitErrors errors = judge(scene, makeView(camera, {64, 48}, scene.primitives->bounds()), options());
  expectExact(errors);
  EXPECT_EQ(errors.compared + errors.grazing, 64u * 48u);
}

TEST_F(Bezier, CameraInsideBallsAndInsideTheSurface) {
  const test::SurfaceScene scene = test::randomScene(200, 5);
  test::Random random(9);
  for (int i = 0; i < 6; ++i) {
    Camera camera;
    camera.projection = i == 5 ? Projection::orthographic : Projection::perspective;
    camera.target = scene.primitives->origin + random.inBox(4);
    camera.orientation = random.rotation();
    camera.distance = i == 0 ? 1e-3 : random.uniform(0.1, 9);
    camera.fovY = random.uniform(0.5, 1.6);
    View view = makeView(camera, {64, 48}, scene.primitives->bounds());
    if (i >= 4) view.nearZ = random.uniform(-3, 3);  // cut open by the near plane
    view.farZ = std::min(view.farZ, view.nearZ - 1);
    SCOPED_TRACE(i);
    expectExact(judge(scene, view, options(), "inside" + std::to_string(i)));
  }
}

// A scene in which spheres and two surfaces hide each other.
TEST_F(Bezier, SpheresAndSurfacesHideEachOther) {
  test::SurfaceScene scene = test::randomScene(60, 12);
  scene.primitives->surfaces.push_back(test::randomField(kSextic, 0.4, 40, 6, 0, 13));
  for (Metaball& ball : scene.primitives->surfaces[1].balls) ball.id += 60;
  const View view = viewOf(scene, {96, 72});
  const HitImage surfaces = draw(scene, view, options());
  auto spheres = std::make_shared<Primitives>();
  spheres->origin = scene.primitives->origin;
  test::Random random(14);
  for (unsigned i = 0; i < 30; ++i)
    spheres->spheres.push_back(
        {glm::vec3(random.inBox(6)), static_cast<float>(random.uniform(0.5, 2)), 0xFFFFFF, 101 + i});
  const HitImage alone = draw({spheres}, view, options());
  scene.primitives->spheres = spheres->spheres;
  const HitImage both = draw(scene, view, options());
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
  // What lies behind quadrics need not be drawn.
  EXPECT_LT(detail("balls left after culling"), detail("balls in view"));
}

TEST_F(Bezier, AnyTilesOfTheTargetGiveTheSameBytes) {
  const test::SurfaceScene scene = test::randomScene(150, 3);
  const View view = viewOf(scene, {90, 70});
  const HitImage whole = draw(scene, view, options());
  RendererOptions small;
  small.maxTileSize = 33;
  Renderer renderer(small);
  renderer.setPrimitives(scene.primitives);
  const HitImage parts = renderer.renderHits(view, {}, options());
  EXPECT_EQ(parts.id, whole.id);
  EXPECT_EQ(parts.distance, whole.distance);
  EXPECT_EQ(draw(scene, view, options()).distance, whole.distance) << "the same every time";
}

TEST_F(Bezier, RefusesNumbersThatAreNotFinite) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    test::SurfaceScene scene = test::randomScene(10, 1);
    const View view = viewOf(scene, {16, 12});
    scene.primitives->surfaces[0].balls[3].center.y = bad;
    EXPECT_THROW(draw(scene, view, options()), InputError);
    scene = test::randomScene(10, 1);
    scene.primitives->surfaces[0].balls[3].support = bad;
    EXPECT_THROW(draw(scene, view, options()), InputError);
  }
}

TEST_F(Bezier, UnknownOptionsAreNamed) {
  const test::SurfaceScene scene = test::randomScene(10, 1);
  EXPECT_THROW(draw(scene, viewOf(scene, {16, 12}), options({{"lists", 3}})), UsageError);
  EXPECT_THROW(draw(scene, viewOf(scene, {16, 12}), options({{"list", 0}})), UsageError);
  EXPECT_THROW(draw(scene, viewOf(scene, {16, 12}), options({{"repair", 0.5}})), UsageError);
}

}  // namespace
}  // namespace meniscus

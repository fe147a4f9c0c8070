// Secondary rays against closed forms: solids, mirrors, glass, occlusion.

#include "core/traced_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <thread>

#include "core/bvh/view_ray.h"
#include "core/environment_map.h"
#include "core/generated_scenes.h"
#include "core/hit_errors.h"
#include "core/quadric_tracer.h"
#include "core/srgb.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace meniscus {
namespace {

using bvh::RayScratch;
using bvh::SceneHit;
using bvh::SceneRay;
using bvh::SceneTracer;
using bvh::Side;
using bvh::TraceCounts;

// What a scene's rays meet, in the same form as the truth.
HitImage castAll(const SceneTracer& scene, const View& view) {
  const bvh::ViewRays rays(view, scene.primitives().origin);
  RayScratch scratch;
  TraceCounts counts;
  HitImage image;
  image.size = view.size;
  for (int y = 0; y < view.size.height; ++y) {
    for (int x = 0; x < view.size.width; ++x) {
      const auto ray = rays.through({x + 0.5, y + 0.5});
      const SceneHit hit = scene.cast({ray.origin, ray.direction, ray.start}, scratch, counts);
      const bool away = glm::dot(hit.normal, ray.direction) > 0;
      image.distance.push_back(static_cast<float>(hit.distance));
      image.normal.push_back(glm::vec3(rays.toView(away ? -hit.normal : hit.normal)));
      image.id.push_back(hit.id);
    }
  }
  return image;
}

TEST(SceneTracer, SolidsAndSurfacesAreMetWhereTheTruthSays) {
  for (const StabilityRecipe& recipe : stabilityRecipes()) {
    if (recipe.name != "needles" && recipe.name != "long-cylinders" && recipe.name != "end-on" &&
        recipe.name != "cylinder-1e4" && recipe.name != "plain")
      continue;
    SCOPED_TRACE(recipe.name);
    const StabilityScene scene = recipe.make(1, {40, 30});
    const HitErrors e =
        compareHits(castAll(SceneTracer(scene.surface), scene.view), traceScene(*scene.surface, scene.view));
    EXPECT_EQ(e.missed + e.falseHits, 0u);
    EXPECT_GT(e.compared, 20u);
    EXPECT_LE(e.relativeRms, 1e-6);
    EXPECT_LE(e.normalRmsDeg, 0.01);
  }
  for (const auto& primitives : {test::randomChain(200, 3), test::randomEllipsoids(200, 4, 0.3)}) {
    const View view = test::viewOf(*primitives, {80, 60});
    const HitErrors e = compareHits(castAll(SceneTracer(primitives), view), traceQuadrics(*primitives, view));
    EXPECT_EQ(e.missed + e.falseHits, 0u);
    EXPECT_GT(e.compared, 500u);
    EXPECT_LE(e.relativeRms, 1e-6);
    EXPECT_EQ(e.idsDiffer, 0u);
  }
}

// Any blocker will do, and is found sooner than the nearest.
TEST(SceneTracer, WhatIsBlockedHasADistance) {
  for (const auto& primitives : {test::randomChain(200, 3), test::randomEllipsoids(200, 4, 0.3)}) {
    const SceneTracer scene(primitives);
    test::Random random(5);
    RayScratch scratch;
    TraceCounts any, nearest;
    int blocked = 0, free = 0;
    for (int i = 0; i < 2000; ++i) {
      const SceneRay ray{random.inBox(10), random.direction(), 0, i % 2 == 0 ? bvh::kInfinity : 3.0};
      const bool hides = scene.blocked(ray, true, scratch, any);
      EXPECT_EQ(hides, scene.distance(ray, true, scratch, nearest) < bvh::kInfinity);
      ++(hides ? blocked : free);
    }
    EXPECT_GT(blocked, 200);
    EXPECT_GT(free, 200);
    EXPECT_LT(any.nodes, nearest.nodes);
  }
}

// A square in the plane y = 0, seen and lit from above.
void addFloor(Primitives& primitives, float half) {
  for (const glm::vec2 corner : {glm::vec2(-1, -1), glm::vec2(-1, 1), glm::vec2(1, 1), glm::vec2(1, -1)})
    primitives.mesh.vertices.push_back({{half * corner.x, 0, half * corner.y}, {0, 1, 0}});
  primitives.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  primitives.mesh.surfaces = {{0xFFFFFF, 90}, {0xFFFFFF, 91}};
}

View fromAbove(const Primitives& primitives, ImageSize size) {
  Camera camera;
  camera.projection = Projection::orthographic;
  camera.orientation = glm::angleAxis(1.5707963267948966, glm::dvec3(1, 0, 0));
  camera.target = primitives.origin;
  return makeView(camera, size, primitives.bounds());
}

// The sphere is wholly above the horizon of each point of the plane it lies on, so it hides of the sky, by
// the cosine, (r / D)^2 cos(angle), where D is the distance of its centre: (r / D)^3.
TEST(TracedLight, ASphereOnAPlaneHidesWhatTheClosedFormSays) {
  auto primitives = std::make_shared<Primitives>();
  addFloor(*primitives, 30);
  primitives->spheres.push_back({{0, 2, 0}, 2, 0xFF0000, 1});
  const View view = fromAbove(*primitives, {64, 48});
  const SceneTracer scene(primitives);
  TracedLightSettings settings;
  settings.trace.occlusion = 4096;
  settings.occlusion.radius = 0;
  TracedPlanes planes;
  TraceCounts counts;
  traceLight(scene, {view, 0, 0, 64, 48}, settings, planes, counts);
  const bvh::ViewRays rays(view, primitives->origin);
  RayScratch scratch;
  double worst = 0;
  int compared = 0;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      const auto ray = rays.through({x + 0.5, y + 0.5});
      const SceneHit hit = scene.cast({ray.origin, ray.direction, ray.start}, scratch, counts);
      if (hit.id < 90) continue;
      const double d2 = glm::dot(hit.point, hit.point) + 4;
      const double truth = 8 / (d2 * std::sqrt(d2));
      const std::uint32_t stored = planes.occlusion[static_cast<std::size_t>(y * 64 + x)];
      EXPECT_EQ(stored >> 16, 65535u);
      worst = std::max(worst, std::abs((stored & 65535u) / 65535.0 - truth));
      ++compared;
    }
  }
  EXPECT_GT(compared, 1000);
  EXPECT_LT(worst, 4e-3);
}

TEST(TracedLight, PartsOfAPicturesRaysAddUpToAllOfThem) {
  auto primitives = std::make_shared<Primitives>();
  addFloor(*primitives, 30);
  primitives->spheres.push_back({{0, 2, 0}, 2, 0xFF0000, 1});
  const View view = fromAbove(*primitives, {16, 12});
  const SceneTracer scene(primitives);
  TracedLightSettings settings;
  settings.trace.occlusion = 256;
  TracedPlanes whole, part;
  TraceCounts counts;
  traceLight(scene, {view, 0, 0, 16, 12}, settings, whole, counts);
  std::vector<double> sums(whole.occlusion.size());
  for (int sample = 0; sample < 4; ++sample) {
    traceLight(scene, {view, 0, 0, 16, 12, {0, 0}, sample, 4}, settings, part, counts);
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += (part.occlusion[i] & 65535u) / 4.0;
  }
  for (std::size_t i = 0; i < sums.size(); ++i) EXPECT_NEAR(sums[i], whole.occlusion[i] & 65535u, 1.5);
  // A part of the picture is the same as that part of the whole.
  traceLight(scene, {view, 5, 3, 8, 7}, settings, part, counts);
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 8; ++x)
      EXPECT_EQ(part.occlusion[static_cast<std::size_t>(y * 8 + x)],
                whole.occlusion[static_cast<std::size_t>((y + 3) * 16 + x + 5)]);
}

TEST(TracedLight, FresnelAndSnell) {
  for (const double index : {1.0, 1.33, 1.5, 2.4}) {
    const double straight = (index - 1) * (index - 1) / ((index + 1) * (index + 1));
    EXPECT_NEAR(fresnel(1, 1 / index), straight, 1e-15);
    EXPECT_NEAR(fresnel(1, index), straight, 1e-15);
    EXPECT_NEAR(fresnel(1e-9, 1 / index), index > 1 ? 1 : 0, 1e-7);
    for (double angle = 0.05; angle < 1.55; angle += 0.1) {
      const glm::dvec3 normal(0, 1, 0), in(std::sin(angle), -std::cos(angle), 0);
      const auto out = refracted(in, normal, 1 / index);
      ASSERT_TRUE(out);
      EXPECT_NEAR(index * out->x, in.x, 1e-14);
      EXPECT_NEAR(glm::length(*out), 1, 1e-14);
      // The way back loses the same share.
      EXPECT_NEAR(fresnel(-out->y, index), fresnel(std::cos(angle), 1 / index), 1e-12);
      if (index * in.x > 1) {
        EXPECT_EQ(fresnel(std::cos(angle), index), 1);
        EXPECT_FALSE(refracted(in, normal, index));
      }
    }
    // At Brewster's angle half of the light, by polarization, is not mirrored at all.
    const double brewster = std::atan(index), inside = std::asin(std::sin(brewster) / index);
    const double across = std::sin(brewster - inside) / std::sin(brewster + inside);
    EXPECT_NEAR(fresnel(std::cos(brewster), 1 / index), across * across / 2, 1e-14);
  }
}

// One ball as a surface, and the radius that it has.
struct Ball {
  std::shared_ptr<Primitives> primitives = std::make_shared<Primitives>();
  glm::dvec3 center{1, -2, 3};
  double radius;
  Ball() {
    primitives->surfaces.resize(1);
    MetaballField& field = primitives->surfaces[0];
    field.balls = {{glm::vec3(center), 4, 1, 0x808080, 1}};
    radius = 4 * coreShare(field.kernel, field.level, 1);
  }
  View view() const { return test::viewOf(*primitives, {32, 32}); }
};

TracedLightSettings glassOf(double index, int reflect, int refract) {
  TracedLightSettings settings;
  settings.trace.index = index;
  settings.trace.reflect = reflect;
  settings.trace.refract = refract;
  return settings;
}

TEST(TracedLight, AGlassBallBendsRaysAsGeometrySays) {
  const Ball ball;
  const View view = ball.view();
  const SceneTracer scene(ball.primitives);
  const double index = 1.5;
  const TracedLightSettings settings = glassOf(index, 0, 2);
  const LightTracer tracer(scene, view, settings);
  const auto sky = [&](const glm::dvec3& d) { return skyLight(view.rotation * d); };
  RayScratch scratch;
  TraceCounts counts;
  test::Random random(5);
  for (int i = 0; i < 2000; ++i) {
    const glm::dvec3 eye = ball.center + 12.0 * random.direction();
    const glm::dvec3 aim = ball.center + ball.radius * 0.98 * random.direction();
    const glm::dvec3 d = glm::normalize(aim - eye);
    const glm::dvec3 light = tracer.radiance({eye, d}, scratch, counts);

    const double along = glm::dot(ball.center - eye, d);
    const glm::dvec3 aside = eye + along * d - ball.center;
    const glm::dvec3 in = eye + (along - std::sqrt(ball.radius * ball.radius - glm::dot(aside, aside))) * d;
    const glm::dvec3 n1 = (in - ball.center) / ball.radius;
    const double c1 = -glm::dot(d, n1), f1 = fresnel(c1, 1 / index);
    const glm::dvec3 within = *refracted(d, n1, 1 / index);
    const glm::dvec3 out = in - 2 * glm::dot(within, in - ball.center) * within;
    const glm::dvec3 n2 = (ball.center - out) / ball.radius;
    const double c2 = -glm::dot(within, n2), f2 = fresnel(c2, index);
    const glm::dvec3 expected =
        f1 * sky(d + 2 * c1 * n1) +
        (1 - f1) * (f2 * sky(within + 2 * c2 * n2) + (1 - f2) * sky(*refracted(within, n2, index)));
    for (int k = 0; k < 3; ++k) ASSERT_NEAR(light[k], expected[k], 1e-6) << i;
  }
}

TEST(TracedLight, AMirrorBallShowsTheSkyBehindTheViewer) {
  const Ball ball;
  const View view = ball.view();
  const SceneTracer scene(ball.primitives);
  const LightTracer tracer(scene, view, glassOf(3, 1, 0));
  RayScratch scratch;
  TraceCounts counts;
  const glm::dvec3 d = glm::normalize(ball.center + glm::dvec3(0.4, 0.9, 0) - glm::dvec3(1, -2, 20));
  const SceneHit hit = scene.cast({{1, -2, 20}, d}, scratch, counts);
  ASSERT_TRUE(hit);
  const glm::dvec4 light = tracer.surfaceLight(hit, d, scratch, counts);
  const glm::dvec3 n = glm::normalize(hit.point - ball.center);
  const double f = fresnel(-glm::dot(d, n), 1.0 / 3);
  const glm::dvec3 expected = f * skyLight(view.rotation * (d - 2 * glm::dot(d, n) * n));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(light[k], expected[k], 1e-7);
  EXPECT_NEAR(light.w, 1 - f, 1e-7);
}

// Light that meets the wall from within beyond the critical angle stays in the ball, at the same angle for
// ever; the last direction's sky is what is seen.
TEST(TracedLight, TotalReflectionKeepsLightWithin) {
  const Ball ball;
  const View view = ball.view();
  const SceneTracer scene(ball.primitives);
  const double index = 1.5;
  RayScratch scratch;
  TraceCounts counts;
  test::Random random(8);
  for (const int walls : {1, 2, 7}) {
    const LightTracer tracer(scene, view, glassOf(index, 0, walls));
    for (int i = 0; i < 200; ++i) {
      const glm::dvec3 n = random.direction(), start = ball.center + ball.radius * n;
      const glm::dvec3 side = glm::normalize(glm::cross(n, random.direction()));
      const double sine = random.uniform(1.001 / index, 0.98);
      glm::dvec3 d = sine * side - std::sqrt(1 - sine * sine) * n, at = start;
      const glm::dvec3 light =
          tracer.radiance({start, d, 0, bvh::kInfinity, {bvh::kNoSolid, 0, Side::inside}}, scratch, counts);
      for (int k = 0; k < walls + 1; ++k) {
        at -= 2 * glm::dot(d, at - ball.center) * d;
        const glm::dvec3 wall = (at - ball.center) / ball.radius;
        if (k < walls + 1) d -= 2 * glm::dot(d, wall) * wall;
      }
      const glm::dvec3 sky = skyLight(view.rotation * d);
      for (int k = 0; k < 3; ++k) ASSERT_NEAR(light[k], sky[k], 1e-5) << walls;
    }
  }
}

template <typename Visit>
void forEachRay(const View& view, const Primitives& primitives, const Visit& visit) {
  const bvh::ViewRays rays(view, primitives.origin);
  for (int y = 0; y < view.size.height; ++y) {
    for (int x = 0; x < view.size.width; ++x) {
      const auto ray = rays.through({x + 0.5, y + 0.5});
      visit(SceneRay{ray.origin, ray.direction, ray.start});
    }
  }
}

// Wherever light of strength 1 comes from all around, that is what glass shows, however many walls, and
// nothing is ever brighter than what there is.
TEST(TracedLight, GlassNeitherMakesNorLosesLight) {
  const auto primitives = packedBalls(60, 7);
  const View view = viewOfAll(*primitives, {24, 18});
  const SceneTracer scene(primitives);
  RayScratch scratch;
  TraceCounts counts;
  for (const auto& [reflect, refract] : {std::pair{0, 1}, std::pair{2, 3}, std::pair{4, 16}}) {
    TracedLightSettings white = glassOf(1.5, reflect, refract);
    white.trace.environment = Environment::background;
    white.background.color = 0xFFFFFF;
    const TracedLightSettings sky = glassOf(1.5, reflect, refract);
    const LightTracer inWhite(scene, view, white), inSky(scene, view, sky);
    forEachRay(view, *primitives, [&](const SceneRay& ray) {
      const glm::dvec3 light = inWhite.radiance(ray, scratch, counts);
      EXPECT_NEAR(light.x, 1, 1e-12);
      EXPECT_NEAR(light.z, 1, 1e-12);
      const glm::dvec3 blue = inSky.radiance(ray, scratch, counts);
      EXPECT_LE(std::max({blue.x, blue.y, blue.z}), 0.96 + 1e-12);
      EXPECT_GE(std::min({blue.x, blue.y, blue.z}), 0.16 - 1e-12);
    });
  }
}

// Of support 4.
std::shared_ptr<Primitives> oneBall(const glm::vec3& center) {
  auto primitives = std::make_shared<Primitives>();
  MetaballField field;
  field.level = 0.25;
  field.balls.push_back({center, 4.0f, 1.0f, 0x808080, 1});
  primitives->surfaces.push_back(field);
  return primitives;
}

// A constant light from all around is that light, through mirrors and glass.
TEST(TracedLight, AConstantPictureOfTheSurroundingsGivesTheConstant) {
  const auto primitives = packedBalls(60, 7);
  const View view = viewOfAll(*primitives, {24, 18});
  const SceneTracer scene(primitives);
  RayScratch scratch;
  TraceCounts counts;
  TracedLightSettings settings = glassOf(1.5, 4, 16);
  settings.trace.environment = Environment::map;
  settings.trace.environmentMap =
      std::make_shared<const EnvironmentMap>(6, 3, std::vector<glm::vec3>(18, {2, 0.5f, 0.125f}));
  const LightTracer tracer(scene, view, settings);
  forEachRay(view, *primitives, [&](const SceneRay& ray) {
    const glm::dvec3 light = tracer.radiance(ray, scratch, counts);
    EXPECT_NEAR(light.x, 2, 1e-11);
    EXPECT_NEAR(light.y, 0.5, 1e-11);
    EXPECT_NEAR(light.z, 0.125, 1e-11);
  });
}

// Red from the left, blue from the right, green from above: a ball mirrors each on its side, from whichever
// side it is looked at.
TEST(TracedLight, AMirrorShowsTheSidesOfThePicture) {
  const auto primitives = oneBall({0, 0, 0});
  std::vector<glm::vec3> texels;
  for (int row = 0; row < 64; ++row)
    for (int column = 0; column < 128; ++column)
      texels.emplace_back(column < 64 ? 1 : 0, row < 32 ? 1 : 0, column < 64 ? 0 : 1);
  TracedLightSettings settings;
  settings.trace.reflect = 1;
  settings.trace.environment = Environment::map;
  settings.trace.environmentMap = std::make_shared<const EnvironmentMap>(128, 64, texels);
  for (const double turn : {0.0, 2.0}) {
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.orientation = glm::angleAxis(turn, glm::normalize(glm::dvec3(1, 2, 3)));
    camera.distance = 12;
    const View view = makeView(camera, {40, 30}, primitives->bounds());
    const SceneTracer scene(primitives);
    const LightTracer tracer(scene, view, settings);
    const bvh::ViewRays rays(view, primitives->origin);
    RayScratch scratch;
    TraceCounts counts;
    int seen = 0;
    for (int y = 0; y < 30; ++y) {
      for (int x = 0; x < 40; ++x) {
        const auto ray = rays.through({x + 0.5, y + 0.5});
        const SceneHit hit = scene.cast({ray.origin, ray.direction, ray.start}, scratch, counts);
        if (!hit) continue;
        const glm::dvec3 to = rays.toView(glm::reflect(ray.direction, hit.normal));
        if (std::abs(to.x) < 0.2 || std::abs(to.y) < 0.2) continue;
        const glm::dvec4 light = tracer.surfaceLight(hit, ray.direction, scratch, counts);
        const double mirrored = 1 - light.w;
        EXPECT_NEAR(light.x, to.x < 0 ? mirrored : 0, 1e-12);
        EXPECT_NEAR(light.y, to.y > 0 ? mirrored : 0, 1e-12);
        EXPECT_NEAR(light.z, to.x > 0 ? mirrored : 0, 1e-12);
        EXPECT_EQ(to.x > 0, x >= 20) << "a ball shows what is to the right on its right side";
        ++seen;
      }
    }
    EXPECT_GT(seen, 200);
  }
}

// Without refraction light goes straight through a ball of glass: what is left is that of the chord, which
// the closed form knows (Bouguer, Lambert, Beer).
TEST(TracedLight, GlassAbsorbsByTheWayThroughIt) {
  const auto primitives = oneBall({0.5, -1, 2});
  const MetaballField& field = primitives->surfaces[0];
  const double radius = 4 * coreShare(field.kernel, field.level, 1);
  const SceneTracer scene(primitives);
  TracedLightSettings settings = glassOf(1, 0, 2);
  settings.trace.attenuationColor = 0xFF8000;
  settings.trace.attenuationDistance = 3;
  settings.trace.environment = Environment::background;
  settings.background.color = 0xFFFFFF;
  const LightTracer tracer(scene, viewOfAll(*primitives, {8, 8}), settings);
  const double green = linearFromSrgb(128 / 255.0);
  RayScratch scratch;
  TraceCounts counts;
  test::Random random(3);
  int through = 0;
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 direction = random.direction();
    const glm::dvec3 middle = glm::dvec3(0.5, -1, 2) + random.inBox(radius);
    const glm::dvec3 to = glm::dvec3(0.5, -1, 2) - (middle - 10.0 * direction);
    const double off2 = glm::dot(to, to) - glm::dot(to, direction) * glm::dot(to, direction);
    const double chord = 2 * std::sqrt(std::max(radius * radius - off2, 0.0));
    if (chord > 0 && chord < 0.05) continue;
    const glm::dvec3 light =
        tracer.radiance({middle - 10.0 * direction, direction, 0, bvh::kInfinity, {}}, scratch, counts);
    EXPECT_NEAR(light.x, 1, 1e-12);
    EXPECT_NEAR(light.y, std::pow(green, chord / 3), 1e-6);
    EXPECT_NEAR(light.z, std::pow(1e-12, chord / 3), 1e-6);
    through += chord > 0 ? 1 : 0;
  }
  EXPECT_GT(through, 200);
}

// Of whatever shape: at the same colour, half the distance leaves the square.
TEST(TracedLight, HalfTheAttenuationDistanceLeavesTheSquare) {
  const auto primitives = packedBalls(30, 7);
  const View view = viewOfAll(*primitives, {16, 12});
  const SceneTracer scene(primitives);
  const bvh::ViewRays rays(view, primitives->origin);
  RayScratch scratch;
  TraceCounts counts;
  TracedLightSettings once = glassOf(1, 0, 16), twice = once, clear = once;
  once.trace.attenuationColor = twice.trace.attenuationColor = 0x40C0FF;
  once.trace.attenuationDistance = 4;
  twice.trace.attenuationDistance = 8;
  for (TracedLightSettings* settings : {&once, &twice, &clear}) {
    settings->trace.environment = Environment::background;
    settings->background.color = 0xFFFFFF;
  }
  const LightTracer dark(scene, view, once), bright(scene, view, twice), none(scene, view, clear);
  int darkened = 0;
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 16; ++x) {
      const auto ray = rays.through({x + 0.5, y + 0.5});
      const SceneRay at{ray.origin, ray.direction, ray.start};
      const glm::dvec3 a = dark.radiance(at, scratch, counts), b = bright.radiance(at, scratch, counts);
      EXPECT_NEAR(a.x, b.x * b.x, 1e-9);
      EXPECT_NEAR(a.y, b.y * b.y, 1e-9);
      EXPECT_EQ(none.radiance(at, scratch, counts), glm::dvec3(1));
      darkened += a.x < 0.9 ? 1 : 0;
    }
  }
  EXPECT_GT(darkened, 30);
}

// Whoever no longer wants the picture says so between bands of rows.
TEST(TracedLight, IsEndedByItsWatch) {
  const auto primitives = test::randomSpheres(200, 3);
  const View view = test::viewOf(*primitives, {32, 64});
  const SceneTracer scene(primitives);
  TracedLightSettings settings;
  settings.trace.occlusion = 1;
  TracedPlanes whole, part;
  TraceCounts counts;
  int looks = 0;
  const auto caller = std::this_thread::get_id();
  traceLight(scene, {view, 0, 0, 32, 64}, settings, whole, counts, [&] {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    ++looks;
  });
  EXPECT_GE(looks, 4);
  struct Ended {};
  const auto endAtHalf = [&, left = looks / 2]() mutable {
    if (left-- == 0) throw Ended{};
  };
  EXPECT_THROW(traceLight(scene, {view, 0, 0, 32, 64}, settings, part, counts, endAtHalf), Ended);
  ASSERT_EQ(part.occlusion.size(), whole.occlusion.size());
  const auto middle = static_cast<std::ptrdiff_t>(whole.occlusion.size() / 2);
  EXPECT_TRUE(std::equal(part.occlusion.begin(), part.occlusion.begin() + middle, whole.occlusion.begin()));
  EXPECT_TRUE(std::all_of(part.occlusion.begin() + middle, part.occlusion.end(),
                          [](std::uint32_t v) { return v == 0; }));
  EXPECT_TRUE(std::any_of(whole.occlusion.begin() + middle, whole.occlusion.end(),
                          [](std::uint32_t v) { return v != 0; }));
}

// Nothing convex hides itself, from any of its points: no acne.
TEST(TracedLight, ConvexThingsDoNotShadowThemselves) {
  auto primitives = std::make_shared<Primitives>();
  primitives->spheres = {{{-20, 0, 0}, 3, 0xFFFFFF, 1}};
  primitives->cylinders = {{{-8, -3, 0}, 2, {-8, 3, 1}, 0xFFFFFF, 0xFFFFFF, 2, 3}};
  primitives->ellipsoids = {{{4, 0, 0}, 1, {3, 0, 0}, {0, 2, 0}, 0xFFFFFF, 4}};
  primitives->surfaces.resize(1);
  primitives->surfaces[0].balls = {{{18, 0, 0}, 6, 1, 0xFFFFFF, 5}};
  const View view = test::viewOf(*primitives, {200, 60});
  TracedLightSettings settings;
  settings.trace.shadows = 1;
  settings.trace.occlusion = 16;
  settings.occlusion.radius = 5;
  settings.shadows.mode = ShadowMode::hard;
  TracedPlanes planes;
  TraceCounts counts;
  traceLight(SceneTracer(primitives), {view, 0, 0, 200, 60}, settings, planes, counts);
  int lit = 0, seen = 0;
  for (std::size_t i = 0; i < planes.visibility.size(); ++i) {
    EXPECT_EQ(planes.occlusion[i] & 65535u, 0u);
    EXPECT_TRUE(planes.visibility[i] == 0 || planes.visibility[i] == 65535);
    lit += planes.visibility[i] > 0 ? 1 : 0;
    seen += planes.occlusion[i] > 0 ? 1 : 0;
  }
  EXPECT_GT(seen, 1000);
  EXPECT_GT(lit, seen / 2);  // and what does not is turned away from the light
}

}  // namespace
}  // namespace meniscus

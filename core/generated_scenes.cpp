#include "core/generated_scenes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>
#include <utility>

#include "core/camera_fit.h"
#include "core/random.h"
#include "core/reference_tracer.h"

namespace meniscus {

namespace {

constexpr std::uint32_t kColors[] = {0x4E79A7, 0xF28E2B, 0xE15759, 0x76B7B2, 0x59A14F, 0xEDC948, 0xB07AA1};
const glm::dquat kOblique = glm::normalize(glm::dquat(0.8, 0.2, -0.5, 0.2));

/// Collects the balls of a field.
class FieldBuilder {
 public:
  explicit FieldBuilder(double level = 0.5, Kernel kernel = {}) {
    field_.level = level;
    field_.kernel = kernel;
  }
  void add(const glm::dvec3& center, double support, double coefficient = 1) {
    const auto id = static_cast<std::uint32_t>(field_.balls.size() + 1);
    field_.balls.push_back({glm::vec3(center), static_cast<float>(support), static_cast<float>(coefficient),
                            kColors[id % std::size(kColors)], id});
  }
  MetaballField take() { return std::move(field_); }

 private:
  MetaballField field_;
};

std::shared_ptr<Primitives> sceneOf(MetaballField field, const glm::dvec3& origin = glm::dvec3(0.0)) {
  auto primitives = std::make_shared<Primitives>();
  primitives->origin = origin;
  primitives->surfaces.push_back(std::move(field));
  return primitives;
}

// The balls as spheres; one that never reaches the level by itself is shown by its support.
std::shared_ptr<Primitives> asQuadrics(const Primitives& primitives) {
  auto out = std::make_shared<Primitives>(primitives);
  out->surfaces.clear();
  for (const MetaballField& field : primitives.surfaces) {
    for (const Metaball& ball : field.balls) {
      const double share =
          coreShare(field.kernel, field.level, std::abs(static_cast<double>(ball.coefficient)));
      const double radius = static_cast<double>(ball.support) * (share > 0 ? share : 1);
      out->spheres.push_back({ball.center, static_cast<float>(radius), ball.color, ball.id});
    }
  }
  return out;
}

StabilityScene finished(std::shared_ptr<Primitives> surface, const View& view, double detail) {
  StabilityScene scene;
  scene.quadrics = asQuadrics(*surface);
  scene.surface = std::move(surface);
  scene.view = view;
  scene.detail = detail;
  return scene;
}

StabilityScene seenWhole(std::shared_ptr<Primitives> surface, ImageSize size, double detail) {
  const View view = viewOfAll(*surface, size);
  return finished(std::move(surface), view, detail);
}

StabilityScene plain(std::uint64_t seed, ImageSize size) {
  return seenWhole(packedBalls(200, seed), size, 1);
}

template <int kCount>
StabilityScene coincident(std::uint64_t seed, ImageSize size) {
  Random random(seed);
  FieldBuilder field;
  const glm::dvec3 place = random.inBox(1);
  for (int i = 0; i < kCount; ++i) field.add(place, 3);
  field.add(place + glm::dvec3(3.5, 0, 0), 3);
  return seenWhole(sceneOf(field.take()), size, 1);
}

StabilityScene latticeAlongAxis(std::uint64_t, ImageSize size) {
  FieldBuilder field;
  for (int z = -4; z <= 4; ++z)
    for (int y = -4; y <= 4; ++y)
      for (int x = -4; x <= 4; ++x) field.add(2.0 * glm::dvec3(x, y, z), 2.5);
  auto primitives = sceneOf(field.take());
  const View view = viewOfAll(*primitives, size, 0.5, Projection::orthographic, {1, 0, 0, 0});
  return finished(std::move(primitives), view, 1);
}

StabilityScene nearTangent(std::uint64_t seed, ImageSize size) {
  Random random(seed);
  FieldBuilder field;
  glm::dvec3 place(0.0);
  double last = 2;
  for (int i = 0; i < 60; ++i) {
    const double support = random.uniform(1.5, 3);
    if (i > 0)
      place += random.direction() * (last + support) * (1 + random.signedLog(1e-8, 1e-5)) *
               (glm::length(place) > 12 ? -1.0 : 1.0);
    field.add(place, support);
    last = support;
  }
  return seenWhole(sceneOf(field.take()), size, 1);
}

StabilityScene exactBridge(std::uint64_t, ImageSize size) {
  // At the middle each of the two gives half the level: a saddle on the surface.
  const Kernel kernel;
  const double support = 3, level = 0.5, half = support * std::sqrt(1 - kernelInverse(kernel, level / 2));
  FieldBuilder field(level, kernel);
  field.add({-half, 0, 0}, support);
  field.add({half, 0, 0}, support);
  auto primitives = sceneOf(field.take());
  const View view = viewOfAll(*primitives, size, 0.5, Projection::perspective, {1, 0, 0, 0});
  return finished(std::move(primitives), view, 1);
}

StabilityScene supportRatio(std::uint64_t seed, ImageSize size) {
  Random random(seed);
  const Kernel kernel;
  const double large = 1000, small = 1e-3, core = large * coreShare(kernel, 0.5, 1);
  FieldBuilder field(0.5, kernel);
  const glm::dvec3 top(0, 0, core);
  field.add(-top, large);  // its surface passes the origin
  for (int i = 0; i < 40; ++i) field.add(0.004 * random.inBox(1), small);
  auto primitives = sceneOf(field.take());
  Camera camera;
  camera.orientation = rotatedBy({1, 0, 0, 0}, {35, 0, 0});
  camera.distance = 0.02;
  const View view = makeView(camera, size, primitives->bounds());
  return finished(std::move(primitives), view, small);
}

StabilityScene steepPower(std::uint64_t seed, ImageSize size) {
  Random random(seed);
  const Kernel kernel{KernelShape::power, 16};
  const double share = 1.05;  // the support beyond the radius
  FieldBuilder field(levelOfBlend(kernel, share), kernel);
  for (int i = 0; i < 80; ++i) field.add(7.0 * random.inBox(1), share * random.uniform(1.2, 1.9));
  return seenWhole(sceneOf(field.take()), size, 1);
}

StabilityScene power16(std::uint64_t seed, ImageSize size) {
  auto primitives = packedBalls(150, seed);
  primitives->surfaces[0].kernel = {KernelShape::power, 16};
  primitives->surfaces[0].level = levelOfBlend(primitives->surfaces[0].kernel, 2);
  return seenWhole(std::move(primitives), size, 1);
}

StabilityScene lowLevel(std::uint64_t seed, ImageSize size) {
  auto primitives = packedBalls(150, seed);
  primitives->surfaces[0].level = 1e-12;
  return seenWhole(std::move(primitives), size, 1);
}

// A lone ball reaches 1 in its centre only; what is left is a thousandth of its support.
StabilityScene highLevel(std::uint64_t seed, ImageSize size) {
  Random random(seed);
  const double level = 1 - 1e-6, support = 3;
  FieldBuilder field(level);
  field.add(glm::dvec3(0.0), support);
  for (int i = 0; i < 20; ++i) field.add(random.direction() * random.uniform(3.1, 12), support);
  auto primitives = sceneOf(field.take());
  const double core = support * coreShare({}, level, 1);
  Camera camera;
  camera.orientation = kOblique;
  camera.distance = 6 * core;
  const View view = makeView(camera, size, primitives->bounds());
  return finished(std::move(primitives), view, core);
}

StabilityScene cancelling(std::uint64_t seed, ImageSize size) {
  Random random(seed);
  FieldBuilder field;
  for (int i = 0; i < 30; ++i) {
    const glm::dvec3 place = 5.0 * random.inBox(1);
    field.add(place, 3, 10000);
    field.add(place, 3, -9999);
  }
  return seenWhole(sceneOf(field.take()), size, 1);
}

StabilityScene farFromOrigin(std::uint64_t seed, ImageSize size) {
  auto primitives = packedBalls(200, seed);
  primitives->origin = {1e6, -1e6, 1e6};
  return seenWhole(std::move(primitives), size, 1);
}

// The eye in front of the surface by `away`, on the way to the scene's middle.
StabilityScene closeUp(std::uint64_t seed, ImageSize size) {
  constexpr double kAway = 1e-3;
  auto primitives = packedBalls(200, seed);
  const BoundingSphere bounds = primitives->bounds();
  Camera camera;
  camera.orientation = kOblique;
  camera.target = bounds.center;
  camera.distance = 3 * bounds.radius;
  const double far =
      traceReference(primitives->surfaces, primitives->origin, makeView(camera, {1, 1}, bounds), {})
          .distance[0];
  if (std::isfinite(far)) camera.distance -= far - kAway;
  return finished(primitives, makeView(camera, size, bounds), kAway);
}

StabilityScene farEye(std::uint64_t seed, ImageSize size) {
  auto primitives = packedBalls(200, seed);
  const BoundingSphere bounds = primitives->bounds();
  Camera camera;
  camera.orientation = kOblique;
  camera.target = bounds.center;
  camera.distance = 1e5;
  camera.fovY = 2 * std::atan(1.1 * bounds.radius / camera.distance);
  return finished(primitives, makeView(camera, size, bounds), 1);
}

StabilityScene narrowView(std::uint64_t seed, ImageSize size) {
  auto primitives = packedBalls(200, seed);
  const View view = viewOfAll(*primitives, size, glm::radians(1.0));
  return finished(std::move(primitives), view, 1);
}

// From between the outer balls: from outside, so wide a view makes them a dot in the middle.
StabilityScene wideView(std::uint64_t seed, ImageSize size) {
  auto primitives = packedBalls(200, seed);
  const BoundingSphere bounds = primitives->bounds();
  Camera camera;
  camera.orientation = kOblique;
  camera.target = bounds.center;
  camera.distance = 0.8 * bounds.radius;
  camera.fovY = glm::radians(170.0);
  return finished(primitives, makeView(camera, size, bounds), 1);
}

StabilityScene insideOut(std::uint64_t seed, ImageSize size) {
  auto primitives = packedBalls(200, seed);
  const BoundingSphere bounds = primitives->bounds();
  Camera camera;
  camera.orientation = kOblique;
  camera.target = bounds.center;
  camera.distance = 1e-3;
  camera.fovY = 1.5;
  return finished(primitives, makeView(camera, size, bounds), 0.1);
}

StabilityScene subPixel(std::uint64_t seed, ImageSize size) {
  return seenWhole(packedBalls(200'000, seed), size, 1);
}

// A few metaballs in the middle, for quadrics to run through.
std::shared_ptr<Primitives> cluster(std::uint64_t seed, double extent) {
  auto primitives = packedBalls(20, seed);
  for (Metaball& ball : primitives->surfaces[0].balls) {
    ball.center *= static_cast<float>(extent);
    ball.support *= static_cast<float>(extent);
  }
  return primitives;
}

StabilityScene needles(std::uint64_t seed, ImageSize size) {
  Random random(seed);
  auto primitives = cluster(seed, 1);
  for (int i = 0; i < 40; ++i) {
    const glm::dmat3 turn = glm::mat3_cast(random.rotation());
    const double length = random.uniform(5, 10);
    primitives->ellipsoids.push_back({glm::vec3(5.0 * random.inBox(1)), static_cast<float>(length * 1e-4),
                                      glm::vec3(turn[0] * length), glm::vec3(turn[1] * length * 0.1),
                                      kColors[static_cast<std::size_t>(i) % std::size(kColors)],
                                      static_cast<std::uint32_t>(100 + i)});
  }
  return seenWhole(std::move(primitives), size, 0.1);
}

StabilityScene shortCylinders(std::uint64_t seed, ImageSize size) {
  Random random(seed);
  auto primitives = cluster(seed, 1);
  for (std::uint32_t i = 0; i < 40; ++i) {
    const glm::dvec3 place = 6.0 * random.inBox(1) * 0.01, axis = random.direction();
    const glm::dvec3 end = place + 1e-6 * axis;
    primitives->cylinders.push_back(
        {glm::vec3(place), 0.02f, glm::vec3(end), kColors[1], kColors[2], 100 + i, 200 + i});
  }
  for (Metaball& ball : primitives->surfaces[0].balls) {
    ball.center *= 0.01f;
    ball.support *= 0.01f;
  }
  return seenWhole(std::move(primitives), size, 0.01);
}

StabilityScene longCylinders(std::uint64_t seed, ImageSize size) {
  Random random(seed);
  auto primitives = cluster(seed, 1);
  for (std::uint32_t i = 0; i < 40; ++i) {
    const glm::dvec3 place = 8.0 * random.inBox(1), axis = random.direction();
    primitives->cylinders.push_back({glm::vec3(place - 5e3 * axis), 0.2f, glm::vec3(place + 5e3 * axis),
                                     kColors[1], kColors[2], 100 + i, 200 + i});
  }
  Camera camera;
  camera.orientation = kOblique;
  camera.distance = 40;
  const View view = makeView(camera, size, primitives->bounds());
  return finished(std::move(primitives), view, 0.2);
}

StabilityScene endOn(std::uint64_t seed, ImageSize size) {
  auto primitives = cluster(seed, 1);
  for (int y = -3; y <= 3; ++y) {
    for (int x = -3; x <= 3; ++x) {
      const auto i = static_cast<std::uint32_t>((y + 3) * 7 + x + 3);
      const glm::vec3 place(2.2f * static_cast<float>(x), 2.2f * static_cast<float>(y), 0);
      primitives->cylinders.push_back({place - glm::vec3(0, 0, 8), 0.5f, place + glm::vec3(0, 0, 8),
                                       kColors[1], kColors[2], 100 + i, 200 + i});
    }
  }
  const View view = viewOfAll(*primitives, size, 0.5, Projection::orthographic, {1, 0, 0, 0});
  return finished(std::move(primitives), view, 0.2);
}

StabilityScene notFinite(std::uint64_t seed, ImageSize size) {
  auto primitives = packedBalls(50, seed);
  const View view = viewOfAll(*primitives, size);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  primitives->surfaces[0].balls[7].center.x = kNan;
  primitives->surfaces[0].balls[8].support = kInfinite;
  return finished(std::move(primitives), view, 1);
}

constexpr StabilityRecipe kRecipes[] = {
    {"plain", "nothing: 200 packed balls, to compare the others with", plain},
    {"coincident-2", "two balls in one place: entries and exits at the same distance", coincident<2>},
    {"coincident-10", "ten balls in one place", coincident<10>},
    {"coincident-100", "a hundred balls in one place: lists as long as that", coincident<100>},
    {"coincident-1000", "a thousand balls in one place: fixed list lengths, sums of many terms",
     coincident<1000>},
    {"lattice-axis", "an even lattice seen along its axis: every ray meets ties of entries and exits",
     latticeAlongAxis},
    {"tangent-supports", "supports that touch within 1e-8 to 1e-5: intervals of almost no length",
     nearTangent},
    {"exact-bridge", "two balls whose surfaces just meet: a saddle on the surface, double roots",
     exactBridge},
    {"support-ratio-1e6", "supports of 1e-3 and 1e3 Å in one scene: absolute tolerances, float32 of sums",
     supportRatio},
    {"power-16", "the kernel w^16: polynomials of degree 32", power16},
    {"steep-field", "the kernel w^16 with supports 5 % above the radius: a level of 1e-17", steepPower},
    {"level-low", "a level of 1e-12: the surface is where the field starts, with slope 0", lowLevel},
    {"level-high", "a level a millionth below the most a ball reaches: cores of a thousandth of the support",
     highLevel},
    {"cancelling", "coefficients of 10,000 and -9,999 in each place: four digits lost in every sum",
     cancelling},
    {"shifted-1e6", "a molecule a million Å from the origin: float32 there has steps of 1/16 Å",
     farFromOrigin},
    {"eye-1e-3", "the eye 0.001 Å in front of the surface: near plane, roots beside the start", closeUp},
    {"eye-1e5", "the eye 100,000 Å away: distances whose float32 steps are 0.008 Å", farEye},
    {"inside", "the eye in the middle of the molecule: the inner wall counts", insideOut},
    {"fov-1", "a field of view of 1 degree: rays that are almost parallel", narrowView},
    {"fov-170", "a field of view of 170 degrees: the tangent is 11, rays that almost lie in the picture",
     wideView},
    {"sub-pixel", "200,000 balls, smaller than a pixel: long lists, everything is an edge", subPixel},
    {"needles", "ellipsoids of 10,000 : 1 through a surface", needles},
    {"cylinder-1e-6", "cylinders of a millionth Å: the axis is rounding only", shortCylinders},
    {"cylinder-1e4", "cylinders of 10,000 Å: ends behind the eye, bounds far larger than the picture",
     longCylinders},
    {"end-on", "bonds along the line of sight: the side is never met", endOn},
    {"not-finite", "a centre that is not a number, a support that is infinite: must be refused", notFinite},
};

}  // namespace

std::shared_ptr<Primitives> packedBalls(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  const Kernel kernel;
  constexpr double kBlend = 2;
  // A protein has one atom besides hydrogen in about 20 Å^3 (Matthews 1968).
  const double extent = std::cbrt(static_cast<double>(count) * 20.0 * 3 / (4 * 3.14159265358979));
  FieldBuilder field(levelOfBlend(kernel, kBlend), kernel);
  for (std::size_t i = 0; i < count;) {
    const glm::dvec3 place = random.inBox(1);
    const double radius = random.uniform(1.2, 1.9);
    if (glm::length(place) > 1) continue;
    field.add(extent * place, kBlend * radius);
    ++i;
  }
  return sceneOf(field.take(), {12.5, -7.25, 100.125});
}

View viewOfAll(const Primitives& primitives, ImageSize size, double fovY, Projection projection,
               const glm::dquat& orientation) {
  const BoundingSphere bounds = primitives.bounds();
  const std::vector<FitSphere> whole{{bounds.center, bounds.radius}};
  Camera camera;
  camera.projection = projection;
  camera.fovY = fovY;
  camera.orientation = glm::normalize(orientation);
  return makeView(fitted(camera, size, whole), size, bounds);
}

std::span<const StabilityRecipe> stabilityRecipes() {
  return kRecipes;
}

}  // namespace meniscus

// Ambient occlusion against casting many rays in double precision, and against closed forms.

#include "render/post/occlusion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/occlusion_maps.h"
#include "render/renderer.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/occlusion_truth.h"
#include "tests/support/scenes.h"

namespace meniscus {
namespace {

using test::ambientOnly;
using test::whiten;

RenderSettings withOcclusion(double radius, int directions = 64, int samples = 1) {
  RenderSettings settings = test::withSamples(samples);
  settings.occlusion.on = true;
  settings.occlusion.radius = radius;
  settings.occlusion.directions = directions;
  return settings;
}

// Of the pixel (x, y), y from below.
double at(const std::vector<float>& picture, const View& view, int x, int y) {
  const int row = view.size.height - 1 - y;
  return static_cast<double>(picture[4 * static_cast<std::size_t>(row * view.size.width + x)]);
}

class Occlusion : public test::GlTest {
 protected:
  static std::vector<float> draw(Renderer& renderer, const View& view, const RenderSettings& settings) {
    return test::drawFloats(renderer, view, ambientOnly(), settings);
  }
};

// Measured: 0.05 to 0.07, of which most is the number of directions; a wrong sign, axis or slab gives 0.2.
TEST_F(Occlusion, AgreesWithRaysInDoublePrecision) {
  const auto scene = test::randomSpheres(600, 3);
  whiten(*scene);
  Renderer renderer;
  renderer.setPrimitives(scene);
  const View view = test::viewOf(*scene, {240, 240});
  for (const double radius : {0.0, 10.0, 30.0}) {
    const std::vector<test::OcclusionPlace> some =
        test::occlusionPlaces(renderer, *scene, view, radius, 300, 40);
    ASSERT_EQ(some.size(), 300u);
    for (const int samples : {1, 2, 4, 8}) {
      const std::vector<float> picture = draw(renderer, view, withOcclusion(radius, 64, samples));
      const test::Deviation d = test::deviationFrom(some, test::valuesAt(some, picture, view));
      EXPECT_LT(d.rms, 0.08) << "radius " << radius << ", samples " << samples;
      EXPECT_LT(std::abs(d.mean), 0.035) << "radius " << radius << ", samples " << samples;
    }
  }
}

// A ball over a convex surface hides (radius / distance)^2 cos(angle) of the sky if all of it is above the
// horizon.
TEST_F(Occlusion, AgreesWithTheClosedFormOfABallOverASurface) {
  auto scene = std::make_shared<Primitives>();
  scene->spheres = {{{0, 0, 0}, 30, 0xFFFFFF, 1}, {{0, 0, 34}, 3, 0xFFFFFF, 2}};
  Renderer renderer;
  renderer.setPrimitives(scene);
  Camera camera;
  camera.target = {0, 0, 30};
  camera.distance = 60;
  camera.orientation = rotatedBy({1, 0, 0, 0}, {35, 0, 0});
  const View view = makeView(camera, {200, 200}, scene->bounds());
  const HitImage hits = renderer.renderHits(view, {.distance = true, .normal = true, .id = true});
  const glm::dmat3 toWorld = glm::transpose(view.rotation);
  for (const int directions : {64, 128}) {
    const std::vector<float> picture = draw(renderer, view, withOcclusion(0, directions));
    double sum = 0, largest = 0;
    int count = 0;
    for (int y = 0; y < 200; ++y) {
      for (int x = 0; x < 200; ++x) {
        const auto i = static_cast<std::size_t>(y * 200 + x);
        if (hits.id[i] != 1) continue;
        const Ray ray = rayThrough(view, {x + 0.5, y + 0.5});
        const glm::dvec3 point =
            toWorld * (ray.origin + static_cast<double>(hits.distance[i]) * ray.direction) + view.pivot;
        const glm::dvec3 toBall = glm::dvec3(0, 0, 34) - point;
        const double height = glm::dot(toBall, glm::normalize(point)), distance = glm::length(toBall);
        if (height < 3) continue;
        const double error = at(picture, view, x, y) - (1 - 9 * height / (distance * distance * distance));
        sum += error * error;
        largest = std::max(largest, std::abs(error));
        ++count;
      }
    }
    EXPECT_GT(count, 1500);
    EXPECT_LT(std::sqrt(sum / count), directions == 64 ? 0.05 : 0.03) << directions;
    EXPECT_LT(largest, directions == 64 ? 0.15 : 0.1) << directions;
  }
}

// Nothing occludes itself if it is convex: no acne, whatever the scale, from any side.
TEST_F(Occlusion, ConvexThingsAreFullyLit) {
  for (const double size : {1e-2, 1.0, 30.0, 1e5}) {
    const auto f = static_cast<float>(size);
    for (const int kind : {0, 1, 2}) {
      auto scene = std::make_shared<Primitives>();
      scene->origin = {100, -20, 3};
      if (kind == 0) scene->spheres = {{{0, 0, 0}, f, 0xFFFFFF, 1}};
      if (kind == 1) scene->cylinders = {{{-f, 0, 0}, 0.3f * f, {f, 0, 0}, 0xFFFFFF, 0xFFFFFF, 1, 1}};
      if (kind == 2) {
        scene->ellipsoids = {
            {{0, 0, 0}, 0.4f * f, {0.6f * f, 0.8f * f, 0}, {-0.64f * f, 0.48f * f, 0}, 0xFFFFFF, 1}};
      }
      Renderer renderer;
      renderer.setPrimitives(scene);
      Camera camera;
      camera.target = scene->origin;
      camera.orientation = rotatedBy({1, 0, 0, 0}, {33, 50, 9});
      camera.distance = 6 * size;
      for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
        camera.projection = projection;
        const std::vector<float> picture =
            draw(renderer, makeView(camera, {90, 70}, scene->bounds()), withOcclusion(0));
        int surface = 0;
        for (std::size_t i = 0; i < picture.size(); i += 4) {
          if (picture[i + 3] == 0) continue;
          ++surface;
          ASSERT_NEAR(picture[i], 1.0f, 1e-4f) << size << " " << kind;
        }
        EXPECT_GT(surface, 400);
      }
    }
  }
}

TEST_F(Occlusion, WhatIsBeyondTheRadiusDoesNotCount) {
  auto scene = std::make_shared<Primitives>();
  scene->spheres = {{{0, 0, 0}, 2, 0xFFFFFF, 1}, {{30, 0, 0}, 10, 0xFFFFFF, 2}};
  Renderer renderer;
  renderer.setPrimitives(scene);
  const View view = test::viewOf(*scene, {120, 80});
  const auto least = [&](double radius) {
    float value = 1;
    const std::vector<float> picture = draw(renderer, view, withOcclusion(radius));
    for (std::size_t i = 0; i < picture.size(); i += 4) {
      if (picture[i + 3] > 0) value = std::min(value, picture[i]);
    }
    return value;
  };
  EXPECT_FLOAT_EQ(least(15), 1);
  EXPECT_LT(least(100), 0.97f);
  EXPECT_LT(least(0), 0.97f);
}

TEST_F(Occlusion, StrengthScalesItAndZeroIsOff) {
  const auto scene = test::randomChain(60, 5);
  Renderer renderer;
  renderer.setPrimitives(scene);
  const View view = test::viewOf(*scene, {80, 60});
  RenderSettings settings = withOcclusion(10);
  const std::vector<float> full = draw(renderer, view, settings),
                           off = draw(renderer, view, test::withSamples(1));
  settings.occlusion.strength = 0.5;
  const std::vector<float> half = draw(renderer, view, settings);
  settings.occlusion.strength = 0;
  EXPECT_EQ(draw(renderer, view, settings), off);
  for (std::size_t i = 0; i < off.size(); ++i) ASSERT_NEAR(half[i], 0.5f * (full[i] + off[i]), 1e-5f);
}

TEST_F(Occlusion, IsTheSameInTilesAndAgain) {
  const auto scene = test::randomChain(80, 3);
  Renderer whole, tiled(RendererOptions{.shaderDir = {}, .timePasses = false, .maxTileSize = 37});
  whole.setPrimitives(scene);
  tiled.setPrimitives(scene);
  const View view = test::viewOf(*scene, {100, 75});
  for (const int samples : {1, 2, 4, 5, 8}) {
    const std::vector<float> picture = draw(whole, view, withOcclusion(10, 64, samples));
    EXPECT_EQ(picture, draw(tiled, view, withOcclusion(10, 64, samples)));
    EXPECT_EQ(picture, draw(whole, view, withOcclusion(10, 64, samples)));
  }
}

TEST_F(Occlusion, IsAPassATextureAndAProgramOnlyWhereItIsOn) {
  const auto scene = test::randomSpheres(20, 3);
  Renderer renderer(test::effectsBy(false));
  renderer.setPrimitives(scene);
  const View view = test::viewOf(*scene, {1, 1});
  draw(renderer, view, test::withSamples(1, QuadricMethod::splat));
  const RenderStats off = renderer.stats();
  RenderSettings settings = withOcclusion(10);
  settings.quadrics = QuadricMethod::splat;
  draw(renderer, view, settings);
  const RenderStats on = renderer.stats();
  const auto has = [](const auto& list) {
    return std::any_of(list.begin(), list.end(), [](const auto& e) { return e.name == "occlusion"; });
  };
  EXPECT_FALSE(has(off.passes) || has(off.textures));
  EXPECT_EQ(off.buffers.size(), 1u);
  EXPECT_TRUE(has(on.passes) && has(on.textures));
  ASSERT_EQ(on.buffers.size(), 2u);
  EXPECT_LE(on.buffers[1].bytes, 65536u) << "maps of a picture of one pixel are small";
  EXPECT_EQ(on.programs.size(), off.programs.size() + 5)
      << "dividing the depth, looking, gathering across and up, and shade with it";
  EXPECT_EQ(on.textures.size(), off.textures.size() + 4) << "depth and sums of the parts, of rows, of pixels";
}

TEST_F(Occlusion, ExtremesGiveNumbers) {
  auto scene = test::randomChain(40, 6);
  scene->spheres.push_back({{0, 0, 0}, 1e-20f, 0xFFFFFF, 1000});
  scene->cylinders.push_back({{0, 0, 0}, 1e-20f, {1, 0, 0}, 1, 1, 1001, 1001});
  for (const float scale : {1e-3f, 1.0f, 1e4f}) {
    auto scaled = std::make_shared<Primitives>(*scene);
    for (SpherePrimitive& s : scaled->spheres) s = {s.center * scale, s.radius * scale, s.color, s.id};
    for (CylinderPrimitive& c : scaled->cylinders) c.a *= scale, c.b *= scale, c.radius *= scale;
    Renderer renderer;
    renderer.setPrimitives(scaled);
    Camera camera;
    camera.target = scaled->origin;
    for (const double distance : {1e-3, 1.0, 1e5}) {
      camera.distance = distance;
      for (const ImageSize size : {ImageSize{1, 1}, ImageSize{40, 30}}) {
        for (const double radius : {0.0, 1e-3, 1e6}) {
          for (const float value :
               draw(renderer, makeView(camera, size, scaled->bounds()), withOcclusion(radius, 16)))
            ASSERT_TRUE(std::isfinite(value) && value >= 0 && value <= 1.0001f) << scale << " " << distance;
        }
      }
    }
  }
  Renderer empty;
  for (const float value : draw(empty, makeView(Camera{}, {3, 2}, {}), withOcclusion(10)))
    EXPECT_EQ(value, 0);
}

// Whether neighbours divide the directions, and how.
TEST(OcclusionShare, EveryDirectionIsUsedByOneSampleOrAnother) {
  for (const int directions : {8, 16, 24, 32, 64, 72, 128}) {
    for (const int samples : {1, 2, 3, 4, 5, 8, 16, 256}) {
      const OcclusionShare share = occlusionShare(directions, samples);
      EXPECT_EQ(directions % share.directions, 0) << directions << " " << samples;
      EXPECT_EQ(share.directions % (4 * share.parts), 0) << directions << " " << samples;
      EXPECT_EQ(16 % share.parts, 0);
      EXPECT_GE(share.directions, 8);
      if (std::has_single_bit(static_cast<unsigned>(samples * directions))) {
        EXPECT_GE(samples * share.directions, directions) << samples;
      }
      if (samples >= 8) {
        EXPECT_EQ(share.parts, 1);
      }
    }
  }
  EXPECT_EQ(occlusionShare(64, 1).parts, 16);
}

TEST(OcclusionDirections, BlocksOfEightAreSpreadOverTheSphere) {
  const std::vector<glm::dvec3> directions = occlusionDirections(128);
  for (std::size_t first = 0; first < directions.size(); first += 8) {
    glm::dvec3 sum(0);
    int up = 0;
    for (std::size_t i = first; i < first + 8; ++i) {
      EXPECT_NEAR(glm::length(directions[i]), 1, 1e-12);
      sum += directions[i];
      up += directions[i].z > 0;
    }
    EXPECT_EQ(up, 4) << first;
    EXPECT_LT(glm::length(sum) / 8, 0.3) << first;
  }
}

}  // namespace
}  // namespace meniscus

// Pictures with layers, read back from OpenEXR through OpenImageIO: names, types, values, tiles, and what is
// not computed because nobody asked.

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/image_writer.h"
#include "render/renderer.h"
#include "tests/support/exact_rays.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/process.h"
#include "tests/support/scenes.h"

namespace meniscus {
namespace {

constexpr ImageSize kSize{90, 70};
constexpr Layers kAll{
    .color = true, .albedo = true, .normal = true, .depth = true, .distance = true, .id = true};
constexpr Layers kData{
    .color = false, .albedo = true, .normal = true, .depth = true, .distance = true, .id = true};

struct ReadBack {
  OIIO::ImageSpec spec;
  std::vector<float> pixels;
  int channel(const std::string& name) const { return spec.channelindex(name); }
  /// y from the bottom, as HitImage.
  float at(int x, int y, const std::string& name) const {
    const int row = spec.height - 1 - y;
    return pixels[static_cast<std::size_t>((row * spec.width + x) * spec.nchannels + channel(name))];
  }
};

class LayersTest : public test::GlTest {
 protected:
  ReadBack draw(Renderer& renderer, const View& view, const Layers& layers, int samples = 1,
                const Background& background = {}) const {
    return draw(renderer, view, layers, test::withSamples(samples), background);
  }
  ReadBack draw(Renderer& renderer, const View& view, const Layers& layers, const RenderSettings& settings,
                const Background& background = {}) const {
    const auto path = folder_ / "layers.exr";
    ImageFileOptions options;
    options.size = view.size;
    options.format = PixelFormat::rgbaFloat;
    options.alpha = background.transparent;
    options.layers = layers;
    const auto file = ImageFile::create(path, options);
    renderer.renderPicture(view, Lighting{}, background, settings, {PixelFormat::rgbaFloat, layers}, *file);
    file->finish();
    const auto input = OIIO::ImageInput::open(path.string());
    if (!input) throw std::runtime_error(OIIO::geterror());
    ReadBack image{input->spec(), {}};
    image.pixels.resize(
        static_cast<std::size_t>(image.spec.width * image.spec.height * image.spec.nchannels));
    input->read_image(0, 0, 0, -1, OIIO::TypeDesc::FLOAT, image.pixels.data());
    return image;
  }

  test::TemporaryFolder folder_;
};

double linearFromSrgb(unsigned value) {
  const double c = value / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

using Names = std::vector<std::string>;

TEST_F(LayersTest, HaveTheNamesThatCompositingProgramsExpectAndFullPrecision) {
  const auto scene = test::randomSpheres(5, 1);
  Renderer renderer;
  renderer.setPrimitives(scene);
  const View view = test::viewOf(*scene, kSize);
  const ReadBack image = draw(renderer, view, kAll, 1, Background{0, true});
  Names names = image.spec.channelnames;
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (Names{"A", "B", "G", "N.X", "N.Y", "N.Z", "R", "Z", "albedo.B", "albedo.G", "albedo.R",
                          "distance", "id"}));
  EXPECT_EQ(image.spec.format, OIIO::TypeDesc::FLOAT);
  EXPECT_TRUE(image.spec.channelformats.empty()) << "all of one type";

  const ReadBack one = draw(renderer, view, {.color = false, .normal = true});
  EXPECT_EQ(one.spec.channelnames, (Names{"N.X", "N.Y", "N.Z"}));
  EXPECT_EQ(draw(renderer, view, {}).spec.format, OIIO::TypeDesc::HALF) << "the colour alone";
}

TEST_F(LayersTest, ValuesAreThoseOfTheExactRaysThroughThePixelsCentres) {
  const auto scene = test::randomChain(40, 7);
  Renderer renderer;
  renderer.setPrimitives(scene);
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    for (const int samples : {1, 4}) {
      const View view = test::viewOf(*scene, kSize, projection);
      const ReadBack image = draw(renderer, view, kAll, samples);
      int hits = 0, misses = 0;
      for (int y = 0; y < kSize.height; ++y) {
        for (int x = 0; x < kSize.width; ++x) {
          const glm::dvec2 pixel(x + 0.5, y + 0.5);
          const test::ExactHit truth = test::exactHit(*scene, view, pixel);
          if (truth.clearance < 1e-4 || truth.runnerUp - truth.distance < 1e-4) continue;
          ASSERT_EQ(image.at(x, y, "id"), static_cast<float>(truth.id));
          const glm::vec3 normal(image.at(x, y, "N.X"), image.at(x, y, "N.Y"), image.at(x, y, "N.Z"));
          if (truth.id == 0) {
            ++misses;
            ASSERT_EQ(image.at(x, y, "Z"), std::numeric_limits<float>::infinity());
            ASSERT_EQ(image.at(x, y, "distance"), std::numeric_limits<float>::infinity());
            ASSERT_EQ(normal, glm::vec3(0));
            for (const char* name : {"albedo.R", "albedo.G", "albedo.B"})
              ASSERT_EQ(image.at(x, y, name), 0.0f);
            continue;
          }
          ++hits;
          const Ray ray = rayThrough(view, pixel);
          const double z = truth.distance * -ray.direction.z;
          ASSERT_NEAR(static_cast<double>(image.at(x, y, "distance")), truth.distance, 1e-4);
          ASSERT_NEAR(static_cast<double>(image.at(x, y, "Z")), z, 1e-4);
          ASSERT_NEAR(static_cast<double>(glm::length(normal)), 1, 1e-5);
          ASSERT_LE(glm::dot(glm::dvec3(normal), ray.direction), 1e-4);
          const std::uint32_t color = scene->spheres[truth.id - 1].color;
          ASSERT_NEAR(static_cast<double>(image.at(x, y, "albedo.R")), linearFromSrgb(color >> 16), 1e-6);
          ASSERT_NEAR(static_cast<double>(image.at(x, y, "albedo.G")), linearFromSrgb(color >> 8 & 255u),
                      1e-6);
          ASSERT_NEAR(static_cast<double>(image.at(x, y, "albedo.B")), linearFromSrgb(color & 255u), 1e-6);
        }
      }
      EXPECT_GT(hits, 300);
      EXPECT_GT(misses, 300);
    }
  }
}

// A sphere's normal is known.
TEST_F(LayersTest, NormalsAreInViewSpace) {
  auto scene = std::make_shared<Primitives>();
  scene->spheres = {{{0, 0, 0}, 2, 0x808080, 1}};
  const View view = test::viewOf(*scene, {41, 41});
  Renderer renderer;
  renderer.setPrimitives(scene);
  const ReadBack image = draw(renderer, view, kData);
  const glm::dvec3 center = view.rotation * (scene->origin - view.pivot);
  int hits = 0;
  for (int y = 0; y < 41; ++y) {
    for (int x = 0; x < 41; ++x) {
      if (image.at(x, y, "id") == 0.0f) continue;
      ++hits;
      const Ray ray = rayThrough(view, {x + 0.5, y + 0.5});
      const glm::dvec3 point = ray.origin + static_cast<double>(image.at(x, y, "distance")) * ray.direction;
      const glm::dvec3 truth = (point - center) / 2.0;
      EXPECT_NEAR(static_cast<double>(image.at(x, y, "N.X")), truth.x, 2e-4);
      EXPECT_NEAR(static_cast<double>(image.at(x, y, "N.Y")), truth.y, 2e-4);
      EXPECT_NEAR(static_cast<double>(image.at(x, y, "N.Z")), truth.z, 2e-4);
      // In front of the eye plane.
      EXPECT_NEAR(static_cast<double>(image.at(x, y, "Z")), view.distance - point.z, 1e-4);
    }
  }
  EXPECT_GT(hits, 500);
}

TEST_F(LayersTest, AgreeWithTheHitImageAndTheColourAlone) {
  const auto scene = test::randomChain(80, 3);
  const View view = test::viewOf(*scene, kSize);
  Renderer renderer;
  renderer.setPrimitives(scene);
  const HitImage hits = renderer.renderHits(view, {.distance = true, .normal = true, .id = true});
  for (const int samples : {1, 5}) {
    const ReadBack image = draw(renderer, view, kAll, samples, Background{0, true});
    const ReadBack color = draw(renderer, view, {}, samples, Background{0, true});
    const ReadBack data = draw(renderer, view, kData, samples);
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        const auto i = static_cast<std::size_t>(y * kSize.width + x);
        ASSERT_EQ(image.at(x, y, "distance"), hits.distance[i]);
        ASSERT_EQ(image.at(x, y, "N.X"), hits.normal[i].x);
        ASSERT_EQ(image.at(x, y, "N.Y"), hits.normal[i].y);
        ASSERT_EQ(image.at(x, y, "N.Z"), hits.normal[i].z);
        ASSERT_EQ(image.at(x, y, "id"), static_cast<float>(hits.id[i]));
        for (const char* name : {"R", "G", "B", "A"})
          ASSERT_NEAR(image.at(x, y, name), color.at(x, y, name), 1e-3f) << "half against float";
        for (const std::string& name : data.spec.channelnames)
          ASSERT_EQ(data.at(x, y, name), image.at(x, y, name)) << name;
        if (samples == 1) {
          ASSERT_EQ(image.at(x, y, "A"), hits.id[i] != 0 ? 1.0f : 0.0f);
        }
      }
    }
  }
}

TEST_F(LayersTest, TilesGiveTheSamePicture) {
  const auto scene = test::randomChain(80, 3);
  Renderer whole, tiled(RendererOptions{.shaderDir = {}, .timePasses = false, .maxTileSize = 23});
  whole.setPrimitives(scene);
  tiled.setPrimitives(scene);
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    const View view = test::viewOf(*scene, kSize, projection);
    for (const int samples : {1, 3}) {
      for (const Layers& layers : {kAll, kData}) {
        EXPECT_EQ(draw(whole, view, layers, samples).pixels, draw(tiled, view, layers, samples).pixels);
      }
    }
  }
}

TEST_F(LayersTest, WhatIsNotAskedForIsNotComputed) {
  const auto scene = test::randomSpheres(20, 1);
  const View view = test::viewOf(*scene, kSize);
  const auto statsOf = [&](const Layers& layers, int samples) {
    Renderer renderer;
    renderer.setPrimitives(scene);
    draw(renderer, view, layers, test::withSamples(samples, QuadricMethod::splat));
    return renderer.stats();
  };
  const auto passesOf = [](const RenderStats& stats) {
    Names names;
    for (const PassStats& pass : stats.passes) names.push_back(pass.name + " x" + std::to_string(pass.runs));
    return names;
  };
  const RenderStats depth = statsOf({.color = false, .depth = true}, 16);
  EXPECT_EQ(passesOf(depth), (Names{"spheres x1"})) << "samples are of the colour";
  EXPECT_EQ(depth.programs, (Names{"quadrics/sphere DISTANCE"}));
  EXPECT_EQ(depth.textures.size(), 2u);
  EXPECT_EQ(statsOf({.color = false, .albedo = true}, 1).programs, (Names{"quadrics/sphere ALBEDO"}));
  EXPECT_EQ(statsOf({.color = false, .normal = true}, 1).programs, (Names{"quadrics/sphere NORMAL"}));
  EXPECT_EQ(statsOf({.color = false, .id = true}, 1).programs, (Names{"quadrics/sphere ID"}));
  EXPECT_EQ(passesOf(statsOf(kAll, 1)), (Names{"spheres x1", "shade x1"})) << "one set of rays serves both";
  EXPECT_EQ(passesOf(statsOf(kAll, 2)), (Names{"spheres x3", "shade x2", "resolve x1"}));
}

// Effects that look beside a pixel draw more than the tile; the data are of the tile.
TEST_F(LayersTest, EffectsChangeTheColourOnly) {
  const auto scene = test::randomChain(80, 3);
  const View view = test::viewOf(*scene, kSize);
  Renderer whole, tiled(RendererOptions{.shaderDir = {}, .timePasses = false, .maxTileSize = 40});
  whole.setPrimitives(scene);
  tiled.setPrimitives(scene);
  RenderSettings settings = test::withSamples(1);
  settings.shadows.mode = ShadowMode::soft;
  settings.lines.silhouettes = true;
  const ReadBack plain = draw(whole, view, kData, 1);
  const RenderStats plainStats = whole.stats();
  Renderer dataOnly;
  dataOnly.setPrimitives(scene);
  EXPECT_EQ(draw(dataOnly, view, kData, settings).pixels, plain.pixels);
  EXPECT_EQ(dataOnly.stats().passes.size(), plainStats.passes.size()) << "no effect is computed for data";
  const ReadBack a = draw(whole, view, kAll, settings), b = draw(tiled, view, kAll, settings);
  EXPECT_EQ(a.pixels, b.pixels);
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      for (const std::string& name : plain.spec.channelnames)
        ASSERT_EQ(a.at(x, y, name), plain.at(x, y, name)) << name;
    }
  }
}

TEST_F(LayersTest, EmptyScenesAndSinglePixelsAreMissesNotNumbersGoneWrong) {
  Renderer renderer;
  const ReadBack empty = draw(renderer, makeView(Camera{}, {1, 1}, {}), kAll);
  EXPECT_EQ(empty.at(0, 0, "Z"), std::numeric_limits<float>::infinity());
  EXPECT_EQ(empty.at(0, 0, "id"), 0.0f);
  for (const float value : empty.pixels) EXPECT_FALSE(std::isnan(value));
}

}  // namespace
}  // namespace meniscus

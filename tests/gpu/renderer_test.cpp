// The renderer as a whole: what it leaves out, tiles, samples, transparency, determinism.

#include "render/renderer.h"

#include <glad/gl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "core/error.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/scenes.h"

namespace meniscus {
namespace {

constexpr ImageSize kSize{200, 150};

class RendererTest : public test::GlTest {
 protected:
  static std::vector<std::byte> draw(Renderer& renderer, const View& view, int samples,
                                     const Background& background = {},
                                     PixelFormat format = PixelFormat::rgba8,
                                     QuadricMethod quadrics = QuadricMethod::automatic) {
    test::MemorySink sink;
    renderer.renderPicture(view, Lighting{}, background, test::withSamples(samples, quadrics), format, sink);
    EXPECT_EQ(sink.bytes.size(),
              bytesPerPixel(format) * static_cast<std::size_t>(view.size.width * view.size.height));
    return sink.bytes;
  }
  static std::vector<float> drawFloat(Renderer& renderer, const View& view, int samples,
                                      const Background& background) {
    const std::vector<std::byte> bytes = draw(renderer, view, samples, background, PixelFormat::rgbaFloat);
    std::vector<float> out(bytes.size() / sizeof(float));
    std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
  }
};

std::vector<std::string> names(const std::vector<PassStats>& passes) {
  std::vector<std::string> out;
  for (const PassStats& pass : passes) out.push_back(pass.name);
  return out;
}

std::vector<std::string> names(const std::vector<ResourceStats>& resources) {
  std::vector<std::string> out;
  for (const ResourceStats& resource : resources) out.push_back(resource.name);
  std::sort(out.begin(), out.end());
  return out;
}

bool omitted(const RenderStats& stats, const std::string& what) {
  return std::any_of(stats.omissions.begin(), stats.omissions.end(),
                     [&](const OmissionStats& o) { return o.what == what && !o.reason.empty(); });
}

using Names = std::vector<std::string>;

TEST_F(RendererTest, SpheresOnlyLeavesOutEverythingElse) {
  const auto scene = test::randomSpheres(50, 1);
  Renderer renderer(test::effectsBy(false));
  renderer.setPrimitives(scene);
  draw(renderer, test::viewOf(*scene, kSize), 1, {}, PixelFormat::rgba8, QuadricMethod::splat);
  const RenderStats stats = renderer.stats();
  EXPECT_EQ(names(stats.passes), (Names{"spheres", "shade"}));
  EXPECT_EQ(stats.programs, (Names{"quadrics/sphere ALBEDO NORMAL", "post/shade ENCODE_SRGB FINAL"}));
  EXPECT_EQ(names(stats.buffers), (Names{"spheres"}));
  EXPECT_EQ(stats.buffers[0].bytes, 50 * sizeof(SpherePrimitive));
  EXPECT_EQ(names(stats.textures), (Names{"albedo", "depth", "normal", "picture"}));
  EXPECT_TRUE(omitted(stats, "pass cylinders"));
  EXPECT_TRUE(omitted(stats, "pass resolve"));
  EXPECT_TRUE(omitted(stats, "channel id"));
  EXPECT_TRUE(omitted(stats, "channel distance"));
}

TEST_F(RendererTest, DistanceOnlyNeedsNoColourAndNoShading) {
  const auto scene = test::randomChain(20, 1);
  Renderer renderer;
  renderer.setPrimitives(scene);
  const HitImage image =
      renderer.renderHits(test::viewOf(*scene, kSize), {.distance = true, .normal = false, .id = false}, {},
                          QuadricMethod::splat);
  EXPECT_TRUE(image.id.empty());
  EXPECT_TRUE(image.normal.empty());
  const RenderStats stats = renderer.stats();
  EXPECT_EQ(names(stats.passes), (Names{"spheres", "cylinders"}));
  EXPECT_EQ(stats.programs, (Names{"quadrics/sphere DISTANCE", "quadrics/cylinder DISTANCE"}));
  EXPECT_EQ(names(stats.textures), (Names{"depth", "distance"}));
  EXPECT_TRUE(omitted(stats, "channel albedo"));
  EXPECT_TRUE(omitted(stats, "channel normal"));
}

TEST_F(RendererTest, FullPictureUsesEachProgramOnce) {
  const auto scene = test::randomChain(20, 1);
  Renderer renderer(test::effectsBy(false));
  renderer.setPrimitives(scene);
  const View view = test::viewOf(*scene, kSize);
  for (int i = 0; i < 2; ++i) draw(renderer, view, 4, {}, PixelFormat::rgba8, QuadricMethod::splat);
  const RenderStats stats = renderer.stats();
  EXPECT_EQ(names(stats.passes), (Names{"spheres", "cylinders", "shade", "resolve"}));
  EXPECT_EQ(stats.passes[0].runs, 8);
  EXPECT_EQ(stats.passes[3].runs, 2);
  EXPECT_EQ(stats.programs.size(), 4u);
  EXPECT_EQ(names(stats.buffers), (Names{"cylinders", "spheres"}));
  EXPECT_EQ(names(stats.textures), (Names{"albedo", "depth", "normal", "picture", "sum"}));
}

TEST_F(RendererTest, WhereTheProcessorCastsAndShadesNothingGoesThroughTextures) {
  const auto scene = test::randomChain(20, 1);
  Renderer renderer(test::effectsBy(true));
  renderer.setPrimitives(scene);
  draw(renderer, test::viewOf(*scene, kSize), 4, {}, PixelFormat::rgba8, QuadricMethod::tiles);
  RenderStats stats = renderer.stats();
  EXPECT_EQ(names(stats.passes), (Names{"tiles", "shade", "resolve"}));
  EXPECT_EQ(stats.passes[1].runs, 4);
  EXPECT_EQ(stats.programs, Names{});
  EXPECT_EQ(names(stats.textures), Names{});
  EXPECT_TRUE(omitted(stats, "channel depth"));
  RenderSettings settings = test::withSamples(1, QuadricMethod::tiles);
  settings.shadows.mode = ShadowMode::soft;
  settings.occlusion.on = true;
  settings.lines.silhouettes = settings.lines.creases = true;
  settings.depthUnsharp.mode = UnsharpMode::halo;
  test::MemorySink sink;
  const auto drawnWith = [&] {
    renderer.renderPicture(test::viewOf(*scene, kSize), Lighting{}, {}, settings, PixelFormat::rgba8, sink);
    return renderer.stats();
  };
  stats = drawnWith();
  EXPECT_EQ(stats.programs, Names{});
  EXPECT_EQ(names(stats.textures), Names{});
  // What shaders compute of it gets the channels that it reads.
  LabelSprite sprite;
  sprite.label = {"x", scene->bounds().center, 0.0};
  sprite.width = sprite.height = 1;
  sprite.texels.push_back({255, 255});
  renderer.setLabels({sprite}, {0x2040A0, 0xFFF0E0});
  const Names textures = names(drawnWith().textures);
  EXPECT_TRUE(std::binary_search(textures.begin(), textures.end(), "depth"));
  EXPECT_FALSE(std::binary_search(textures.begin(), textures.end(), "albedo"));
}

// As a driver says after a reset.
GLenum GLAD_API_PTR lost() {
  return GL_INNOCENT_CONTEXT_RESET;
}

TEST_F(RendererTest, ALostContextIsAnErrorThatWritesNothing) {
  const auto scene = test::randomSpheres(20, 1);
  const View view = test::viewOf(*scene, kSize);
  Renderer renderer;
  renderer.setPrimitives(scene);
  const auto before = draw(renderer, view, 1);
  const auto real = glad_glGetGraphicsResetStatus;
  glad_glGetGraphicsResetStatus = lost;
  test::MemorySink sink;
  const auto message = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const GraphicsError& error) {
      return error.what();
    }
    return "";
  };
  const std::string picture = message(
      [&] { renderer.renderPicture(view, Lighting{}, {}, test::withSamples(1), PixelFormat::rgba8, sink); });
  const std::string hits = message([&] { renderer.renderHits(view, {}); });
  glad_glGetGraphicsResetStatus = real;
  EXPECT_NE(picture.find("the graphics driver was reset"), std::string::npos) << picture;
  EXPECT_EQ(hits, picture);
  EXPECT_TRUE(sink.bytes.empty());
  EXPECT_EQ(draw(renderer, view, 1), before);
}

TEST_F(RendererTest, EmptySceneDrawsTheBackgroundWithoutAQuadricPass) {
  Renderer renderer;
  const auto picture = draw(renderer, makeView(Camera{}, {3, 2}, {}), 1, Background{0x204060, false});
  for (std::size_t i = 0; i < picture.size(); i += 4) {
    EXPECT_EQ(std::to_integer<int>(picture[i]), 0x20);
    EXPECT_EQ(std::to_integer<int>(picture[i + 1]), 0x40);
    EXPECT_EQ(std::to_integer<int>(picture[i + 2]), 0x60);
    EXPECT_EQ(std::to_integer<int>(picture[i + 3]), 0xFF);
  }
  const RenderStats stats = renderer.stats();
  EXPECT_TRUE(stats.buffers.empty());
  EXPECT_TRUE(omitted(stats, "pass spheres"));
}

TEST_F(RendererTest, SameCommandSameBytes) {
  const auto scene = test::randomChain(80, 2);
  const View view = test::viewOf(*scene, kSize);
  Renderer first, second;
  first.setPrimitives(scene);
  second.setPrimitives(scene);
  const auto picture = draw(first, view, 4);
  EXPECT_EQ(picture, draw(second, view, 4));
  EXPECT_EQ(picture, draw(first, view, 4));
}

TEST_F(RendererTest, TilesGiveTheSameBytes) {
  const auto scene = test::randomChain(80, 3);
  Renderer whole, tiled(RendererOptions{.shaderDir = {}, .timePasses = false, .maxTileSize = 37});
  whole.setPrimitives(scene);
  tiled.setPrimitives(scene);
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    const View view = test::viewOf(*scene, kSize, projection);
    for (const int samples : {1, 5}) EXPECT_EQ(draw(whole, view, samples), draw(tiled, view, samples));
    const HitImage a = whole.renderHits(view, {.distance = true, .normal = true, .id = true});
    const HitImage b = tiled.renderHits(view, {.distance = true, .normal = true, .id = true});
    EXPECT_EQ(a.distance, b.distance);
    EXPECT_EQ(a.normal, b.normal);
    EXPECT_EQ(a.id, b.id);
  }
  EXPECT_EQ(whole.stats().tiles, 6);
  EXPECT_EQ(tiled.stats().tiles, 6 * 6 * 5);
}

// Transparent pictures put over a colour later must look as if they had been drawn over it.
TEST_F(RendererTest, TransparencyCompositesWithoutHalo) {
  const auto scene = test::randomChain(60, 4);
  const View view = test::viewOf(*scene, kSize);
  Renderer renderer;
  renderer.setPrimitives(scene);
  const Background white{0xFFFFFF, false}, none{0xFF00FF, true};
  for (const int samples : {1, 16}) {
    const std::vector<float> opaque = drawFloat(renderer, view, samples, white);
    const std::vector<float> layer = drawFloat(renderer, view, samples, none);
    int partial = 0;
    for (std::size_t i = 0; i < opaque.size(); i += 4) {
      const float alpha = layer[i + 3];
      ASSERT_GE(alpha, 0.0f);
      ASSERT_LE(alpha, 1.0f);
      partial += alpha > 0 && alpha < 1;
      for (std::size_t c = 0; c < 3; ++c)
        ASSERT_NEAR(layer[i + c] + (1 - alpha) * 1.0f, opaque[i + c], 1e-5f);
      ASSERT_EQ(opaque[i + 3], 1.0f);
      if (alpha == 0) {
        ASSERT_EQ(layer[i], 0.0f) << "premultiplied: nothing where nothing is";
      }
    }
    if (samples == 1) {
      EXPECT_EQ(partial, 0);
    } else {
      EXPECT_GT(partial, 500);
    }
  }
}

// Straight alpha in 8 bits: an edge pixel keeps the object's own colour, not one mixed with the background.
TEST_F(RendererTest, StraightAlphaKeepsTheObjectsColourAtEdges) {
  auto scene = std::make_shared<Primitives>();
  scene->spheres = {{{0, 0, 0}, 1.5f, 0x00FF00, 1}};
  Renderer renderer;
  renderer.setPrimitives(scene);
  const auto picture = draw(renderer, test::viewOf(*scene, {64, 64}), 16, Background{0x000000, true});
  int edges = 0;
  for (std::size_t i = 0; i < picture.size(); i += 4) {
    const int alpha = std::to_integer<int>(picture[i + 3]);
    if (alpha == 0 || alpha == 255) continue;
    ++edges;
    EXPECT_GT(std::to_integer<int>(picture[i + 1]), 90) << "a dark rim";
    EXPECT_LT(std::to_integer<int>(picture[i]), 60);
  }
  EXPECT_GT(edges, 50);
}

// Coverage of a disc by supersampling against its area.
TEST_F(RendererTest, SamplesConvergeToTheArea) {
  auto scene = std::make_shared<Primitives>();
  scene->spheres = {{{0, 0, 0}, 1, 0xFFFFFF, 1}};
  View view = test::viewOf(*scene, {32, 32}, Projection::orthographic);
  const double exact = M_PI / (view.pixelSize * view.pixelSize);
  Renderer renderer;
  renderer.setPrimitives(scene);
  const auto coverage = [&](int samples) {
    double sum = 0;
    const std::vector<float> layer = drawFloat(renderer, view, samples, Background{0, true});
    for (std::size_t i = 3; i < layer.size(); i += 4) sum += static_cast<double>(layer[i]);
    return sum;
  };
  EXPECT_NEAR(coverage(1), exact, 12);
  EXPECT_NEAR(coverage(16), exact, 2);
  EXPECT_NEAR(coverage(256), exact, 0.4);
}

TEST_F(RendererTest, SixteenBitsRefineEightBits) {
  const auto scene = test::randomSpheres(40, 5);
  const View view = test::viewOf(*scene, kSize);
  Renderer renderer;
  renderer.setPrimitives(scene);
  const auto eight = draw(renderer, view, 4);
  const auto sixteen = draw(renderer, view, 4, {}, PixelFormat::rgba16);
  for (std::size_t i = 0; i < eight.size(); ++i) {
    std::uint16_t fine = 0;
    std::memcpy(&fine, sixteen.data() + 2 * i, sizeof(fine));
    ASSERT_NEAR(fine / 257.0, std::to_integer<int>(eight[i]), 0.51) << i;
  }
}

TEST_F(RendererTest, NoValueIsNotANumber) {
  auto scene = test::randomChain(60, 6);
  scene->spheres.push_back({{0, 0, 0}, 1e-20f, 0xFFFFFF, 1000});
  scene->cylinders.push_back({{0, 0, 0}, 1e-20f, {1, 0, 0}, 1, 1, 1001, 1001});
  Renderer renderer;
  renderer.setPrimitives(scene);
  Camera camera;
  camera.target = scene->origin;
  for (const double distance : {1e-3, 1.0, 1e5}) {
    camera.distance = distance;
    for (const float value :
         drawFloat(renderer, makeView(camera, {40, 30}, scene->bounds()), 2, Background{})) {
      ASSERT_TRUE(std::isfinite(value)) << distance;
    }
  }
}

}  // namespace
}  // namespace meniscus

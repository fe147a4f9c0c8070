// Fog, lines and depth unsharp masking in pictures: tiles, samples, transparency, what is left out.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "render/renderer.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/scenes.h"

namespace meniscus {
namespace {

constexpr ImageSize kSize{160, 110};
constexpr Background kWhite{0xFFFFFF, false}, kNothing{0, true};

class Effects : public test::GlTest {
 protected:
  static std::vector<float> draw(Renderer& renderer, const View& view, const RenderSettings& settings,
                                 const Background& background) {
    test::MemorySink sink;
    renderer.renderPicture(view, Lighting{}, background, settings, {PixelFormat::rgbaFloat, {}}, sink);
    std::vector<float> out(sink.bytes.size() / sizeof(float));
    std::memcpy(out.data(), sink.bytes.data(), sink.bytes.size());
    return out;
  }
};

RenderSettings allEffects(int samples) {
  RenderSettings s = test::withSamples(samples);
  s.lines.silhouettes = s.lines.creases = true;
  s.lines.groups = LineGroups::residues;
  s.lines.width = 2.5;
  s.depthUnsharp.mode = UnsharpMode::both;
  s.depthUnsharp.radius = 0.06;
  s.fog.strength = 0.7;
  return s;
}

// Two atoms to a group.
std::shared_ptr<Primitives> groupedChain(int count, unsigned seed) {
  auto scene = test::randomChain(count, seed);
  for (int id = 0; id <= count; ++id) scene->groups.push_back(static_cast<std::uint32_t>((id + 1) / 2));
  return scene;
}

TEST_F(Effects, TilesGiveTheSamePicture) {
  const auto scene = groupedChain(60, 3);
  Renderer whole, tiled(RendererOptions{.shaderDir = {}, .timePasses = false, .maxTileSize = 47});
  whole.setPrimitives(scene);
  tiled.setPrimitives(scene);
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    const View view = test::viewOf(*scene, kSize, projection);
    for (const int samples : {1, 3}) {
      EXPECT_EQ(draw(whole, view, allEffects(samples), kWhite),
                draw(tiled, view, allEffects(samples), kWhite));
    }
    RenderSettings one = test::withSamples(1);
    one.lines.silhouettes = true;
    one.lines.width = 7;
    EXPECT_EQ(draw(whole, view, one, kWhite), draw(tiled, view, one, kWhite)) << "lines";
    one = test::withSamples(1);
    one.depthUnsharp.mode = UnsharpMode::halo;
    for (const double radius : {0.004, 0.02, 0.1}) {
      one.depthUnsharp.radius = radius;
      EXPECT_EQ(draw(whole, view, one, kWhite), draw(tiled, view, one, kWhite)) << "unsharp " << radius;
    }
  }
}

TEST_F(Effects, FogLetsTheBackgroundThroughByDepth) {
  const auto scene = test::randomSpheres(60, 4);
  const View view = test::viewOf(*scene, kSize, Projection::orthographic);
  Renderer renderer;
  renderer.setPrimitives(scene);
  RenderSettings settings = test::withSamples(1);
  const std::vector<float> plain = draw(renderer, view, settings, kNothing);
  settings.fog = {0.8, 0.3, 0.7};
  const std::vector<float> fogged = draw(renderer, view, settings, kNothing);
  const HitImage hits = renderer.renderHits(view, {.distance = true, .normal = false, .id = false});
  bool before = false, within = false, beyond = false;
  for (int row = 0; row < kSize.height; ++row) {
    for (int x = 0; x < kSize.width; ++x) {
      const auto from = static_cast<std::size_t>(row * kSize.width + x);
      const auto up = static_cast<std::size_t>((kSize.height - 1 - row) * kSize.width + x);
      if (plain[4 * from + 3] == 0) {
        ASSERT_EQ(fogged[4 * from + 3], 0);
        continue;
      }
      const double depth = static_cast<double>(hits.distance[up]) / (view.nearZ - view.farZ);
      const double fog = 0.8 * std::clamp((depth - 0.3) / 0.4, 0.0, 1.0);
      before = before || fog == 0;
      within = within || (fog > 0.1 && fog < 0.7);
      beyond = beyond || fog == 0.8;
      for (std::size_t c = 0; c < 4; ++c) {
        ASSERT_NEAR(static_cast<double>(fogged[4 * from + c]),
                    (1 - fog) * static_cast<double>(plain[4 * from + c]), 1e-5);
      }
    }
  }
  EXPECT_TRUE(before && within && beyond);
}

TEST_F(Effects, TransparentPicturesCompositeLikeOpaqueOnes) {
  const auto scene = groupedChain(60, 5);
  const View view = test::viewOf(*scene, kSize);
  Renderer renderer;
  renderer.setPrimitives(scene);
  for (const int samples : {1, 4}) {
    for (const std::uint32_t color : {0x000000u, 0xFF8000u}) {
      RenderSettings settings = allEffects(samples);
      settings.lines.color = color;
      settings.lines.strength = 0.8;
      const std::vector<float> opaque = draw(renderer, view, settings, kWhite);
      const std::vector<float> layer = draw(renderer, view, settings, kNothing);
      for (std::size_t i = 0; i < opaque.size(); ++i) {
        const float alpha = layer[i - i % 4 + 3];
        ASSERT_TRUE(alpha >= 0 && alpha <= 1);
        ASSERT_NEAR(layer[i] + (1 - alpha), opaque[i], 2e-5f);
      }
    }
  }
}

// Lines stay on the object: no pixel becomes more or less covered.
TEST_F(Effects, LinesKeepTheOutline) {
  auto scene = std::make_shared<Primitives>();
  scene->spheres = {{{0, 0, 0}, 1.5f, 0xFFFFFF, 1}};
  const View view = test::viewOf(*scene, {96, 96}, Projection::orthographic);
  Renderer renderer;
  renderer.setPrimitives(scene);
  RenderSettings settings = test::withSamples(16);
  const std::vector<float> plain = draw(renderer, view, settings, kNothing);
  settings.lines.silhouettes = true;
  settings.lines.width = 3;
  const std::vector<float> lined = draw(renderer, view, settings, kNothing);
  const double radius = 1.5 / view.pixelSize;
  double dark = 0;
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 96; ++x) {
      const auto i = 4 * static_cast<std::size_t>(y * 96 + x);
      ASSERT_EQ(lined[i + 3], plain[i + 3]);
      const double r = std::hypot(x + 0.5 - 48, y + 0.5 - 48);
      if (r < radius - 4.5) {
        ASSERT_EQ(lined[i], plain[i]);
      }
      if (r > radius - 2 && r < radius + 1) {
        ASSERT_NEAR(lined[i], 0, 1e-6f);
      }
      if (plain[i] > 0) dark += static_cast<double>(plain[i + 3] * (1 - lined[i] / plain[i]));
    }
  }
  EXPECT_NEAR(dark / (M_PI * 3 * (2 * radius - 3)), 1, 0.06) << "three pixels wide at any number of samples";
}

// Black line of full strength, white light: what is not line is as it was.
TEST_F(Effects, WidthDoesNotDependOnSamples) {
  const auto scene = test::randomSpheres(30, 7);
  const View view = test::viewOf(*scene, kSize);
  Renderer renderer;
  renderer.setPrimitives(scene);
  std::vector<double> means;
  for (const int samples : {1, 4, 64}) {
    RenderSettings settings = test::withSamples(samples);
    settings.lines.silhouettes = true;
    settings.lines.width = 2;
    double sum = 0;
    for (const float value : draw(renderer, view, settings, kWhite)) sum += static_cast<double>(value);
    means.push_back(sum);
  }
  EXPECT_NEAR(means[0] / means[2], 1, 0.01);
  EXPECT_NEAR(means[1] / means[2], 1, 0.005);
}

TEST_F(Effects, HaloOnlyDarkens) {
  const auto scene = test::randomSpheres(60, 6);
  const View view = test::viewOf(*scene, kSize);
  Renderer renderer;
  renderer.setPrimitives(scene);
  RenderSettings settings = test::withSamples(1);
  const std::vector<float> plain = draw(renderer, view, settings, kWhite);
  settings.depthUnsharp.radius = 0.05;
  settings.depthUnsharp.mode = UnsharpMode::halo;
  const std::vector<float> halo = draw(renderer, view, settings, kWhite);
  settings.depthUnsharp.mode = UnsharpMode::both;
  const std::vector<float> both = draw(renderer, view, settings, kWhite);
  int brighter = 0, darker = 0;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    ASSERT_LE(halo[i], plain[i] + 1e-5f);
    if (both[i] < plain[i] - 1e-4f) {
      ++darker;
      ASSERT_NEAR(both[i], halo[i], 1e-5f);
    }
    brighter += both[i] > plain[i] + 1e-3f;
  }
  EXPECT_GT(brighter, 1000);
  EXPECT_GT(darker, 1000);
}

TEST_F(Effects, OnlyWhatIsAskedForRuns) {
  const auto scene = groupedChain(20, 1);
  const View view = test::viewOf(*scene, kSize);
  const auto counts = [&](const RenderSettings& settings, bool processor = false) {
    Renderer renderer(test::effectsBy(processor));
    renderer.setPrimitives(scene);
    draw(renderer, view, settings, kWhite);
    const RenderStats stats = renderer.stats();
    return std::array{stats.passes.size(), stats.programs.size(), stats.textures.size()};
  };
  using Counts = std::array<std::size_t, 3>;
  const Counts off = counts(test::withSamples(1, QuadricMethod::splat));
  EXPECT_EQ(off, (Counts{3, 3, 4}));
  RenderSettings settings = test::withSamples(1, QuadricMethod::splat);
  settings.fog.strength = 0.5;
  EXPECT_EQ(counts(settings), off);
  settings = test::withSamples(1, QuadricMethod::splat);
  settings.lines.silhouettes = true;
  EXPECT_EQ(counts(settings), (Counts{5, 5, 6}));
  EXPECT_EQ(counts(settings, true), (Counts{4, 2, 3}))
      << "lines and shading without programs, textures and a picture on the GPU";
  settings.lines.groups = LineGroups::atoms;
  EXPECT_EQ(counts(settings), (Counts{5, 5, 7})) << "ids, too";
  settings = test::withSamples(1, QuadricMethod::splat);
  settings.depthUnsharp.mode = UnsharpMode::halo;
  EXPECT_EQ(counts(settings)[0], 7u);
}

TEST_F(Effects, NoValueIsNotANumber) {
  auto scene = groupedChain(40, 6);
  scene->spheres.push_back({{0, 0, 0}, 1e-20f, 0xFFFFFF, 1000});  // an id without a group
  Renderer renderer;
  const auto check = [&](const View& view, const char* what) {
    for (const auto& background : {kWhite, kNothing}) {
      for (const float value : draw(renderer, view, allEffects(2), background))
        ASSERT_TRUE(std::isfinite(value)) << what;
    }
  };
  renderer.setPrimitives(scene);
  Camera camera;
  camera.target = scene->origin;
  for (const double distance : {1e-3, 1.0, 1e5}) {
    camera.distance = distance;
    check(makeView(camera, {40, 30}, scene->bounds()), "a chain");
  }
  check(test::viewOf(*scene, {1, 1}), "one pixel");
  for (const float radius : {1e-2f, 1.0f, 1e5f}) {
    auto atom = std::make_shared<Primitives>();
    atom->spheres = {{{0, 0, 0}, radius, 0xFFFFFF, 1}};
    renderer.setPrimitives(atom);
    check(test::viewOf(*atom, {40, 30}), "one atom");
  }
  renderer.setPrimitives(std::make_shared<Primitives>());
  check(makeView(Camera{}, {3, 2}, {}), "nothing");
}

}  // namespace
}  // namespace meniscus

// Traced light in pictures: against shadow maps, and against pictures that need no rays.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/traced_light.h"
#include "render/renderer.h"
#include "render/shadow_scene.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/scenes.h"
#include "tests/support/surface_scenes.h"

namespace meniscus {
namespace {

class TracedPicture : public test::GlTest {
 protected:
  static std::vector<std::byte> picture(const std::shared_ptr<const Primitives>& primitives, const View& view,
                                        const RenderSettings& settings, Background background = {},
                                        int maxTileSize = 0) {
    RendererOptions options;
    options.maxTileSize = maxTileSize;
    Renderer renderer(options);
    renderer.setPrimitives(primitives);
    test::MemorySink sink;
    renderer.renderPicture(view, {}, background, settings, {PixelFormat::rgba8}, sink);
    return sink.bytes;
  }
};

// The same light, within what a soft shadow of 64 samples is wrong by (docs/measured/shadow_error.md).
TEST_F(TracedPicture, SoftShadowsAgreeWithFilteredShadowMaps) {
  const auto primitives = test::randomSpheres(400, 3);
  // A part of a picture, large enough for its map to have small texels.
  const View view = test::viewOf(*primitives, {640, 480});
  const int x0 = 260, y0 = 180, width = 120, height = 90;
  TracedLightSettings settings;
  settings.trace.shadows = 256;
  settings.shadows.samples = 256;
  settings.shadows.probes = 0;
  for (const double penumbra : {1.0, 2.0}) {
    settings.shadows.mode = ShadowMode::soft;
    settings.shadows.penumbra = penumbra;
    ShadowScene map(*primitives, view, settings.lighting.key, penumbra);
    const std::vector<float> filtered = map.visibility(settings.shadows);
    TracedPlanes planes;
    bvh::TraceCounts counts;
    traceLight(bvh::SceneTracer(primitives), {view, x0, y0, width, height}, settings, planes, counts);
    double sum = 0, worst = 0, mean = 0;
    std::size_t penumbras = 0, lit = 0;
    for (int i = 0; i < width * height; ++i) {
      const int x = x0 + i % width, y = y0 + i / width;
      const double a = static_cast<double>(filtered[static_cast<std::size_t>(y * 640 + x)]);
      const double b = planes.visibility[static_cast<std::size_t>(i)] / 65535.0;
      if (a == 0 && b == 0) continue;
      ++lit;
      penumbras += b > 0 && b < 1 ? 1 : 0;
      sum += (a - b) * (a - b);
      mean += a - b;
      worst = std::max(worst, std::abs(a - b));
    }
    const double rms = std::sqrt(sum / static_cast<double>(lit));
    RecordProperty("rms" + std::to_string(penumbra), std::to_string(rms) + " worst " + std::to_string(worst));
    EXPECT_GT(penumbras, 500u);
    EXPECT_LT(rms, 0.0155);
    EXPECT_LT(std::abs(mean) / static_cast<double>(lit), 0.004);
  }
}

// Glass that does not bend light is not there; what is behind it is lit as a picture without it.
TEST_F(TracedPicture, GlassOfIndexOneShowsWhatIsBehindIt) {
  const auto spheres = test::randomSpheres(30, 3);
  const auto behindGlass = std::make_shared<Primitives>(*spheres);
  behindGlass->surfaces.push_back(test::randomScene(60, 4).primitives->surfaces[0]);
  const View view = test::viewOf(*behindGlass, {96, 72});
  RenderSettings settings = test::withSamples(1);
  const Background background{0xE0E0E0, false};
  const std::vector<std::byte> without = picture(spheres, view, settings, background);
  settings.trace.refract = 16;
  settings.trace.index = 1;
  settings.trace.environment = Environment::background;
  const std::vector<std::byte> with = picture(behindGlass, view, settings, background);
  ASSERT_EQ(with.size(), without.size());
  int differ = 0, highlights = 0;
  for (std::size_t i = 0; i < with.size(); i += 4) {
    int most = 0;
    bool brighter = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const int d = std::to_integer<int>(with[i + k]) - std::to_integer<int>(without[i + k]);
      most = std::max(most, std::abs(d));
      brighter = brighter && d >= 0;
    }
    if (most <= 2) continue;
    ++(brighter ? highlights : differ);
  }
  EXPECT_LT(differ, 5) << "where an edge lies within a rounding of the ray";
  EXPECT_LT(highlights, 1000);
}

TEST_F(TracedPicture, AnyTilesGiveTheSameBytes) {
  const test::SurfaceScene scene = test::randomScene(40, 3);
  const View view = viewOf(scene, {70, 50});
  RenderSettings settings = test::withSamples(2);
  settings.trace = {4, 8, 1, 0};
  settings.shadows.mode = ShadowMode::soft;
  settings.occlusion.on = true;
  const std::vector<std::byte> whole = picture(scene.primitives, view, settings);
  EXPECT_EQ(picture(scene.primitives, view, settings, {}, 33), whole);
  EXPECT_EQ(picture(scene.primitives, view, settings), whole);
  RenderSettings plain = test::withSamples(2);
  EXPECT_NE(picture(scene.primitives, view, plain), whole);
}

// What `progress` throws ends the picture while its rays are traced; the next one is whole.
TEST_F(TracedPicture, CanBeEnded) {
  const test::SurfaceScene scene = test::randomScene(40, 3);
  const View view = viewOf(scene, {70, 50});
  RenderSettings settings = test::withSamples(1);
  settings.trace.occlusion = 4;
  Renderer renderer;
  renderer.setPrimitives(scene.primitives);
  struct Ended {};
  int looks = 0;
  test::MemorySink none, sink;
  EXPECT_THROW(renderer.renderPicture(view, {}, {}, settings, {PixelFormat::rgba8}, none,
                                      [&](double share) {
                                        EXPECT_EQ(share, 0);
                                        if (++looks == 3) throw Ended{};
                                      }),
               Ended);
  EXPECT_EQ(looks, 3);
  EXPECT_TRUE(none.bytes.empty());
  double before = 0;
  renderer.renderPicture(view, {}, {}, settings, {PixelFormat::rgba8}, sink, [&](double share) {
    EXPECT_GE(share, before);
    before = share;
  });
  EXPECT_EQ(before, 1);
  EXPECT_EQ(sink.bytes, picture(scene.primitives, view, settings));
}

TEST_F(TracedPicture, TracedPassesReplaceMaps) {
  const test::SurfaceScene scene = test::randomScene(40, 3);
  Renderer renderer;
  renderer.setPrimitives(scene.primitives);
  RenderSettings settings = test::withSamples(1);
  settings.trace = {1, 1, 0, 0};
  settings.shadows.mode = ShadowMode::hard;
  settings.occlusion.on = true;
  test::MemorySink sink;
  renderer.renderPicture(viewOf(scene, {32, 24}), {}, {}, settings, {PixelFormat::rgba8}, sink);
  std::vector<std::string> passes;
  for (const PassStats& pass : renderer.stats().passes) passes.push_back(pass.name);
  EXPECT_EQ(passes, (std::vector<std::string>{"surface", "trace", "shade"}));
  const SurfaceStats rays = renderer.stats().surfaces.back();
  EXPECT_EQ(rays.method, "traced rays");
  EXPECT_GT(rays.pixels, 32u * 24u);
  EXPECT_EQ(rays.notConverged, 0u);
}

}  // namespace
}  // namespace meniscus

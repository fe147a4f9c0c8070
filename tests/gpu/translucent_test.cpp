// Layers of translucent surfaces: against all roots along the ray, among each other and with what is opaque.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "render/surface_method.h"
#include "tests/gpu/surface_judge.h"
#include "tests/support/all_roots.h"
#include "tests/support/exact_field.h"
#include "tests/support/scenes.h"

namespace meniscus {
namespace {

SurfaceSettings translucent(std::map<std::string, double> parameters = {}) {
  return {"auto", std::move(parameters), 0.5};
}

class Translucent : public test::SurfaceTest {
 protected:
  SurfaceLayerImage layersOf(const test::SurfaceScene& scene, const View& view,
                             const SurfaceSettings& settings) {
    Renderer renderer;
    renderer.setPrimitives(scene.primitives);
    SurfaceLayerImage image = renderer.renderLayers(view, settings);
    stats = renderer.stats().surfaces.at(0);
    return image;
  }

  struct Judged {
    int pixels = 0, crossings = 0, most = 0, wrongCounts = 0, close = 0;
    double largest = 0;  // error of a distance, as a share of it or of 10 Å
  };

  // Every crossing of every pixel; `behind`: distances of what is opaque, or nothing.
  Judged judgeLayers(const test::SurfaceScene& scene, const View& view, const SurfaceSettings& settings,
                     const HitImage* behind = nullptr) {
    const SurfaceLayerImage image = layersOf(scene, view, settings);
    Judged judged;
    for (int y = 0; y < view.size.height; ++y) {
      for (int x = 0; x < view.size.width; ++x) {
        const auto at = static_cast<std::size_t>(y * view.size.width + x);
        std::vector<double> truth;
        bool close = false;
        for (const MetaballField& field : scene.primitives->surfaces) {
          const test::AllRoots roots =
              test::allRoots(field, scene.primitives->origin, view, {x + 0.5, y + 0.5});
          close = close || roots.touched;
          truth.insert(truth.end(), roots.distances.begin(), roots.distances.end());
        }
        std::sort(truth.begin(), truth.end());
        if (behind) {
          const auto limit = static_cast<double>(behind->distance[at]);
          for (const double t : truth) close = close || std::abs(t - limit) < 1e-3;
          std::erase_if(truth, [&](double t) { return t > limit; });
        }
        // Crossings so near to each other come and go with a rounding.
        for (std::size_t i = 1; i < truth.size(); ++i) close = close || truth[i] - truth[i - 1] < 2e-3;
        if (close) {
          ++judged.close;
          continue;
        }
        ++judged.pixels;
        judged.crossings += static_cast<int>(truth.size());
        judged.most = std::max(judged.most, static_cast<int>(truth.size()));
        std::size_t found = image.rest[at];
        for (const HitImage& layer : image.layers) found += layer.id[at] != 0;
        if (found != truth.size()) ++judged.wrongCounts;
        for (std::size_t i = 0; i < std::min(truth.size(), image.layers.size()); ++i) {
          const auto t = static_cast<double>(image.layers[i].distance[at]);
          judged.largest = std::max(judged.largest, std::abs(t - truth[i]) / std::max(truth[i], 10.0));
        }
      }
    }
    return judged;
  }
};

TEST_F(Translucent, LayersAreAllRootsInOrder) {
  const test::SurfaceScene scene = test::randomScene(200, 3);
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    for (const double array : {64, 3}) {
      const View view = viewOf(scene, {40, 30}, projection);
      const Judged judged = judgeLayers(scene, view, translucent({{"array", array}}));
      EXPECT_GT(judged.pixels, 1150);
      EXPECT_LT(judged.close, 50);
      EXPECT_GE(judged.most, 6) << "some are merged";
      EXPECT_EQ(judged.wrongCounts, 0);
      EXPECT_LT(judged.largest, 1e-5);
      EXPECT_EQ(stats.notConverged, 0u);
    }
  }
}

TEST_F(Translucent, LayersOfAnyKernelAndSign) {
  for (const Kernel kernel : {Kernel{}, Kernel{KernelShape::quartic}}) {
    const test::SurfaceScene scene(test::randomField(kernel, 0.3, 80, 4, 3, 11));
    const Judged judged = judgeLayers(scene, viewOf(scene, {48, 36}), translucent());
    EXPECT_GT(judged.crossings, 800);
    EXPECT_EQ(judged.wrongCounts, 0);
    EXPECT_LT(judged.largest, 1e-5);
  }
}

TEST_F(Translucent, LayersOfSurfacesInEachOther) {
  const test::SurfaceScene scene = test::twoSurfaces();
  const View view = viewOf(scene, {60, 45});
  const Judged judged = judgeLayers(scene, view, translucent());
  EXPECT_GE(judged.most, 6);
  EXPECT_EQ(judged.wrongCounts, 0);
  EXPECT_LT(judged.largest, 1e-5);
  const SurfaceLayerImage image = layersOf(scene, view, translucent());
  int ofFirst = 0, ofSecond = 0;
  for (const std::uint32_t id : image.layers[1].id) {
    ofFirst += id >= 1 && id <= 60;
    ofSecond += id > 60;
  }
  EXPECT_GT(ofFirst, 50);
  EXPECT_GT(ofSecond, 50);
}

TEST_F(Translucent, WhatIsOpaqueHidesLayersAndShowsThrough) {
  const test::SurfaceScene scene = test::twoSurfaces();
  const View view = viewOf(scene, {60, 45});
  auto spheres = std::make_shared<Primitives>();
  spheres->origin = scene.primitives->origin;
  spheres->spheres = test::spheresAmongSurfaces();
  const HitImage behind = draw({spheres}, view, {});
  scene.primitives->spheres = spheres->spheres;
  const Judged judged = judgeLayers(scene, view, translucent(), &behind);
  EXPECT_GT(judged.crossings, 1000);
  EXPECT_EQ(judged.wrongCounts, 0);
  EXPECT_LT(judged.largest, 1e-5);
}

TEST_F(Translucent, FromTheInside) {
  const test::SurfaceScene scene = test::randomScene(200, 5);
  for (View view : viewsFromInside(scene)) {
    view.center = view.center * 0.5;
    view.pixelSize *= 2;
    view.size = {32, 24};
    const Judged judged = judgeLayers(scene, view, translucent());
    EXPECT_GT(judged.crossings, 500);
    EXPECT_EQ(judged.wrongCounts, 0);
    EXPECT_LT(judged.largest, 1e-5);
  }
}

// Alpha over nothing is that of so many layers; over white nothing is darker than black and over spheres all
// is covered.
TEST_F(Translucent, EachLayerLetsThroughWhatItDoesNotCover) {
  const test::SurfaceScene scene = test::twoSurfaces();
  const View view = viewOf(scene, {60, 45});
  const SurfaceLayerImage layers = layersOf(scene, view, translucent());
  const auto picture = [&](double opacity, int samples, bool transparent) {
    Renderer renderer;
    renderer.setPrimitives(scene.primitives);
    RenderSettings settings = test::withSamples(samples);
    settings.surface.opacity = opacity;
    test::MemorySink sink;
    renderer.renderPicture(view, {}, {0xFFFFFF, transparent}, settings, {PixelFormat::rgba8}, sink);
    return sink.bytes;
  };
  for (const double opacity : {0.5, 0.2, 0.0}) {
    const std::vector<std::byte> bytes = picture(opacity, 1, true);
    for (int y = 0; y < 45; ++y) {
      for (int x = 0; x < 60; ++x) {
        const auto at = static_cast<std::size_t>(y * 60 + x), row = static_cast<std::size_t>(44 - y);
        double count = layers.rest[at];
        for (const HitImage& layer : layers.layers) count += layer.id[at] != 0;
        const double alpha = 255 * (1 - std::pow(1 - opacity, count));
        EXPECT_NEAR(static_cast<double>(bytes[4 * (row * 60 + static_cast<std::size_t>(x)) + 3]), alpha,
                    1.01);
      }
    }
  }
  EXPECT_NE(picture(0.5, 4, true), picture(0.5, 1, true)) << "samples are summed up";
  scene.primitives->spheres = test::spheresAmongSurfaces();
  const std::vector<std::byte> with = picture(0.5, 1, true);
  const HitImage behind = draw({[&] {
                                 auto spheres = std::make_shared<Primitives>(*scene.primitives);
                                 spheres->surfaces.clear();
                                 return spheres;
                               }()},
                               view, {});
  for (int y = 0; y < 45; ++y) {
    for (int x = 0; x < 60; ++x) {
      if (behind.id[static_cast<std::size_t>(y * 60 + x)] == 0) continue;
      EXPECT_EQ(with[4 * static_cast<std::size_t>((44 - y) * 60 + x) + 3], std::byte{255});
    }
  }
}

TEST_F(Translucent, EffectsAreThoseOfWhatIsOpaque) {
  const test::SurfaceScene scene = test::twoSurfaces();
  const View view = viewOf(scene, {40, 30});
  Renderer renderer;
  renderer.setPrimitives(scene.primitives);
  RenderSettings settings = test::withSamples(1);
  settings.surface.opacity = 0.3;
  settings.shadows.mode = ShadowMode::hard;
  settings.occlusion.on = true;
  settings.lines.silhouettes = true;
  settings.fog.strength = 0.5;
  test::MemorySink sink;
  renderer.renderPicture(view, {}, {}, settings, {PixelFormat::rgba8}, sink);
  const RenderStats all = renderer.stats();
  const auto ran = [&](const std::string& name) {
    return std::any_of(all.passes.begin(), all.passes.end(),
                       [&](const PassStats& p) { return p.name == name; });
  };
  EXPECT_TRUE(ran("translucent"));
  EXPECT_FALSE(ran("shadow map: surface"));
  EXPECT_FALSE(ran("occlusion maps")) << "nothing is opaque";
}

TEST(TranslucentMethod, IsListsWhateverElseIsAskedFor) {
  EXPECT_EQ(surfaceMethodFor(translucent()).name, "lists");
  EXPECT_EQ(surfaceMethodFor({"lists", {}, 0.5}).name, "lists");
  EXPECT_EQ(surfaceMethodFor({"tiles", {}, 1.0}).name, "tiles");
  EXPECT_THROW(surfaceMethodFor({"tiles", {}, 0.5}), UsageError);
  EXPECT_THROW(surfaceMethodFor({"bezier", {}, 0.99}), UsageError);
}

}  // namespace
}  // namespace meniscus

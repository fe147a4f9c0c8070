#pragma once
// Draws metaball surfaces with a method and judges the picture by the truth (core/reference_tracer.h).

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <string>

#include "core/hit_errors.h"
#include "core/reference_tracer.h"
#include "render/renderer.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/surface_scenes.h"

namespace meniscus::test {

inline SurfaceSettings options(std::map<std::string, double> parameters = {}) {
  return {"bezier", std::move(parameters)};
}

class SurfaceTest : public GlTest {
 protected:
  HitImage draw(const SurfaceScene& scene, const View& view, const SurfaceSettings& settings,
                QuadricMethod quadrics = QuadricMethod::automatic) {
    Renderer renderer;
    renderer.setPrimitives(scene.primitives);
    HitImage image =
        renderer.renderHits(view, {.distance = true, .normal = true, .id = true}, settings, quadrics);
    const RenderStats all = renderer.stats();
    stats = all.surfaces.empty() ? SurfaceStats{} : all.surfaces.front();
    return image;
  }

  HitErrors judge(const SurfaceScene& scene, const View& view, const SurfaceSettings& settings,
                  const std::string& name = {}) {
    const HitImage image = draw(scene, view, settings);
    const HitErrors e =
        compareHits(image, traceReference(scene.primitives->surfaces, scene.primitives->origin, view));
    const std::string text = fmt::format(
        "compared {} missed {} false {} grazing {} (disputed {}) relative rms {:.2g} largest {:.2g} A "
        "normals {:.2g} "
        "(largest {:.2g}) degrees, ids differ {}",
        e.compared, e.missed, e.falseHits, e.grazing, e.grazingDisputes, e.relativeRms, e.largestDistance,
        e.normalRmsDeg, e.largestNormalDeg, e.idsDiffer);
    RecordProperty(name.empty() ? fmt::format("errors{}", judged_++) : name, text);
    if (std::getenv("MENISCUS_SURFACE_ERRORS")) fmt::print("  {} {}\n", name, text);
    return e;
  }

  static void expectExact(const HitErrors& e) {
    EXPECT_EQ(e.missed, 0u);
    EXPECT_EQ(e.falseHits, 0u);
    EXPECT_GT(e.compared, 0u);
    EXPECT_LE(e.relativeRms, 1e-5);
    EXPECT_LE(e.normalRmsDeg, 0.05);
  }

  /// The same picture, put together from many.
  static HitImage drawInTiles(const SurfaceScene& scene, const View& view, const SurfaceSettings& settings) {
    RendererOptions small;
    small.maxTileSize = 33;
    Renderer renderer(small);
    renderer.setPrimitives(scene.primitives);
    return renderer.renderHits(view, {}, settings);
  }

  void expectAnyTilesGiveTheSameBytes(const SurfaceSettings& settings) {
    const SurfaceScene scene = randomScene(150, 3);
    const View view = viewOf(scene, {90, 70});
    const HitImage whole = draw(scene, view, settings), parts = drawInTiles(scene, view, settings);
    EXPECT_EQ(parts.id, whole.id);
    EXPECT_EQ(parts.distance, whole.distance);
    EXPECT_EQ(draw(scene, view, settings).distance, whole.distance) << "the same every time";
  }

  /// Spheres and two surfaces: of each pixel the nearer one. `tolerance` of a distance [Å]: what a method may
  /// differ by from itself when something else lies in front.
  void expectSpheresAndSurfacesHideEachOther(const SurfaceSettings& settings,
                                             QuadricMethod quadrics = QuadricMethod::automatic,
                                             float tolerance = 0) {
    const SurfaceScene scene = twoSurfaces();
    const View view = viewOf(scene, {96, 72});
    const HitImage surfaces = draw(scene, view, settings, quadrics);
    auto spheres = std::make_shared<Primitives>();
    spheres->origin = scene.primitives->origin;
    spheres->spheres = spheresAmongSurfaces();
    const HitImage alone = draw({spheres}, view, settings, quadrics);
    scene.primitives->spheres = spheres->spheres;
    const HitImage both = draw(scene, view, settings, quadrics);
    int fromSpheres = 0, fromSurfaces = 0;
    for (std::size_t i = 0; i < both.id.size(); ++i) {
      const bool sphere = alone.distance[i] < surfaces.distance[i];
      if (std::abs(alone.distance[i] - surfaces.distance[i]) < 1e-4f) continue;
      EXPECT_EQ(both.id[i], sphere ? alone.id[i] : surfaces.id[i]);
      const float expected = sphere ? alone.distance[i] : surfaces.distance[i];
      if (tolerance == 0 || both.id[i] == 0) {
        EXPECT_EQ(both.distance[i], expected);
      } else {
        EXPECT_NEAR(both.distance[i], expected, tolerance);
      }
      if (both.id[i] != 0) ++(sphere ? fromSpheres : fromSurfaces);
    }
    EXPECT_GT(fromSpheres, 100);
    EXPECT_GT(fromSurfaces, 100);
  }

  /// Touching without crossing is no hit, and is never looped on.
  void expectTangentRaysMiss(const SurfaceSettings& settings) {
    const auto [scene, view] = tangentRays();
    const HitImage image = draw(scene, view, settings);
    ASSERT_EQ(image.id.size(), 15u * 15u);
    // Of two balls' sum, which is the level to the last bit, rounding decides.
    for (std::size_t i = 0; i < image.id.size(); ++i)
      EXPECT_TRUE(i == image.id.size() / 2 || image.id[i] == 0) << i;
    EXPECT_EQ(stats.notConverged, 0u);
  }

  double detail(const std::string& name) const {
    for (const auto& [what, value] : stats.details)
      if (what == name) return value;
    ADD_FAILURE() << "no detail " << name;
    return 0;
  }

  SurfaceStats stats;

 private:
  int judged_ = 0;
};

}  // namespace meniscus::test

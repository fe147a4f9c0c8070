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
  HitImage draw(const SurfaceScene& scene, const View& view, const SurfaceSettings& settings) {
    Renderer renderer;
    renderer.setPrimitives(scene.primitives);
    HitImage image = renderer.renderHits(view, {.distance = true, .normal = true, .id = true}, settings);
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

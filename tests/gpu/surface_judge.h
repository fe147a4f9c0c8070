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
#include "tests/support/exact_field.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/random.h"

namespace meniscus::test {

inline SurfaceSettings options(std::map<std::string, double> parameters = {}) {
  return {"bezier", std::move(parameters)};
}

struct SurfaceScene {
  std::shared_ptr<Primitives> primitives;
  SurfaceScene(std::shared_ptr<Primitives> p) : primitives(std::move(p)) {}
  explicit SurfaceScene(const MetaballField& field) : primitives(std::make_shared<Primitives>()) {
    primitives->surfaces.push_back(field);
  }
};

/// Balls of random radii in a ball, as dense as a protein, each with another colour.
inline SurfaceScene randomScene(unsigned count, unsigned seed) {
  Random random(seed);
  MetaballField field;
  const double extent = 1.6 * std::cbrt(count);
  while (field.balls.size() < count) {
    const glm::dvec3 p = random.inBox(1);
    if (glm::length(p) > 1) continue;
    field.balls.push_back({glm::vec3(p * extent), static_cast<float>(2 * random.uniform(1, 2)), 1.0f,
                           static_cast<std::uint32_t>(random.bits() & 0xFFFFFFu),
                           static_cast<std::uint32_t>(field.balls.size() + 1)});
  }
  SurfaceScene scene(field);
  scene.primitives->origin = {31.5, -12.25, 1000.125};
  return scene;
}

/// From the outside, all of it in the picture.
inline View viewOf(const SurfaceScene& scene, ImageSize size,
                   Projection projection = Projection::perspective) {
  const BoundingSphere bounds = scene.primitives->bounds();
  Camera camera;
  camera.projection = projection;
  camera.target = bounds.center;
  camera.distance = 3 * bounds.radius;
  camera.fovY = 2 * std::atan(0.34);
  camera.orientation = glm::normalize(glm::dquat(0.9, 0.2, -0.3, 0.1));
  return makeView(camera, size, bounds);
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

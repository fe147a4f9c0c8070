// The surface as triangles through the renderer: what a pixel shows is what its ray meets of the triangles,
// and the finer the grid, the nearer that is to the truth.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/mesh/surface_mesh.h"
#include "tests/gpu/surface_judge.h"

namespace meniscus {
namespace {

using test::SurfaceScene;

SurfaceSettings meshOf(double spacing) {
  return {"mesh", {{"spacing", spacing}}};
}

class MeshMethod : public test::SurfaceTest {
 protected:
  static double nearestOf(const SurfaceMesh& mesh, const SurfaceScene& scene, const View& view,
                          glm::dvec2 pixel);
  void expectExactToTheTriangle(const SurfaceScene& scene, const View& view, double spacing);
};

// Along the ray, behind the near plane; in double precision, triangle by triangle.
double MeshMethod::nearestOf(const SurfaceMesh& mesh, const SurfaceScene& scene, const View& view,
                             glm::dvec2 pixel) {
  const Ray ray = rayThrough(view, pixel);
  double best = std::numeric_limits<double>::infinity();
  const auto place = [&](std::uint32_t i) {
    return view.rotation * ((scene.primitives->origin - view.pivot) + glm::dvec3(mesh.vertices[i].position));
  };
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a = place(t.x), ab = place(t.y) - a, ac = place(t.z) - a, from = ray.origin - a;
    const glm::dvec3 p = glm::cross(ray.direction, ac), q = glm::cross(from, ab);
    const double volume = glm::dot(ab, p);
    if (volume == 0) continue;
    const double u = glm::dot(from, p) / volume, v = glm::dot(ray.direction, q) / volume;
    if (u < 0 || v < 0 || u + v > 1) continue;
    const double s = glm::dot(ac, q) / volume;
    if (s > 0 && s < best && (ray.origin + s * ray.direction).z <= view.nearZ) best = s;
  }
  return best;
}

void MeshMethod::expectExactToTheTriangle(const SurfaceScene& scene, const View& view, double spacing) {
  const SurfaceMesh mesh = meshSurface(scene.primitives->surfaces.front(), {.spacing = spacing});
  const HitImage image = draw(scene, view, meshOf(spacing));
  int hits = 0, exact = 0, different = 0;
  for (int y = 0; y < view.size.height; ++y) {
    for (int x = 0; x < view.size.width; ++x) {
      const float drawn =
          image.distance[static_cast<std::size_t>(y) * static_cast<std::size_t>(view.size.width) +
                         static_cast<std::size_t>(x)];
      const double truth = nearestOf(mesh, scene, view, {x + 0.5, y + 0.5});
      hits += std::isfinite(truth) ? 1 : 0;
      if (std::isfinite(truth) && std::abs(static_cast<double>(drawn) - truth) <= 2e-6 * (truth + 1)) {
        ++exact;
      } else if (std::isfinite(truth) || std::isfinite(drawn)) {
        ++different;
      }
    }
  }
  EXPECT_GT(hits, 300);
  // Rims, which the driver's grid of pixels moves by 1/512 of a pixel.
  EXPECT_LE(different, 1 + hits / 100) << exact << " exact of " << hits;
}

TEST_F(MeshMethod, APixelShowsItsTriangle) {
  const SurfaceScene scene = test::randomScene(60, 4);
  for (const Projection projection : {Projection::perspective, Projection::orthographic})
    expectExactToTheTriangle(scene, viewOf(scene, {48, 36}, projection), 1.0);
  // Within the surface: the inner wall.
  Camera camera;
  camera.target = scene.primitives->origin;
  camera.distance = 0.3;
  camera.fovY = 1.4;
  expectExactToTheTriangle(scene, makeView(camera, {48, 36}, scene.primitives->bounds()), 1.0);
  View cut = viewOf(scene, {48, 36});  // by the near plane
  cut.nearZ = 0;
  expectExactToTheTriangle(scene, cut, 1.0);
  expectExactToTheTriangle(scene, viewFromAfar(scene, {48, 36}), 1.0);
}

TEST_F(MeshMethod, ErrorFallsWithTheSpacing) {
  const SurfaceScene scene = test::randomScene(300, 2);
  double before = 1e9;
  for (const double spacing : {2.0, 1.0, 0.5, 0.25}) {
    const View view = viewOf(scene, {96, 72});
    const HitErrors e = judge(scene, view, meshOf(spacing), "spacing" + std::to_string(spacing));
    EXPECT_LT(e.distanceP99, before);
    before = e.distanceP99;
    if (spacing > 0.3) continue;
    EXPECT_LT(e.relativeRms, 2e-3);
    EXPECT_LT(e.distanceP99, 0.1);
    EXPECT_LT(e.normalRmsDeg, 3);
    EXPECT_LT(e.missed + e.falseHits, e.compared / 100);
    EXPECT_LT(e.idsDiffer, e.compared / 20);
  }
  EXPECT_GT(detail("vertices"), 5000);
}

TEST_F(MeshMethod, SpheresAndMeshesHideEachOther) {
  SurfaceScene scene = test::randomScene(60, 12);
  scene.primitives->spheres.push_back({{0, 0, 0}, 4.5f, 0xFFFFFF, 1000});
  const View view = viewOf(scene, {64, 48});
  const HitImage both = draw(scene, view, meshOf(0.5));
  const auto ofSphere = std::count(both.id.begin(), both.id.end(), 1000u);
  EXPECT_GT(ofSphere, 20);
  EXPECT_LT(ofSphere, 64 * 48 / 2);
  EXPECT_GT(std::count_if(both.id.begin(), both.id.end(), [](auto id) { return id > 0 && id < 1000; }), 100);
}

TEST_F(MeshMethod, AnyTilesOfTheTargetGiveTheSameSurface) {
  const SurfaceScene scene = test::randomScene(100, 3);
  const View view = viewOf(scene, {90, 70});
  const HitImage whole = draw(scene, view, meshOf(0.7));
  const HitImage parts = drawInTiles(scene, view, meshOf(0.7));
  std::size_t different = 0;
  for (std::size_t i = 0; i < whole.id.size(); ++i)
    different += whole.distance[i] != parts.distance[i] || whole.id[i] != parts.id[i] ? 1 : 0;
  EXPECT_LE(different, whole.id.size() / 500) << "rims only";
}

TEST_F(MeshMethod, WhatIsTooLargeIsRefused) {
  MetaballField field;
  field.balls = {{{0, 0, 0}, 5000, 1, 0, 1}};
  const SurfaceScene scene(field);
  EXPECT_THROW(draw(scene, viewOf(scene, {16, 12}), meshOf(0.1)), InputError);
}

}  // namespace
}  // namespace meniscus

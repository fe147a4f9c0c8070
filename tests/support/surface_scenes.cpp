#include "tests/support/surface_scenes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/assembly.h"
#include "io/structure_reader.h"
#include "tests/support/exact_field.h"
#include "tests/support/paths.h"
#include "tests/support/random.h"

namespace meniscus::test {

View viewOf(const SurfaceScene& scene, ImageSize size, Projection projection) {
  const BoundingSphere bounds = scene.primitives->bounds();
  Camera camera;
  camera.projection = projection;
  camera.target = bounds.center;
  camera.distance = 3 * bounds.radius;
  camera.fovY = 2 * std::atan(0.34);
  camera.orientation = glm::normalize(glm::dquat(0.9, 0.2, -0.3, 0.1));
  return makeView(camera, size, bounds);
}

SurfaceScene randomScene(unsigned count, unsigned seed) {
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

SurfaceScene moleculeScene(const std::filesystem::path& file) {
  Logger logger;
  StructureOptions read;
  read.waters = Waters::automatic;
  Molecule molecule = readStructure(file.string(), read, logger).models.front();
  SceneObject object;
  object.molecule = std::make_shared<const Molecule>(std::move(molecule));
  object.placements = placeOnce(*object.molecule);
  object.representation = Representation::surface;
  Scene all;
  all.objects = {object};
  return {std::make_shared<Primitives>(buildPrimitives(all))};
}

std::vector<std::filesystem::path> moleculeFiles() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(projectFile("molecules")))
    if (entry.path().extension() != ".md") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

SurfaceScene coincidentBalls() {
  MetaballField field;
  for (unsigned i = 1; i <= 200; ++i) field.balls.push_back({{0.25f, -0.5f, 1}, 2.0f, 0.01f, 0x808080, i});
  return SurfaceScene(field);
}

SurfaceScene nearlyCoincidentBalls(unsigned count, double apart, double sum) {
  Random random(4);
  MetaballField field;
  for (unsigned i = 1; i <= count; ++i)
    field.balls.push_back({glm::vec3(glm::dvec3(0.25, -0.5, 1) + random.inBox(apart)), 2.0f,
                           static_cast<float>(sum / count), 0x808080, i});
  return SurfaceScene(field);
}

SurfaceView ballsAlongOneRay() {
  MetaballField field;
  for (unsigned i = 0; i < 1000; ++i) {
    const float z = 60 - 0.12f * static_cast<float>(i);
    const float q = i < 990 ? 0.005f : 1.0f;
    field.balls.push_back({{0.01f * static_cast<float>(i % 7), 0, z}, 2.0f, q, 0x808080, i + 1});
  }
  View view = alongZ(0, 0, 70);
  view.size = {12, 9};
  view.pixelSize = 0.4;
  view.center = {6, 4.5};
  return {SurfaceScene(field), view};
}

SurfaceView latticeAlongAxis() {
  MetaballField field;
  for (unsigned i = 0; i < 512; ++i) {
    const glm::vec3 at(i % 8, i / 8 % 8, i / 64);
    field.balls.push_back({(at - 3.5f) * 1.5f, 2.5f, 0.4f, 0x808080, i + 1});
  }
  View view = alongZ(0, 0, 20);
  view.size = {64, 48};
  view.pixelSize = 0.375;  // every fourth ray meets a row of centres
  view.center = {32.5, 24.5};
  return {SurfaceScene(field), view};
}

View latticeInPerspective(const SurfaceScene& lattice) {
  Camera camera;
  camera.distance = 40;
  camera.fovY = 0.5;
  return makeView(camera, {64, 48}, lattice.primitives->bounds());
}

SurfaceView insideOfCavity() {
  MetaballField cavity;
  cavity.balls = {{{0, 0, 0}, 6.0f, 1.0f, 0xFF0000, 1}, {{0.5f, 0, 0}, 2.0f, -2.0f, 0x00FF00, 2}};
  const SurfaceScene scene(cavity);
  Camera camera;
  camera.target = {0.5, 0, 0};
  camera.distance = 0.3;
  camera.fovY = 1.5;
  return {scene, makeView(camera, {64, 48}, scene.primitives->bounds())};
}

std::vector<View> viewsFromInside(const SurfaceScene& scene) {
  std::vector<View> views;
  Random random(9);
  for (int i = 0; i < 6; ++i) {
    Camera camera;
    camera.projection = i == 5 ? Projection::orthographic : Projection::perspective;
    camera.target = scene.primitives->origin + random.inBox(4);
    camera.orientation = random.rotation();
    camera.distance = i == 0 ? 1e-3 : random.uniform(0.1, 9);
    camera.fovY = random.uniform(0.5, 1.6);
    View view = makeView(camera, {64, 48}, scene.primitives->bounds());
    if (i >= 4) view.nearZ = random.uniform(-3, 3);  // cut open by the near plane
    view.farZ = std::min(view.farZ, view.nearZ - 1);
    views.push_back(view);
  }
  return views;
}

SurfaceScene twoSurfaces() {
  SurfaceScene scene = randomScene(60, 12);
  scene.primitives->surfaces.push_back(randomField({}, 0.4, 40, 6, 0, 13));
  for (Metaball& ball : scene.primitives->surfaces[1].balls) ball.id += 60;
  return scene;
}

std::vector<SpherePrimitive> spheresAmongSurfaces() {
  std::vector<SpherePrimitive> spheres;
  Random random(14);
  for (unsigned i = 0; i < 30; ++i)
    spheres.push_back(
        {glm::vec3(random.inBox(6)), static_cast<float>(random.uniform(0.5, 2)), 0xFFFFFF, 101 + i});
  return spheres;
}

SurfaceScene manyScales() {
  Random random(21);
  MetaballField field;
  for (unsigned i = 1; i <= 120; ++i) {
    const double support = i == 1 ? 1e3 : i == 2 ? 1e-3 : random.logUniform(1e-3, 1e3);
    // Around the smallest ball, at distances of the size of each.
    const glm::dvec3 at = i == 2 ? glm::dvec3(0) : random.direction() * support * random.uniform(0.5, 1.5);
    field.balls.push_back({glm::vec3(at), static_cast<float>(support), 1.0f, 0x808080, i});
  }
  field.level = 0.9;
  return SurfaceScene(field);
}

View viewOfScale(const SurfaceScene& scene, double radius) {
  Camera camera;
  camera.distance = 4 * radius;
  camera.fovY = 0.6;
  return makeView(camera, {64, 48}, scene.primitives->bounds());
}

View viewFromAfar(const SurfaceScene& scene, ImageSize size) {
  View view = viewOf(scene, size);
  const double before = view.distance;
  view.distance = 1e4;
  view.pixelSize *= before / view.distance;
  return view;
}

View viewOfAngle(const SurfaceScene& scene, double degrees) {
  const double radius = scene.primitives->bounds().radius;
  Camera camera;
  camera.target = scene.primitives->origin;
  camera.fovY = degrees * 3.14159265358979 / 180;
  camera.distance = degrees < 90 ? radius / std::sin(camera.fovY / 2) : 0.9 * radius;
  camera.orientation = glm::normalize(glm::dquat(0.9, 0.2, -0.3, 0.1));
  return makeView(camera, {96, 72}, scene.primitives->bounds());
}

SurfaceView nearMaximum(unsigned balls, double below) {
  MetaballField field;
  field.level = balls * (1 - below);
  for (unsigned i = 1; i <= balls; ++i) field.balls.push_back({{3, 1, -2}, 2.0f, 1.0f, 0x808080, i});
  const SurfaceScene scene(field);
  Camera camera;
  camera.target = {3, 1, -2};
  camera.distance = 10;
  camera.fovY = 0.6 * std::sqrt(std::abs(below));
  return {scene, makeView(camera, {64, 48}, scene.primitives->bounds())};
}

SurfaceView tangentRays() {
  MetaballField field;
  field.level = 1;  // reached at the centres alone
  for (unsigned i = 0; i < 9; ++i)
    field.balls.push_back({{3 * static_cast<float>(i % 3) - 3, 3 * static_cast<float>(i / 3) - 3, 0},
                           1.0f,
                           1.0f,
                           0x808080,
                           i + 1});
  field.balls.push_back({{0, 0, 3}, 1.0f, 0.5f, 0x808080, 10});
  field.balls.push_back({{0, 0, 3}, 1.0f, 0.5f, 0x808080, 11});
  View view = alongZ(0, 0, 10);
  view.size = {15, 15};
  view.pixelSize = 0.5;
  view.center = {7.5, 7.5};
  return {SurfaceScene(field), view};
}

}  // namespace meniscus::test

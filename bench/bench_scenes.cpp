#include "bench/bench_scenes.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>

#include "core/bonds.h"
#include "core/camera_fit.h"
#include "io/structure_reader.h"

namespace meniscus::bench {

namespace {

// The first `count` atoms, and the bonds between them.
void keepFirst(Primitives& primitives, std::size_t count) {
  if (primitives.spheres.size() <= count) return;
  primitives.spheres.resize(count);
  const std::uint32_t lastId = primitives.spheres.back().id;
  std::erase_if(primitives.cylinders,
                [&](const CylinderPrimitive& c) { return c.idA > lastId || c.idB > lastId; });
}

void splitBonds(Primitives& primitives) {
  std::vector<CylinderPrimitive> halves;
  for (const CylinderPrimitive& c : primitives.cylinders) {
    const glm::vec3 middle = 0.5f * (c.a + c.b);
    halves.push_back({c.a, c.radius, middle, c.colorA, c.colorA, c.idA, c.idA});
    halves.push_back({middle, c.radius, c.b, c.colorB, c.colorB, c.idB, c.idB});
  }
  primitives.cylinders = std::move(halves);
}

}  // namespace

BenchScene loadScene(const SceneSource& source, ImageSize size) {
  StructureOptions options;
  options.altlocs = Altlocs::first;
  options.waters = Waters::automatic;
  Logger logger;
  StructureFile structure =
      readStructure(std::filesystem::path(MENISCUS_MOLECULES) / source.file, options, logger);
  Molecule& molecule = structure.models.front();
  if (needsBonds(source.representation)) addMissingBonds(molecule, logger);

  SceneObject object;
  object.molecule = std::make_shared<const Molecule>(std::move(molecule));
  object.placements = replicate(*object.molecule, placeOnce(*object.molecule), source.copies);
  object.representation = source.representation;
  Scene scene;
  scene.objects = {object};
  auto primitives = std::make_shared<Primitives>(buildPrimitives(scene));
  if (source.atoms > 0) keepFirst(*primitives, source.atoms);
  if (source.splitBonds) splitBonds(*primitives);

  std::vector<FitSphere> fit;
  for (const SpherePrimitive& s : primitives->spheres)
    fit.push_back({primitives->origin + glm::dvec3(s.center), static_cast<double>(s.radius)});
  Camera camera;
  camera.orientation = principalAxes(fit, false);
  const View view = makeView(fitted(camera, size, fit), size, primitives->bounds());
  return {primitives, view};
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double processorMs(const std::function<void()>& call) {
  const std::clock_t start = std::clock();
  call();
  return 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

double wallMs(const std::function<void()>& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

double detail(const SurfaceStats& stats, std::string_view name) {
  for (const auto& [what, value] : stats.details)
    if (what == name) return value;
  return 0;
}

}  // namespace meniscus::bench

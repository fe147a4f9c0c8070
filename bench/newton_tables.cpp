// The method "newton": where the poster's iteration fails, over iterations and terms; how wrong the ambient
// field is, over terms and resolution. Prints rows of docs/measured/newton.csv.
//
//   newton_tables

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "bench/surface_errors.h"
#include "core/ambient_field.h"
#include "core/mesh/surface_mesh.h"
#include "render/gl/context.h"

namespace meniscus::bench {
namespace {

using Parameters = std::map<std::string, double>;

void print(const char* what, const std::string& scene, const Parameters& p, const SurfaceResult& r,
           double fieldRms = 0, double fieldLargest = 0, double ambientMs = 0) {
  const auto value = [&](const char* name, double otherwise) {
    const auto at = p.find(name);
    return at == p.end() ? otherwise : at->second;
  };
  fmt::print("{},{},{},{},{},{:.1f},{},{},{},{},{},{},{},{:.3g},{:.3g},{:.3g},{:.3g},{:.3g},{:.1f}\n", what,
             scene, value("iterations", 0), value("terms", 0), value("ambient", 0), r.drawMs, r.hits,
             r.stats.pixels, r.stats.notConverged, r.errors.missed, r.errors.falseHits, r.wrongSheet,
             r.stats.iterations, r.errors.relativeRms, r.errors.distanceP99, r.errors.largestDistance,
             fieldRms, fieldLargest, ambientMs);
  std::fflush(stdout);
}

void measureIterations(const std::string& name, const BenchScene& scene, const ReferenceImage& truth) {
  // The poster's iteration runs in every hull, seen or not: large scenes take minutes.
  const bool large = scene.primitives->surfaces.front().balls.size() > 1000;
  for (const double terms : large ? std::vector<double>{0} : std::vector<double>{0, 8, 4, 2, 1}) {
    for (const double iterations : {1, 2, 3, 4, 6, 8, 12, 16, 32, 64}) {
      const Parameters p{
          {"safeguard", 0}, {"debug", 0}, {"iterations", iterations}, {"terms", terms}, {"ambient", 128}};
      print("plain", name, p, drawSurface(scene, truth, {"newton", p}));
    }
  }
  print("safeguarded", name, {}, drawSurface(scene, truth, {"newton", {}}));
}

// At points of the surface, as shares of the level.
void measureAmbient(const std::string& name, const BenchScene& scene, const ReferenceImage& truth) {
  const MetaballField& field = scene.primitives->surfaces.front();
  const SurfaceMesh mesh = meshSurface(field, {.spacing = 1});
  const std::size_t step = std::max<std::size_t>(mesh.vertices.size() / 2000, 1);
  for (const int terms : {1, 2, 4, 8}) {
    for (const int cells : {0, 16, 32, 64, 128, 256}) {
      double squares = 0, largest = 0, ms = 0;
      std::size_t count = 0;
      AmbientField grid;
      if (cells > 0) ms = processorMs([&] { grid = makeAmbientField(field, terms, cells); });
      for (std::size_t i = 0; i < mesh.vertices.size(); i += step, ++count) {
        const glm::dvec3 at(mesh.vertices[i].position);
        const double error =
            std::abs((cells > 0 ? grid.at(at) : 0) - restOfField(field, terms, at)) / field.level;
        squares += error * error;
        largest = std::max(largest, error);
      }
      const Parameters p{{"terms", static_cast<double>(terms)}, {"ambient", static_cast<double>(cells)}};
      print("ambient", name, p, drawSurface(scene, truth, {"newton", p}),
            std::sqrt(squares / static_cast<double>(count)), largest, ms);
    }
  }
}

}  // namespace
}  // namespace meniscus::bench

int main() {
  using namespace meniscus;
  try {
    const auto context = Context::create(Backend::automatic);
    fmt::print(
        "what,scene,iterations,terms,cells,draw_cpu_ms,hits,rays,not_converged,missed,false,wrong_sheet,"
        "iterations_made,relative_rms,p99_angstrom,largest_angstrom,field_rms,field_largest,ambient_cpu_"
        "ms\n");
    constexpr ImageSize kSize{320, 240};
    for (const auto& [name, file] :
         {std::pair{"ubiquitin", "1ubq.pdb"}, std::pair{"hemoglobin", "2hhb.pdb.gz"}}) {
      const bench::BenchScene scene =
          bench::loadScene({.file = file, .representation = Representation::surface}, kSize);
      const ReferenceImage truth = bench::truthOf(scene);
      bench::measureIterations(name, scene, truth);
      if (scene.primitives->surfaces.front().balls.size() <= 1000) bench::measureAmbient(name, scene, truth);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "newton_tables: %s\n", error.what());
    return 1;
  }
  return 0;
}

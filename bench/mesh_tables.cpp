// The surface as triangles against the truth: error, size and time over the spacing of the grid. Prints rows
// of docs/measured/mesh.csv.
//
//   mesh_tables

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "bench/surface_errors.h"
#include "core/generated_scenes.h"
#include "core/mesh/surface_mesh.h"
#include "render/gl/context.h"

namespace meniscus::bench {
namespace {

// Of half edges, those without the one in the other direction, or twice in the same.
std::size_t openEdges(const SurfaceMesh& mesh) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const glm::uvec3& t : mesh.triangles)
    for (glm::length_t k = 0; k < 3; ++k) edges.emplace_back(t[k], t[(k + 1) % 3]);
  std::sort(edges.begin(), edges.end());
  std::size_t open = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const bool twice = i > 0 && edges[i] == edges[i - 1];
    const bool pair =
        std::binary_search(edges.begin(), edges.end(), std::pair{edges[i].second, edges[i].first});
    open += twice || !pair ? 1 : 0;
  }
  return open;
}

void measure(const std::string& name, const BenchScene& scene) {
  const ReferenceImage truth = truthOf(scene);
  const std::size_t balls = scene.primitives->surfaces.front().balls.size();
  for (const double spacing : {2.0, 1.0, 0.5, 0.25, 0.125}) {
    if (balls > 50000 && spacing < 0.5) continue;  // more than is drawn
    SurfaceMesh mesh;
    std::vector<double> times;
    for (int i = 0; i < (balls > 50000 ? 1 : 3); ++i)
      times.push_back(
          processorMs([&] { mesh = meshSurface(scene.primitives->surfaces.front(), {.spacing = spacing}); }));
    const SurfaceResult r = drawSurface(scene, truth, {"mesh", {{"spacing", spacing}}});
    fmt::print("{},{},{},{},{},{},{:.1f},{:.1f},{:.0f},{},{},{:.3g},{:.3g},{:.3g},{:.3g},{:.3g},{:.4f}\n",
               name, balls, spacing, mesh.vertices.size(), mesh.triangles.size(), openEdges(mesh),
               median(times), r.drawMs, r.hits, r.errors.missed, r.errors.falseHits, r.errors.relativeRms,
               r.rmsDistance, r.errors.distanceP99, r.errors.largestDistance, r.errors.normalRmsDeg,
               static_cast<double>(r.errors.idsDiffer) / static_cast<double>(r.errors.compared));
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace meniscus::bench

int main() {
  using namespace meniscus;
  try {
    const auto context = Context::create(Backend::automatic);
    fmt::print(
        "scene,balls,spacing,vertices,triangles,open_edges,mesh_cpu_ms,draw_cpu_ms,hits,missed,false,"
        "relative_"
        "rms,rms_angstrom,p99_angstrom,largest_angstrom,normal_rms_deg,ids_differ\n");
    constexpr ImageSize kSize{640, 480};
    for (const auto& [name, file] : {std::pair{"ubiquitin", "1ubq.pdb"},
                                     std::pair{"hemoglobin", "2hhb.pdb.gz"}, std::pair{"C60", "c60.pdb"}})
      bench::measure(name,
                     bench::loadScene({.file = file, .representation = Representation::surface}, kSize));
    bench::BenchScene packed;
    packed.primitives = packedBalls(100000, 1);
    packed.view = viewOfAll(*packed.primitives, kSize);
    bench::measure("packed balls", packed);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "mesh_tables: %s\n", error.what());
    return 1;
  }
  return 0;
}

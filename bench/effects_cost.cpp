// What each pass of a picture with every effect costs, in units of drawing its quadrics.
//
//   effects_cost [structure] [repetitions] [shader folder] > effects_cost.csv
//
// 1024 x 768, one ray per pixel, the settings of --style full. Times are medians over repetitions of one run;
// each pass is waited for before the next begins. "post" is everything after the quadrics: shadow, occlusion,
// depth unsharp masking, lines, shading. The maps that belong to the scene and not to its pixels are apart.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>

#include "bench/bench_scenes.h"
#include "render/gl/context.h"
#include "render/renderer.h"

namespace meniscus::bench {
namespace {

constexpr ImageSize kSize{1024, 768};

// As --style full.
RenderSettings allEffects() {
  RenderSettings settings;
  settings.quadrics = QuadricMethod::splat;  // the unit that the costs are given in
  settings.samples = 1;
  settings.shadows.mode = ShadowMode::soft;
  settings.occlusion.on = true;
  settings.lines.silhouettes = true;
  settings.lines.width = 1;
  settings.depthUnsharp.mode = UnsharpMode::halo;
  settings.fog.strength = 0.4;
  return settings;
}

enum class Part { quadrics, maps, post };

Part partOf(const std::string& pass) {
  if (pass.starts_with("shadow map") || pass == "occlusion maps") return Part::maps;
  for (const char* quadrics : {"spheres", "cylinders", "ellipsoids"}) {
    if (pass == quadrics) return Part::quadrics;
  }
  return Part::post;
}

void measure(const std::string& file, Representation representation, int repetitions,
             const std::string& shaderDir) {
  const BenchScene scene = loadScene({file, representation}, kSize);
  Renderer renderer(RendererOptions{
      .shaderDir = shaderDir, .timePasses = true, .maxTileSize = 0, .effectsOnProcessor = false});
  renderer.setPrimitives(scene.primitives);
  std::map<std::string, std::vector<double>> ms;
  std::vector<double> post, ratio;
  for (int repetition = -1; repetition < repetitions; ++repetition) {  // the first warms up
    std::map<std::string, double> before;
    for (const PassStats& pass : renderer.stats().passes) before[pass.name] = pass.milliseconds;
    NullSink sink;
    renderer.renderPicture(scene.view, Lighting{}, Background{}, allEffects(), PixelFormat::rgba8, sink);
    if (repetition < 0) continue;
    double sum = 0, quadrics = 0;
    for (const PassStats& pass : renderer.stats().passes) {
      const double spent = pass.milliseconds - before[pass.name];
      ms[pass.name].push_back(spent);
      if (partOf(pass.name) == Part::post) sum += spent;
      if (partOf(pass.name) == Part::quadrics) quadrics += spent;
    }
    post.push_back(sum);
    ratio.push_back(sum / quadrics);
  }
  const std::size_t count = scene.primitives->spheres.size();
  double quadrics = 0;
  for (const auto& [pass, times] : ms) {
    if (partOf(pass) == Part::quadrics) quadrics += median(times);
  }
  const auto print = [&](const std::string& pass, const char* part, double time, double share) {
    fmt::print("\"{}\",{},\"{}\",{},{:.2f},{:.3f}\n", file.substr(file.rfind('/') + 1), count, pass, part,
               time, share);
  };
  for (const auto& [pass, times] : ms) {
    const Part part = partOf(pass);
    print(pass,
          part == Part::maps       ? "maps"
          : part == Part::quadrics ? "quadrics"
                                   : "post",
          median(times), median(times) / quadrics);
  }
  print("all post passes", "sum", median(post), median(ratio));
  std::fflush(stdout);
}

}  // namespace
}  // namespace meniscus::bench

int main(int argc, char** argv) {
  using namespace meniscus;
  try {
    const std::string file = argc > 1 ? argv[1] : "7ddo.pdb.gz";
    const int repetitions = argc > 2 ? std::max(1, std::atoi(argv[2])) : 5;
    const auto context = Context::create(Backend::automatic);
    fmt::print("structure,spheres,pass,part,ms,per_quadrics\n");
    bench::measure(file, Representation::spacefill, repetitions, argc > 3 ? argv[3] : "");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "effects_cost: %s\n", error.what());
    return 1;
  }
  return 0;
}

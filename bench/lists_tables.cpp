// Table 1 of Szécsi and Illés 2012 beside ours: sort, depth, gather and cast for so many balls at 1024×768,
// with the same scene by the methods "bezier" and "tiles", and the errors of exact and of cubic pieces.
// Prints rows of docs/measured/lists.csv; times are of the processor, all threads together.
//
//   lists_tables [repetitions] [largest number of balls] [largest number of balls for bezier]

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "bench/bench_scenes.h"
#include "core/generated_scenes.h"
#include "core/hit_errors.h"
#include "core/reference_tracer.h"
#include "render/gl/context.h"
#include "render/renderer.h"

namespace meniscus::bench {
namespace {

constexpr ImageSize kSize{1024, 768};
constexpr const char* kParts[] = {"sort", "depth", "gather", "cast"};

struct Run {
  double ms = 0;  // processor time of a whole picture's hits
  std::map<std::string, double> parts;
  SurfaceStats stats;
  HitImage hits;
};

// The balls fill the picture, as the paper's do.
View viewOf(const Primitives& primitives) {
  View view = viewOfAll(primitives, kSize);
  view.pixelSize /= 1.5;
  return view;
}

Run draw(const std::shared_ptr<const Primitives>& primitives, const View& view,
         const SurfaceSettings& settings, int repetitions) {
  RendererOptions options;
  options.timePasses = true;
  Renderer renderer(options);
  renderer.setPrimitives(primitives);
  Run run;
  std::vector<double> times;
  std::map<std::string, std::vector<double>> parts;
  for (int i = 0; i <= repetitions; ++i) {  // the first compiles the programs, too
    renderer.forgetStats();
    const double ms = processorMs([&] {
      run.hits = renderer.renderHits(view, {true, true, true}, settings);
    });
    const RenderStats stats = renderer.stats();
    run.stats = stats.surfaces.at(0);
    if (i == 0 && repetitions > 0) continue;
    times.push_back(ms);
    for (const PassStats& pass : stats.passes) parts[pass.name].push_back(pass.processorMs);
  }
  run.ms = median(times);
  for (const auto& [name, values] : parts) run.parts[name] = median(values);
  return run;
}

void print(std::size_t balls, const char* method, const Run& run, const ReferenceImage* truth) {
  fmt::print("{},{},{:.0f}", balls, method, run.ms);
  for (const char* part : kParts) {
    const auto found = run.parts.find(fmt::format("surface: {}", part));
    fmt::print(",{}", found == run.parts.end() ? "" : fmt::format("{:.0f}", found->second));
  }
  const auto pixels = static_cast<double>(std::max<std::uint64_t>(run.stats.pixels, 1));
  fmt::print(",{},{:.2f},{:.2f},{},{:.0f},{:.0f},{:.0f},{:.1f},{:.0f}", run.stats.pixels,
             static_cast<double>(run.stats.pieces) / pixels,
             detail(run.stats, "balls taken from lists") / pixels, run.stats.overflow,
             detail(run.stats, "nodes of lists"), detail(run.stats, "longest list"),
             detail(run.stats, "bands"), detail(run.stats, "most bytes per pixel"),
             detail(run.stats, "most bytes per ball"));
  if (truth) {
    const HitErrors e = compareHits(run.hits, *truth);
    fmt::print(",{},{},{},{:.2g},{:.2g},{:.2g}", e.missed, e.falseHits, e.grazing, e.relativeRms,
               e.largestDistance, e.normalRmsDeg);
  } else {
    fmt::print(",,,,,,");
  }
  fmt::print("\n");
  std::fflush(stdout);
}

void measure(std::size_t balls, int repetitions, bool bezier) {
  const std::shared_ptr<const Primitives> primitives = packedBalls(balls, 1);
  const View view = viewOf(*primitives);
  const ReferenceImage truth = traceReference(primitives->surfaces, primitives->origin, view);
  print(balls, "lists exact", draw(primitives, view, {"lists", {}}, repetitions), &truth);
  print(balls, "lists cubic", draw(primitives, view, {"lists", {{"exact", 0}}}, repetitions), &truth);
  print(balls, "tiles", draw(primitives, view, {"tiles", {}}, repetitions), &truth);
  if (bezier) print(balls, "bezier", draw(primitives, view, {"bezier", {}}, 0), &truth);
}

}  // namespace
}  // namespace meniscus::bench

int main(int argc, char** argv) {
  using namespace meniscus;
  try {
    const int repetitions = argc > 1 ? std::max(0, std::atoi(argv[1])) : 3;
    const int largest = argc > 2 ? std::atoi(argv[2]) : 800000;
    const int largestBezier = argc > 3 ? std::atoi(argv[3]) : 200000;
    const auto context = Context::create(Backend::automatic);
    fmt::print(
        "balls,method,ms,sort,depth,gather,cast,rays,pieces,taken,walked,nodes,longest_list,bands,bytes_per_"
        "pixel,"
        "bytes_per_ball,missed,false,grazing,relative_rms,largest,normal_rms_deg\n");
    for (const int balls : {50000, 100000, 200000, 800000, 1600000}) {
      if (balls > largest) break;
      bench::measure(static_cast<std::size_t>(balls), repetitions, balls <= largestBezier);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "lists_tables: %s\n", error.what());
    return 1;
  }
  return 0;
}

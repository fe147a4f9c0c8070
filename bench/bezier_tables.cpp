// The figures of Kanamori, Szego and Nishita 2008 beside ours: iterations, culling, tiles, the short stack,
// and times over the number of balls, with the multi-threaded double-precision reference. Prints rows of
// docs/measured/bezier.csv.
//
//   bezier_tables [repetitions] [largest number of balls]

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <map>
#include <random>

#include "bench/bench_scenes.h"
#include "core/hit_errors.h"
#include "core/reference_tracer.h"
#include "render/gl/context.h"
#include "render/renderer.h"

namespace meniscus::bench {
namespace {

constexpr ImageSize kSmall{640, 480}, kLarge{1024, 768};

struct FieldScene {
  std::string name;
  std::shared_ptr<Primitives> primitives;
};

// Random balls of random radii, 1 to 2 Å, supports twice that, in a ball as dense as a protein; `density` as
// a multiple of that.
FieldScene randomBalls(int count, double density) {
  std::mt19937 engine(static_cast<unsigned>(count));
  std::uniform_real_distribution<float> unit(-1, 1), radius(1, 2);
  const auto extent = static_cast<float>(1.6 * std::cbrt(count / density));
  auto primitives = std::make_shared<Primitives>();
  MetaballField field;
  while (field.balls.size() < static_cast<std::size_t>(count)) {
    const glm::vec3 p(unit(engine), unit(engine), unit(engine));
    if (p.x * p.x + p.y * p.y + p.z * p.z > 1) continue;
    field.balls.push_back(
        {p * extent, 2 * radius(engine), 1.0f, 0x4080C0, static_cast<std::uint32_t>(field.balls.size() + 1)});
  }
  primitives->surfaces.push_back(std::move(field));
  return {fmt::format("{} balls{}", count, density == 1 ? "" : fmt::format(", {} times as dense", density)),
          primitives};
}

View viewOf(const FieldScene& scene, ImageSize size) {
  const BoundingSphere bounds = scene.primitives->bounds();
  Camera camera;
  camera.target = bounds.center;
  camera.distance = 3 * bounds.radius;
  camera.fovY = 2 * std::atan(0.34);
  return makeView(camera, size, bounds);
}

using Parameters = std::map<std::string, double>;

struct Run {
  double ms = 0, cpuMs = 0;
  SurfaceStats stats;
  HitImage hits;
};

Run draw(const FieldScene& scene, ImageSize size, const Parameters& parameters, int repetitions) {
  Renderer renderer;
  renderer.setPrimitives(scene.primitives);
  const SurfaceSettings settings{"bezier", parameters};
  Run run;
  const View view = viewOf(scene, size);
  std::vector<double> times, cpuTimes;
  const auto once = [&] {
    double cpu = 0;
    const double ms =
        wallMs([&] { cpu = processorMs([&] { run.hits = renderer.renderHits(view, {}, settings); }); });
    times.push_back(ms);
    cpuTimes.push_back(cpu);
  };
  once();  // compiles the programs, too
  run.stats = renderer.stats().surfaces.at(0);
  for (int i = 0; i < repetitions; ++i) {
    if (i == 0) {
      times.clear();
      cpuTimes.clear();
    }
    once();
  }
  run.ms = median(times);
  run.cpuMs = median(cpuTimes);
  return run;
}

void print(const char* what, const FieldScene& scene, ImageSize size, const char* setting, const Run& run,
           double referenceMs = 0, double referenceCpuMs = 0, const HitErrors* errors = nullptr) {
  const SurfaceStats& s = run.stats;
  const double solved = std::max(detail(s, "pieces that took iterations"), 1.0);
  const auto pixels = static_cast<double>(std::max<std::uint64_t>(s.pixels, 1));
  fmt::print(
      "{},\"{}\",{}x{},{},{:.0f},{:.0f},{:.2f},{},{},{:.2f},{:.1f},{:.3f},{:.0f},{:.0f},{},{:.0f},{:.0f}",
      what, scene.name, size.width, size.height, setting, run.ms, run.cpuMs,
      static_cast<double>(s.iterations) / solved, detail(s, "most iterations of one piece"), s.mostIterations,
      static_cast<double>(s.pieces) / pixels, detail(s, "events peeled") / pixels,
      detail(s, "balls left after culling") / std::max(detail(s, "balls in view"), 1.0), detail(s, "layers"),
      detail(s, "rectangles drawn in layers"), s.overflow, referenceMs, referenceCpuMs);
  if (errors)
    fmt::print(",{},{},{},{:.2g},{:.2g}", errors->missed, errors->falseHits, errors->grazing,
               errors->relativeRms, errors->largestDistance);
  fmt::print("\n");
  std::fflush(stdout);
}

void measureOptimisations(int repetitions) {
  const struct {
    const char* name;
    Parameters parameters;
  } settings[] = {{"default", {}},
                  {"tolerance of the paper", {{"tolerance", 1e-3}}},
                  {"no culling", {{"culling", 0}}},
                  {"no tiles", {{"tiles", 0}}},
                  {"8 x 8 tiles", {{"tiles", 8}}},
                  {"32 x 32 tiles", {{"tiles", 32}}},
                  {"no clipping", {{"clipping", 0}}},
                  {"neither", {{"culling", 0}, {"tiles", 0}, {"clipping", 0}}}};
  for (const double density : {1.0}) {
    const FieldScene scene = randomBalls(1000, density);
    for (const auto& setting : settings)
      print("optimisation", scene, kSmall, setting.name,
            draw(scene, kSmall, setting.parameters, repetitions));
  }
}

void measureTimes(int repetitions, int largest) {
  for (const int count : {1000, 10000, 50000, 100000}) {
    if (count > largest) break;
    const FieldScene scene = randomBalls(count, 1);
    for (const ImageSize size : {kSmall, kLarge}) {
      const Run run = draw(scene, size, {}, count > 10000 ? 0 : repetitions);
      const View view = viewOf(scene, size);
      ReferenceOptions options;
      options.grazing = false;
      double cpu = 0;
      const double ms = wallMs([&] {
        cpu = processorMs(
            [&] { traceReference(scene.primitives->surfaces, scene.primitives->origin, view, options); });
      });
      const ReferenceImage truth = traceReference(scene.primitives->surfaces, scene.primitives->origin, view);
      const HitErrors errors = compareHits(run.hits, truth);
      print("time", scene, size, "default", run, ms, cpu, &errors);
    }
  }
}

}  // namespace
}  // namespace meniscus::bench

int main(int argc, char** argv) {
  using namespace meniscus;
  try {
    const int repetitions = argc > 1 ? std::max(0, std::atoi(argv[1])) : 3;
    const int largest = argc > 2 ? std::atoi(argv[2]) : 100000;
    const auto context = Context::create(Backend::automatic);
    fmt::print(
        "what,scene,size,setting,ms,cpu_ms,iterations_per_piece,most_of_one_piece,most_of_one_pixel,pieces,"
        "events,"
        "balls_left,"
        "layers,rectangles,overflow,reference_ms,reference_cpu_ms,missed,false,grazing,relative_rms,"
        "largest\n");
    bench::measureOptimisations(repetitions);
    bench::measureTimes(repetitions, largest);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bezier_tables: %s\n", error.what());
    return 1;
  }
  return 0;
}

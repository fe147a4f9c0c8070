// The tables of Gourmel et al. 2010 beside ours, on the processor, for 640 x 480 pixels.
//
//   bvh_tables trees [repetitions]    Tables 1, 3, 4 and 5, and n^2 against n: docs/measured/bvh.csv
//   bvh_tables effects                Table 2, and refraction: docs/measured/bvh_effects.csv
//   bvh_tables motion [repetitions]   refit against rebuilding when balls move: docs/measured/bvh_motion.csv

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/combinable.h>
#include <tbb/parallel_for.h>

#include <cstdio>
#include <cstdlib>

#include "bench/bench_scenes.h"
#include "bench/bvh_scenes.h"
#include "core/bvh/field_tracer.h"
#include "core/bvh/view_ray.h"
#include "core/random.h"
#include "core/traced_light.h"

namespace meniscus::bench {
namespace {

using namespace meniscus::bvh;

struct Variant {
  const char* name;
  TreeSettings settings;
};

constexpr Variant kVariants[] = {
    {"classical", {Structure::classical, LeafCost::linear}},
    {"split", {Structure::split, LeafCost::square}},
    {"split n", {Structure::split, LeafCost::linear}},
    {"cells", {Structure::fitted, LeafCost::square, false, false, false}},
    {"fit", {Structure::fitted, LeafCost::square, true, false, false}},
    {"fit tight", {Structure::fitted, LeafCost::square, true, true, false}},
    {"fit discard", {Structure::fitted, LeafCost::square, true, false, true}},
    {"fitted", {Structure::fitted, LeafCost::square, true, true, true}},
    {"fitted n", {Structure::fitted, LeafCost::linear, true, true, true}},
};

struct Cast {
  TraceCounts counts;
  std::size_t hits = 0;
};

Cast castAll(const MetaballField& field, const FieldTree& tree, const BvhScene& scene, Search search) {
  const FieldTracer tracer(field, tree, search);
  const ViewRays rays(scene.view, scene.primitives->origin);
  tbb::combinable<Cast> parts;
  const ImageSize size = scene.view.size;
  tbb::parallel_for(tbb::blocked_range<int>(0, size.height, 8), [&](const auto& rows) {
    Cast& part = parts.local();
    RayScratch scratch;
    for (int y = rows.begin(); y < rows.end(); ++y) {
      for (int x = 0; x < size.width; ++x) {
        const auto ray = rays.through({x + 0.5, y + 0.5});
        part.hits += tracer.cast({ray.origin, ray.direction, ray.start}, scratch, part.counts) ? 1 : 0;
      }
    }
  });
  Cast all;
  parts.combine_each([&](const Cast& part) {
    all.counts.add(part.counts);
    all.hits += part.hits;
  });
  return all;
}

void measure(const BvhScene& scene, int repetitions) {
  const MetaballField& field = scene.primitives->surfaces[0];
  for (const Variant& variant : kVariants) {
    FieldTree tree;
    std::vector<double> build, buildProcessor;
    for (int i = 0; i < repetitions; ++i) {
      buildProcessor.push_back(processorMs(
          [&] { build.push_back(wallMs([&] { tree = buildFieldTree(field, variant.settings); })); }));
    }
    for (const Search search : {Search::paper, Search::guaranteed}) {
      Cast cast;
      std::vector<double> times;
      for (int i = 0; i < repetitions; ++i)
        times.push_back(processorMs([&] { cast = castAll(field, tree, scene, search); }));
      const double rays = static_cast<double>(cast.counts.rays);
      fmt::print(
          "{},{},{},{},{:.1f},{:.1f},{:.0f},{},{},{},{},{},{:.2f},{:.2f},{:.1f},{:.2f},{}\n", scene.name,
          field.balls.size(), variant.name, search == Search::paper ? "paper" : "guaranteed", median(build),
          median(buildProcessor), median(times), tree.nodes.size(), tree.leaves, tree.depth,
          tree.members.size(), tree.forcedLeaves, static_cast<double>(cast.counts.nodes) / rays,
          static_cast<double>(cast.counts.leaves) / rays, static_cast<double>(cast.counts.balls) / rays,
          static_cast<double>(cast.counts.effort.pieces) / rays, cast.hits);
      std::fflush(stdout);
    }
  }
}

void effects(const BvhScene& scene) {
  struct Effect {
    const char* name;
    TraceSettings trace;
  };
  const SceneTracer tracer(scene.primitives);
  const auto with = [](int shadows, int occlusion, int reflect, int refract) {
    TraceSettings trace;
    trace.shadows = shadows;
    trace.occlusion = occlusion;
    trace.reflect = reflect;
    trace.refract = refract;
    return trace;
  };
  const Effect all[] = {{"ray cast", with(0, 0, 0, 0)},
                        {"hard shadows", with(1, 0, 0, 0)},
                        {"hard shadows + 1 reflection", with(1, 0, 1, 0)},
                        {"hard shadows + 3 reflections", with(1, 0, 3, 0)},
                        {"8 walls of glass", with(0, 0, 1, 8)},
                        {"occlusion by 64 rays", with(0, 64, 0, 0)}};
  for (const Effect& effect : all) {
    TracedLightSettings settings;
    settings.trace = effect.trace;
    settings.shadows.mode = ShadowMode::hard;
    settings.occlusion.radius = 0;
    TracedPlanes planes;
    TraceCounts counts;
    const double ms = processorMs([&] {
      traceLight(tracer, {scene.view, 0, 0, scene.view.size.width, scene.view.size.height}, settings, planes,
                 counts);
    });
    fmt::print("{},{},{},{:.0f},{}\n", scene.name, scene.primitives->surfaces[0].balls.size(), effect.name,
               ms, counts.rays);
    std::fflush(stdout);
  }
}

// Balls move by a share of their support, as between frames of a simulation.
void motion(const BvhScene& scene, int repetitions) {
  Primitives moved = *scene.primitives;
  MetaballField& field = moved.surfaces[0];
  FieldTree refitted = buildFieldTree(field, {Structure::classical, LeafCost::linear});
  Random random(9);
  for (Metaball& ball : field.balls) ball.center += 0.3f * ball.support * glm::vec3(random.direction());
  const BvhScene now{scene.name, std::make_shared<Primitives>(moved), scene.view};
  const auto timed = [&](const auto& call) {
    std::vector<double> times;
    for (int i = 0; i < repetitions; ++i) times.push_back(processorMs(call));
    return median(times);
  };
  std::vector<Box> boxes;
  for (const Metaball& ball : field.balls) {
    const float reach = ball.support + refitted.slack / 2;
    boxes.push_back({ball.center - reach, ball.center + reach});
  }
  const double refit = timed([&] { refitBoxTree(refitted, boxes); });
  const auto print = [&](const char* what, double ms, const FieldTree& tree) {
    Cast cast;
    const double castMs = timed([&] { cast = castAll(field, tree, now, Search::guaranteed); });
    fmt::print("{},{},{},{:.1f},{:.0f},{}\n", scene.name, field.balls.size(), what, ms, castMs, cast.hits);
    std::fflush(stdout);
  };
  print("classical refitted", refit, refitted);
  for (const Structure structure : {Structure::classical, Structure::fitted}) {
    const TreeSettings settings{structure,
                                structure == Structure::fitted ? LeafCost::square : LeafCost::linear};
    FieldTree tree;
    const double build = timed([&] { tree = buildFieldTree(field, settings); });
    print(structure == Structure::fitted ? "fitted rebuilt" : "classical rebuilt", build, tree);
  }
}

}  // namespace
}  // namespace meniscus::bench

int main(int argc, char** argv) {
  using namespace meniscus;
  try {
    const std::string_view what = argc > 1 ? argv[1] : "";
    const int repetitions = argc > 2 ? std::max(1, std::atoi(argv[2])) : 3;
    if (what == "effects") {
      fmt::print("scene,balls,effect,processor_ms,rays\n");
      bench::effects(bench::moleculeOf(5'440));
      bench::effects(bench::tornado(4'000));
      return 0;
    }
    if (what == "motion") {
      fmt::print("scene,balls,tree,update_processor_ms,cast_processor_ms,hits\n");
      bench::motion(bench::scattered(100'000), repetitions);
      bench::motion(bench::moleculeOf(5'440), repetitions);
      bench::motion(bench::pool(10'000), repetitions);
      return 0;
    }
    if (what != "trees") {
      std::fprintf(stderr, "bvh_tables: give trees, effects or motion\n");
      return 2;
    }
    fmt::print(
        "scene,balls,tree,search,build_ms,build_processor_ms,cast_processor_ms,nodes,leaves,depth,members,"
        "forced,nodes_per_ray,leaves_per_ray,balls_per_ray,pieces_per_ray,hits\n");
    bench::measure(bench::scattered(30'000), repetitions);
    bench::measure(bench::scattered(100'000), repetitions);
    bench::measure(bench::tornado(4'000), repetitions);
    bench::measure(bench::tornado(128'000), repetitions);
    bench::measure(bench::moleculeOf(5'440), repetitions);
    bench::measure(bench::pool(10'000), repetitions);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bvh_tables: %s\n", error.what());
    return 1;
  }
  return 0;
}

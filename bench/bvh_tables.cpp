// Tables 1, 3, 4 and 5 of Gourmel et al. 2010, and n^2 against n, beside ours: trees, construction, and what
// 640 x 480 primary rays cost on the processor. Prints docs/measured/bvh.csv.
//
//   bvh_tables [repetitions]

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

}  // namespace
}  // namespace meniscus::bench

int main(int argc, char** argv) {
  using namespace meniscus;
  try {
    const int repetitions = argc > 1 ? std::max(1, std::atoi(argv[1])) : 3;
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

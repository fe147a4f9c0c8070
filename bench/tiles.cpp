// Spheres from tile lists against splatting them and against Embree, binning or build included, 1024 x 768, a
// ball of atoms as dense as a protein that fills the height.
//
//   tiles [repetitions [atoms ...]] > tiles.csv
//
// Times are medians of interleaved repetitions; ratios are within one run. Nothing is read back.

#include <fmt/format.h>
#include <glad/gl.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <random>

#include "bench/bench_scenes.h"
#ifdef MENISCUS_BENCH_EMBREE
#include "bench/embree_spheres.h"
#endif
#include "core/tiles/field_tiles.h"
#include "core/tiles/instruction_sets.h"
#include "core/tiles/quadric_tiles.h"
#include "render/gl/context.h"
#include "render/quadrics.h"
#include "render/view_block.h"

namespace meniscus::bench {
namespace {

constexpr ImageSize kSize{1024, 768};

// A ball of spheres on a disturbed grid, 2.4 Å apart, of radius 1.4 to 1.9 Å.
Primitives proteinLike(int atoms) {
  std::mt19937 bits(1);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(bits()) * 0x1p-32;
  };
  constexpr double kSpacing = 2.4;
  const double radius = kSpacing * std::cbrt(atoms * 3 / (4 * 3.14159265358979));
  const int reach = static_cast<int>(radius / kSpacing) + 1;
  Primitives out;
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) {
      for (int z = -reach; z <= reach; ++z) {
        const glm::dvec3 p = glm::dvec3(x, y, z) * kSpacing;
        if (glm::length(p) > radius) continue;
        const glm::dvec3 moved =
            p + kSpacing * glm::dvec3(uniform(-0.4, 0.4), uniform(-0.4, 0.4), uniform(-0.4, 0.4));
        const auto id = static_cast<std::uint32_t>(out.spheres.size() + 1);
        out.spheres.push_back(
            {glm::vec3(moved), static_cast<float>(uniform(1.4, 1.9)), id * 2654435761u >> 8, id});
      }
    }
  }
  return out;
}

View filling(const Primitives& primitives) {
  Camera camera;
  const BoundingSphere bounds = primitives.bounds();
  camera.distance = bounds.radius / std::sin(camera.fovY / 2);
  camera.target = bounds.center;
  return makeView(camera, kSize, bounds);
}

/// Splats into the channels that the tiles fill.
class Splatting {
 public:
  explicit Splatting(const Primitives& primitives) : primitives_(primitives) {
    quadrics_.upload(primitives);
    uniforms_ = gl::Buffer::updatable(sizeof(f32::ViewBlock));
  }
  void draw(const View& view) {
    const f32::ViewBlock block =
        makeViewBlock(view, primitives_.origin, {0, 0, view.size.width, view.size.height}, {0, 0});
    uniforms_.update(&block);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, uniforms_.object.name());
    FrameGraph graph(pool_);
    const GBufferRefs g = createGBuffer(graph, view.size.width, view.size.height);
    addQuadrics(graph, quadrics_, shaders_, g);
    for (const TextureRef ref : {g.depth, g.albedo, g.normal, g.id}) graph.want(ref);
    RenderStats stats;
    graph.execute(stats, false);
    glFinish();
  }

 private:
  const Primitives& primitives_;
  ShaderLibrary shaders_{{}};
  TexturePool pool_;
  QuadricBuffers quadrics_;
  gl::Buffer uniforms_;
};

void measure(int atoms, int repetitions) {
  const Primitives primitives = proteinLike(atoms);
  const View view = filling(primitives);
  const tiles::TileTarget target{view, primitives.origin, {0, 0, kSize.width, kSize.height}, {0, 0}};
  std::map<std::string, std::vector<double>> times;
  Splatting splatting(primitives);
  tiles::QuadricTiles caster;
  // The exact surface of degree six, its supports twice the radii.
  MetaballField field;
  for (const SpherePrimitive& sphere : primitives.spheres)
    field.balls.push_back({sphere.center, 2 * sphere.radius, 1, sphere.color, sphere.id});
  tiles::FieldTiles surface;
  tiles::FieldCounts counts;
  tiles::Planes planes;
  std::size_t hits = 0, embreeHits = 0;
  for (int repetition = -1; repetition < repetitions; ++repetition) {  // the first warms up
    std::map<std::string, double> now;
    caster.setPrimitives(&primitives);
    now["tiles, all"] = timeMs([&] { caster.cast(target, {}, planes); });
    now["tiles, lists there"] = timeMs([&] { caster.cast(target, {}, planes); });
    surface.setField(&field);
    now["surface, all"] = timeMs([&] { surface.cast(target, {}, planes); });
    surface.takeCounts();
    now["surface, lists there"] = timeMs([&] { surface.cast(target, {}, planes); });
    counts = surface.takeCounts();
    if (atoms <= 1000000) now["splat"] = timeMs([&] { splatting.draw(view); });
#ifdef MENISCUS_BENCH_EMBREE
    const EmbreeTimes embree = castByEmbree(primitives, view);
    now["embree, build"] = embree.buildMs;
    now["embree, cast"] = embree.castMs;
    now["embree, all"] = embree.buildMs + embree.castMs;
    embreeHits = embree.hits;
#endif
    if (repetition >= 0)
      for (const auto& [name, ms] : now) times[name].push_back(ms);
  }
  caster.cast(target, {}, planes);
  for (const float d : planes.depth) hits += d > 0;
  for (const auto& [name, all] : times)
    fmt::print("time,{},\"{}\",{:.2f}\n", primitives.spheres.size(), name, median(all));
  const double mine = median(times["tiles, all"]);
  for (const char* other : {"splat", "embree, all"}) {
    if (times.contains(other))
      fmt::print("ratio,{},\"{} / tiles, all\",{:.2f}\n", primitives.spheres.size(), other,
                 median(times[other]) / mine);
  }
  if (times.contains("embree, all"))
    fmt::print("ratio,{},\"embree, all / surface, all\",{:.2f}\n", primitives.spheres.size(),
               median(times["embree, all"]) / median(times["surface, all"]));
  const auto perRay = [&](const char* what, std::uint64_t n) {
    fmt::print("ray,{},\"{}\",{:.2f}\n", primitives.spheres.size(), what,
               static_cast<double>(n) / static_cast<double>(counts.rays));
  };
  perRay("intervals", counts.intervals);
  perRay("pieces", counts.pieces);
  perRay("iterations", counts.iterations);
  fmt::print("lists,{},\"surface entries\",{}\n", primitives.spheres.size(), surface.lists().entryCount());
  fmt::print("lists,{},\"entries\",{}\n", primitives.spheres.size(), caster.lists().entryCount());
  fmt::print("lists,{},\"MiB\",{:.1f}\n", primitives.spheres.size(),
             static_cast<double>(caster.lists().bytes()) / (1 << 20));
  fmt::print("hits,{},\"tiles\",{}\nhits,{},\"embree\",{}\n", primitives.spheres.size(), hits,
             primitives.spheres.size(), embreeHits);
  std::fflush(stdout);
}

}  // namespace
}  // namespace meniscus::bench

int main(int argc, char** argv) {
  try {
    using namespace meniscus;
    const auto context = Context::create(Backend::automatic);
    const int repetitions = argc > 1 ? std::atoi(argv[1]) : 9;
    fmt::print("kind,atoms,what,value\n# {}\n", tiles::instructionSet());
    if (argc <= 2) {
      for (const int atoms : {58000, 300000, 1000000}) bench::measure(atoms, repetitions);
    }
    for (int i = 2; i < argc; ++i) bench::measure(std::atoi(argv[i]), repetitions);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tiles: %s\n", error.what());
    return 1;
  }
}

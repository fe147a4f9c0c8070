// Spheres from tile lists against splatting them and against Embree, binning or build included, 1024 x 768, a
// ball of atoms as dense as a protein that fills the height.
//
//   tiles [repetitions [frames | bezier | instructions | atoms ...]] > tiles.csv
//
// Times are medians of interleaved repetitions, by the clock and of the processor (all threads: what a
// machine busy with other work distorts less); ratios are within one run. Nothing is read back.

#include <fmt/format.h>
#include <glad/gl.h>
#include <sys/resource.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <glm/ext/matrix_transform.hpp>
#include <map>
#include <random>
#include <string_view>

#include "bench/bench_scenes.h"
#ifdef MENISCUS_BENCH_EMBREE
#include "bench/embree_spheres.h"
#endif
#include "bench/instructions.h"
#include "core/tiles/field_tiles.h"
#include "core/tiles/instruction_sets.h"
#include "core/tiles/quadric_tiles.h"
#include "render/gl/context.h"
#include "render/quadrics.h"
#include "render/renderer.h"
#include "render/view_block.h"

namespace meniscus::bench {
namespace {

constexpr ImageSize kSize{1024, 768};
constexpr std::size_t kMostForOthers = 1'000'000;

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

void turn(View& view, double angle) {
  view.rotation = glm::dmat3(glm::rotate(glm::dmat4(view.rotation), angle, glm::dvec3(0, 1, 0)));
}
constexpr double kDegree = 0.01745;

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

/// Times of one thing, wall and processor (all threads) [ms].
struct Times {
  std::vector<double> wall, processor;
};
using AllTimes = std::map<std::string, Times>;

void record(AllTimes& times, const std::string& name, bool keep, const std::function<void()>& call) {
  double wall = 0;
  const double processor = processorMs([&] { wall = wallMs(call); });
  if (!keep) return;
  times[name].wall.push_back(wall);
  times[name].processor.push_back(processor);
}

void printRatio(const AllTimes& times, std::size_t atoms, const std::string& a, const std::string& b) {
  if (!times.contains(a) || !times.contains(b)) return;
  fmt::print("ratio,{},\"{} / {}\",{:.2f},{:.2f}\n", atoms, a, b,
             median(times.at(a).wall) / median(times.at(b).wall),
             median(times.at(a).processor) / median(times.at(b).processor));
}

// The exact surface of degree six, its supports twice the radii.
MetaballField surfaceOf(const Primitives& primitives) {
  MetaballField field;
  for (const SpherePrimitive& sphere : primitives.spheres)
    field.balls.push_back({sphere.center, 2 * sphere.radius, 1, sphere.color, sphere.id});
  return field;
}

void printCounts(std::size_t atoms, const tiles::FieldCounts& counts) {
  const auto perRay = [&](const char* what, std::uint64_t n) {
    fmt::print("ray,{},\"{}\",{:.2f},\n", atoms, what,
               static_cast<double>(n) / static_cast<double>(counts.rays));
  };
  perRay("intervals", counts.intervals);
  perRay("pieces", counts.pieces);
  perRay("iterations", counts.iterations);
}

double peakMiB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

void measure(int wanted, int repetitions) {
  const Primitives primitives = proteinLike(wanted);
  const std::size_t atoms = primitives.spheres.size();
  const View view = filling(primitives);
  const tiles::TileTarget target{view, primitives.origin, {0, 0, kSize.width, kSize.height}, {0, 0}};
  const MetaballField field = surfaceOf(primitives);
  AllTimes times;
  std::unique_ptr<Splatting> splatting;
  if (atoms <= kMostForOthers) splatting = std::make_unique<Splatting>(primitives);
  tiles::QuadricTiles caster;
  tiles::FieldTiles surface;
  tiles::FieldCounts counts;
  tiles::Planes planes;
  // Whatever has to be done again when the view changes.
  const auto changed = [&](int repetition) {
    tiles::TileTarget t = target;
    t.view.nearZ += 1e-6 * (repetition + 2);
    return t;
  };
  for (int repetition = -1; repetition < repetitions; ++repetition) {  // the first warms up
    const bool keep = repetition >= 0;
    const tiles::TileTarget now = changed(repetition);
    record(times, "scene: clusters", keep, [&] { caster.setPrimitives(&primitives); });
    record(times, "spheres by tiles", keep, [&] { caster.cast(now, {}, planes); });
    record(times, "spheres by tiles, lists there", keep, [&] { caster.cast(now, {}, planes); });
    if (repetition < 0) surface.setField(&field);
    record(times, "surface by tiles", keep, [&] { surface.cast(now, {}, planes); });
    surface.takeCounts();
    record(times, "surface by tiles, lists there", keep, [&] { surface.cast(now, {}, planes); });
    counts = surface.takeCounts();
    if (splatting) record(times, "spheres splatted", keep, [&] { splatting->draw(view); });
#ifdef MENISCUS_BENCH_EMBREE
    if (atoms > kMostForOthers) continue;
    EmbreeSpheres embree(primitives);
    record(times, "spheres by Embree: build", keep, [&] { embree.build(); });
    record(times, "spheres by Embree: cast", keep, [&] { embree.cast(view); });
    if (!keep) continue;
    for (auto part : {&Times::wall, &Times::processor})
      (times["spheres by Embree"].*part)
          .push_back((times["spheres by Embree: build"].*part).back() +
                     (times["spheres by Embree: cast"].*part).back());
#endif
  }
  for (const auto& [name, all] : times)
    fmt::print("time,{},\"{}\",{:.2f},{:.2f}\n", atoms, name, median(all.wall), median(all.processor));
  printRatio(times, atoms, "spheres splatted", "spheres by tiles");
  printRatio(times, atoms, "spheres by Embree", "spheres by tiles");
  printRatio(times, atoms, "spheres by Embree", "surface by tiles");
  printCounts(atoms, counts);
  fmt::print("lists,{},\"spheres: entries\",{},\n", atoms, caster.lists().entryCount());
  fmt::print("lists,{},\"spheres: looked at\",{},\n", atoms, caster.lists().placedCount());
  fmt::print("lists,{},\"spheres: MiB\",{:.1f},\n", atoms,
             static_cast<double>(caster.lists().bytes()) / (1 << 20));
  fmt::print("lists,{},\"surface: entries\",{},\n", atoms, surface.lists().entryCount());
  fmt::print("memory,{},\"peak of the process so far, MiB\",{:.0f},\n", atoms, peakMiB());
  std::fflush(stdout);
}

// A full frame: soft shadows, silhouettes, depth unsharp masking, one ray per pixel. Still: nothing but the
// picture is drawn again. Turning: by a degree from frame to frame, so that light, lists and all are new.
void measureFrames(int wanted, int repetitions) {
  const Primitives spheres = proteinLike(wanted);
  Primitives surface;
  surface.surfaces.push_back(surfaceOf(spheres));
  RenderSettings settings;
  settings.samples = 1;
  settings.shadows.mode = ShadowMode::soft;
  settings.lines.silhouettes = true;
  settings.depthUnsharp.mode = UnsharpMode::both;
  struct Kind {
    std::string name;
    const Primitives* scene;
    double turn;  // [rad]
    bool processor;
  };
  std::vector<Kind> kinds;
  const std::pair<const char*, const Primitives*> scenes[] = {{"spheres", &spheres}, {"surface", &surface}};
  for (const auto& [name, scene] : scenes) {
    kinds.push_back({fmt::format("{}, turning", name), scene, kDegree, true});
    kinds.push_back({fmt::format("{}, still", name), scene, 0, true});
    kinds.push_back({fmt::format("{}, turning, effects by shaders", name), scene, kDegree, false});
  }
  const std::size_t atoms = spheres.spheres.size();
  for (const Kind& kind : kinds) {
    for (const bool timed : {false, true}) {  // waiting after every pass costs some time itself
      RendererOptions options;
      options.timePasses = timed;
      options.effectsOnProcessor = kind.processor;
      Renderer renderer(options);
      renderer.setPrimitives(std::make_shared<Primitives>(*kind.scene));
      View view = filling(spheres);
      AllTimes times;
      std::map<std::string, double> passes;
      for (int repetition = -1; repetition < repetitions; ++repetition) {
        turn(view, kind.turn);
        NullSink sink;
        record(times, "frame", repetition >= 0,
               [&] { renderer.renderPicture(view, Lighting{}, {}, settings, PixelFormat::rgba8, sink); });
        if (repetition < 0) renderer.forgetStats();
      }
      if (!timed) {
        fmt::print("frame,{},\"{}: frame\",{:.2f},{:.2f}\n", atoms, kind.name, median(times.at("frame").wall),
                   median(times.at("frame").processor));
        continue;
      }
      const RenderStats stats = renderer.stats();
      for (const PassStats& pass : stats.passes)
        fmt::print("frame,{},\"{}: {} (mean)\",{:.2f},\n", atoms, kind.name, pass.name,
                   pass.milliseconds / repetitions);
      fmt::print("frame,{},\"{}: read back (mean)\",{:.2f},\n", atoms, kind.name,
                 stats.readbackMs / repetitions);
    }
  }
  std::fflush(stdout);
}

// The pass that draws the exact surface, lists and whatever else a new view needs included, by tiles and by
// Bézier clipping: a degree further in every repetition.
void measureAgainstBezier(int wanted, int repetitions) {
  const Primitives spheres = proteinLike(wanted);
  const auto surface = std::make_shared<Primitives>();
  surface->surfaces.push_back(surfaceOf(spheres));
  const std::array<std::string, 2> methods{"tiles", "bezier"};
  std::array<std::unique_ptr<Renderer>, 2> renderers;
  std::array<Times, 2> times;
  RendererOptions options;
  options.timePasses = true;
  for (std::unique_ptr<Renderer>& renderer : renderers) {
    renderer = std::make_unique<Renderer>(options);
    renderer->setPrimitives(surface);
  }
  View view = filling(spheres);
  for (int repetition = -1; repetition < repetitions; ++repetition) {
    turn(view, kDegree);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      RenderSettings settings;
      settings.samples = 1;
      settings.surface.method = methods[m];
      NullSink sink;
      renderers[m]->forgetStats();
      renderers[m]->renderPicture(view, Lighting{}, {}, settings, PixelFormat::rgba8, sink);
      if (repetition < 0) continue;
      double wall = 0, processor = 0;  // of all parts of the picture
      for (const PassStats& pass : renderers[m]->stats().passes) {
        if (!pass.name.starts_with("surface")) continue;
        wall += pass.milliseconds;
        processor += pass.processorMs;
      }
      times[m].wall.push_back(wall);
      times[m].processor.push_back(processor);
    }
  }
  AllTimes all;
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const std::string name = "surface pass by " + methods[m];
    all[name] = times[m];
    fmt::print("pass,{},\"{}\",{:.2f},{:.2f}\n", spheres.spheres.size(), name, median(times[m].wall),
               median(times[m].processor));
  }
  printRatio(all, spheres.spheres.size(), "surface pass by bezier", "surface pass by tiles");
  std::fflush(stdout);
}

// What the width of the vectors brings.
void measureWidths(int wanted, int repetitions) {
  const Primitives primitives = proteinLike(wanted);
  const tiles::TileTarget target{
      filling(primitives), primitives.origin, {0, 0, kSize.width, kSize.height}, {0, 0}};
  const MetaballField field = surfaceOf(primitives);
  tiles::QuadricTiles caster;
  caster.setPrimitives(&primitives);
  tiles::FieldTiles surface;
  surface.setField(&field);
  tiles::Planes planes;
  AllTimes times;
  for (int repetition = -1; repetition < repetitions; ++repetition) {
    for (const std::string& set : tiles::instructionSets()) {
      tiles::useInstructionSet(set);
      record(times, "spheres, lists there, " + set, repetition >= 0,
             [&] { caster.cast(target, {}, planes); });
      record(times, "surface, lists there, " + set, repetition >= 0,
             [&] { surface.cast(target, {}, planes); });
      tiles::useInstructionSet("");
    }
  }
  for (const auto& [name, all] : times)
    fmt::print("width,{},\"{}\",{:.2f},{:.2f}\n", primitives.spheres.size(), name, median(all.wall),
               median(all.processor));
  std::fflush(stdout);
}

// Instructions of a pixel that shows something, lists kept, in a block of tiles halfway out. Takes half an
// hour: they are counted one by one.
void measureInstructions(int wanted) {
  const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
  const Primitives primitives = proteinLike(wanted);
  const MetaballField field = surfaceOf(primitives);
  constexpr int kBlock = tiles::kTileSize * tiles::kBlockTiles;
  const tiles::TileTarget target{
      filling(primitives), primitives.origin, {5 * kBlock, 4 * kBlock, kBlock, kBlock}, {0, 0}};
  tiles::QuadricTiles caster;
  caster.setPrimitives(&primitives);
  tiles::FieldTiles surface;
  surface.setField(&field);
  tiles::Planes planes;
  const auto print = [&](const char* what, const std::string& set, const std::function<void()>& cast) {
    tiles::useInstructionSet(set);
    cast();
    const std::uint64_t instructions = instructionsOf(cast);
    tiles::useInstructionSet("");
    const auto shown = std::ranges::count_if(planes.depth, [](float depth) { return depth > 0; });
    fmt::print("instructions,{},\"{}, {}\",{:.1f},\n", primitives.spheres.size(), what, set,
               static_cast<double>(instructions) / static_cast<double>(shown));
    std::fflush(stdout);
  };
  for (const std::string& set : tiles::instructionSets()) {
    print("spheres", set, [&] { caster.cast(target, {}, planes); });
    print("surface", set, [&] { surface.cast(target, {}, planes); });
  }
}

}  // namespace
}  // namespace meniscus::bench

int main(int argc, char** argv) {
  try {
    using namespace meniscus;
    const int repetitions = argc > 1 ? std::atoi(argv[1]) : 9;
    const auto measureFrames = [&] {
      for (const int atoms : {58000, 1000000}) bench::measureFrames(atoms, repetitions);
    };
    fmt::print("kind,atoms,what,value or wall ms,processor ms\n# {}\n", tiles::instructionSet());
    if (argc > 2 && std::string_view(argv[2]) == "instructions") {
      bench::measureInstructions(58000);
      return 0;
    }
    const auto context = Context::create(Backend::automatic);
    if (argc > 2 && std::string_view(argv[2]) == "frames") {
      measureFrames();
      return 0;
    }
    if (argc > 2 && std::string_view(argv[2]) == "bezier") {
      for (const int atoms : {4500, 58000, 300000}) bench::measureAgainstBezier(atoms, repetitions);
      return 0;
    }
    if (argc <= 2) {
      for (const int atoms : {58000, 300000, 1000000}) bench::measure(atoms, repetitions);
      bench::measureWidths(58000, repetitions);
      measureFrames();
    }
    for (int i = 2; i < argc; ++i) bench::measure(std::atoi(argv[i]), repetitions);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tiles: %s\n", error.what());
    return 1;
  }
}

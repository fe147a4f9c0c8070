#include "app/measure/leaving_out.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>

#include "app/measure/csv.h"
#include "app/measure/measure_scene.h"
#include "app/measure/null_sink.h"
#include "app/measure/statistics.h"
#include "render/renderer.h"
#include "render/surface_method.h"

namespace meniscus::measure {

namespace {

struct Kind {
  std::string name;
  Representation representation = Representation::spacefill;
  bool surface = false, depthOnly = false;
  std::function<void(RenderSettings&)> set = [](RenderSettings&) {};
};

std::vector<Kind> kinds() {
  using enum Representation;
  std::vector<Kind> out = {
      {"spheres, distance only", spacefill, false, true, [](RenderSettings&) {}},
      {"spheres", spacefill, false, false, [](RenderSettings&) {}},
      {"spheres + bonds", ballAndStick, false, false, [](RenderSettings&) {}},
  };
  if (!surfaceMethods().empty())
    out.push_back({"spheres + bonds + surface", ballAndStick, true, false, [](RenderSettings&) {}});
  const auto with = [&](const char* what, std::function<void(RenderSettings&)> set) {
    out.push_back({fmt::format("spheres, {}", what), spacefill, false, false, std::move(set)});
  };
  with("outlines", [](RenderSettings& s) { s.lines.silhouettes = s.lines.creases = true; });
  with("depth unsharp", [](RenderSettings& s) { s.depthUnsharp.mode = UnsharpMode::both; });
  with("fog", [](RenderSettings& s) { s.fog.strength = 1; });
  with("hard shadows", [](RenderSettings& s) { s.shadows.mode = ShadowMode::hard; });
  with("soft shadows", [](RenderSettings& s) { s.shadows.mode = ShadowMode::soft; });
  with("ambient occlusion", [](RenderSettings& s) { s.occlusion.on = true; });
  with("4 samples", [](RenderSettings& s) { s.samples = 4; });
  const auto all = [](RenderSettings& s) {
    s.lines.silhouettes = s.lines.creases = true;
    s.depthUnsharp.mode = UnsharpMode::both;
    s.fog.strength = 1;
    s.shadows.mode = ShadowMode::soft;
    s.occlusion.on = true;
  };
  out.push_back({surfaceMethods().empty() ? "everything" : "everything, with surface", ballAndStick,
                 !surfaceMethods().empty(), false, all});
  return out;
}

}  // namespace

void measureLeavingOut(const Sweep& sweep, const OutputFolder& folder, Progress& progress) {
  GrowingCsv table(folder / "leaving_out.csv",
                   {"scene", "width", "height", "programs", "passes", "bytes", "first_ms", "steady_ms"});
  const ImageSize size = sweep.sizes.front();
  const std::vector<Kind> all = kinds();
  double done = 0;
  for (const Kind& kind : all) {
    progress.label("leaving out: " + kind.name);
    progress.update(done++ / static_cast<double>(all.size()));
    const auto there = [&](const Row& row) { return row[0] == kind.name; };
    if (std::any_of(table.rows().begin(), table.rows().end(), there)) continue;
    const auto primitives =
        moleculeAs(sweep.leavingOut->molecule, kind.representation, glm::ivec3(1), kind.surface);
    const View view = viewOf(*primitives, {}, size);
    Renderer renderer;
    renderer.setPrimitives(primitives);
    RenderSettings settings;
    settings.samples = 1;
    kind.set(settings);
    const auto draw = [&] {
      const auto start = std::chrono::steady_clock::now();
      NullSink sink;
      if (kind.depthOnly) {
        renderer.renderHits(view, {true, false, false});
      } else {
        renderer.renderPicture(view, settings.occlusion.on ? ambientLighting() : Lighting{}, Background{},
                               settings, PixelFormat::rgba8, sink);
      }
      return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    };
    const double first = draw();
    std::vector<double> steady;
    RenderStats stats;
    // At least one, and as many as there is a second for.
    double spent = 0;
    for (int i = 0; i < sweep.repetitions && spent < 1000; ++i) {
      renderer.forgetStats();
      steady.push_back(draw());
      spent += steady.back();
      stats = renderer.stats();
    }
    int passes = 0;
    for (const PassStats& pass : stats.passes) passes += pass.runs;
    std::uint64_t bytes = 0;
    for (const auto* list : {&stats.buffers, &stats.textures})
      for (const ResourceStats& resource : *list) bytes += resource.bytes;
    table.append({{kind.name, fmt::format("{}", size.width), fmt::format("{}", size.height),
                   fmt::format("{}", stats.programs.size()), fmt::format("{}", passes),
                   fmt::format("{}", bytes), numberText(first), numberText(median(steady))}});
  }
}

}  // namespace meniscus::measure

#include "app/measure/surface_run.h"

#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <map>
#include <memory>

#include "app/measure/error_picture.h"
#include "app/measure/measure_scene.h"
#include "core/error.h"
#include "core/generated_scenes.h"
#include "render/renderer.h"

namespace meniscus::measure {

namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

class SurfaceRun {
 public:
  SurfaceRun(const Sweep& sweep, const OutputFolder& folder, PointTables& tables, Progress& progress)
      : sweep_(sweep), folder_(folder), tables_(tables), progress_(progress), plan_(planOf(sweep)) {}
  void run();

 private:
  struct Pending {
    const PlannedPoint* point;
    PointResult result;
  };
  void measureGroup(const PlannedGroup& group);
  bool measureOnce(const PlannedGroup& group, Pending& pending, bool judge);
  void judge(const PlannedGroup& group, Pending& pending, const HitImage& image);
  void loadScene(const PlannedGroup& group);
  Renderer& rendererOf(const std::string& method);
  void advance(const std::string& what);

  const Sweep& sweep_;
  const OutputFolder& folder_;
  PointTables& tables_;
  Progress& progress_;
  std::vector<PlannedGroup> plan_;
  // One renderer per method: its programs stay compiled.
  std::map<std::string, std::unique_ptr<Renderer>> renderers_;
  std::string sceneName_;
  std::shared_ptr<const Primitives> primitives_;
  View view_;
  ReferenceImage truth_;
  std::size_t units_ = 0, doneUnits_ = 0, donePoints_ = 0, points_ = 0;
  Clock::time_point start_ = Clock::now();
};

Renderer& SurfaceRun::rendererOf(const std::string& method) {
  std::unique_ptr<Renderer>& renderer = renderers_[method];
  RendererOptions options;
  options.timePasses = true;
  if (!renderer) renderer = std::make_unique<Renderer>(options);
  return *renderer;
}

void SurfaceRun::advance(const std::string& what) {
  progress_.label(what);
  progress_.update(static_cast<double>(doneUnits_) / static_cast<double>(std::max<std::size_t>(units_, 1)));
}

void SurfaceRun::loadScene(const PlannedGroup& group) {
  if (sceneName_ != group.scene.name || !primitives_) primitives_ = primitivesOf(group.scene, sweep_.seed);
  sceneName_ = group.scene.name;
  view_ = viewOf(*primitives_, group.view, group.size);
  for (const StabilityRecipe& recipe : stabilityRecipes())
    if (recipe.name == group.scene.stability) view_ = recipe.make(sweep_.seed, group.size).view;
  truth_ = truthOf(*primitives_, view_, folder_ / "truth");
}

void SurfaceRun::judge(const PlannedGroup& group, Pending& pending, const HitImage& image) {
  pending.result.errors = compareHits(image, truth_);
  const std::string name = pictureName(pending.point->number);
  if (sweep_.images) {
    writeErrorPicture(folder_ / ("images/" + name + ".png"), image, truth_, *primitives_);
    const std::filesystem::path drawn = folder_ / "images/drawn.png", right = folder_ / "images/right.png";
    writeShaded(drawn, image, *primitives_);
    writeShaded(right, truth_.hits, *primitives_);
    pending.result.picture = comparePictures(drawn, right);
    std::filesystem::remove(drawn);
    std::filesystem::remove(right);
  }
  if (!sweep_.layers) return;
  writeLayers(folder_ / ("layers/" + name + ".exr"), image);
  const PlannedPoint& first = group.points.front();
  writeLayers(folder_ / fmt::format("layers/truth-{}.exr", pictureName(first.number)), truth_.hits);
  writeGrazing(folder_ / fmt::format("layers/grazing-{}.png", pictureName(first.number)), truth_);
}

// One frame that is timed, after others that are not. False if the method refuses.
bool SurfaceRun::measureOnce(const PlannedGroup& group, Pending& pending, bool judged) {
  PointResult& result = pending.result;
  const SurfaceSettings& settings = pending.point->settings;
  const HitChannels channels{true, true, true};
  try {
    Renderer& renderer = rendererOf(settings.method);
    renderer.setPrimitives(primitives_);
    renderer.forgetStats();
    for (int i = 0; i < sweep_.warmUp; ++i) renderer.renderHits(beside(view_), channels, settings);
    result.prepareMs.push_back(renderer.stats().uploadMs);
    renderer.forgetStats();
    const std::clock_t processor = std::clock();
    const Clock::time_point start = Clock::now();
    const HitImage image = renderer.renderHits(view_, channels, settings);
    result.ms.push_back(since(start));
    result.processorMs.push_back(1e3 * static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC);
    const RenderStats stats = renderer.stats();
    double passes = 0;
    const auto addPass = [&](const std::string& name, int runs, double ms) {
      auto pass = std::find_if(result.passes.begin(), result.passes.end(),
                               [&](const auto& p) { return p.name == name; });
      if (pass == result.passes.end()) pass = result.passes.insert(pass, {name, runs, {}});
      pass->ms.push_back(ms);
      passes += ms;
    };
    for (const PassStats& pass : stats.passes) addPass(pass.name, pass.runs, pass.milliseconds);
    addPass("(preparing, reading back)", 1, std::max(0.0, result.ms.back() - passes));
    if (!judged) return true;
    for (const SurfaceStats& surface : stats.surfaces) result.stats.add(surface);
    for (const auto* list : {&stats.buffers, &stats.textures})
      for (const ResourceStats& resource : *list) result.bytes += resource.bytes;
    judge(group, pending, image);
    return true;
  } catch (const Error& error) {
    result = {};
    result.refused = error.what();
    return false;
  }
}

void SurfaceRun::measureGroup(const PlannedGroup& group) {
  std::vector<Pending> pending;
  for (const PlannedPoint& point : group.points)
    if (!tables_.has(group, point)) pending.push_back({&point, {}});
  if (pending.empty()) return;
  advance(fmt::format("{}, {}: the truth", group.scene.name, group.view.name));
  loadScene(group);
  donePoints_ += pending.size();
  const double share = static_cast<double>(donePoints_) / static_cast<double>(points_);
  int round = 0;
  for (; round < sweep_.repetitions; ++round) {
    const bool overBudget = sweep_.budget > 0 && since(start_) > 1000 * sweep_.budget * share;
    if (round > 0 && overBudget) break;
    for (Pending& one : pending) {
      advance(fmt::format("{}, {}: {}", group.scene.name, group.view.name, one.point->label));
      if (one.result.refused.empty()) measureOnce(group, one, round == 0);
      ++doneUnits_;
    }
  }
  doneUnits_ += pending.size() * static_cast<std::size_t>(sweep_.repetitions - round);
  for (Pending& one : pending) {
    one.result.atoms = ballCount(*primitives_);
    tables_.add(group, *one.point, one.result);
  }
}

void SurfaceRun::run() {
  for (const PlannedGroup& group : plan_) {
    std::size_t missing = 0;
    for (const PlannedPoint& point : group.points) missing += !tables_.has(group, point);
    units_ += missing * static_cast<std::size_t>(sweep_.repetitions);
    points_ += missing;
  }
  for (const PlannedGroup& group : plan_) measureGroup(group);
}

}  // namespace

void measureSurfaces(const Sweep& sweep, const OutputFolder& folder, PointTables& tables,
                     Progress& progress) {
  SurfaceRun(sweep, folder, tables, progress).run();
}

}  // namespace meniscus::measure

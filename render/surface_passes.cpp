#include "render/surface_passes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace meniscus {

void SurfaceStats::add(const SurfaceStats& other) {
  pixels += other.pixels;
  pieces += other.pieces;
  iterations += other.iterations;
  mostIterations = std::max(mostIterations, other.mostIterations);
  overflow += other.overflow;
  grazing += other.grazing;
  notConverged += other.notConverged;
  for (const auto& [name, value] : other.details) {
    const auto same = [&](const auto& detail) { return detail.first == name; };
    const auto found = std::find_if(details.begin(), details.end(), same);
    if (found == details.end()) {
      details.emplace_back(name, value);
    } else if (name.starts_with("most") || name.starts_with("longest")) {
      found->second = std::max(found->second, value);
    } else {
      found->second += value;
    }
  }
}

void addStats(std::vector<SurfaceStats>& all, const SurfaceStats& some) {
  const auto same = [&](const SurfaceStats& s) { return s.method == some.method; };
  const auto found = std::find_if(all.begin(), all.end(), same);
  if (found == all.end()) {
    all.push_back(some);
  } else {
    found->add(some);
  }
}

void SurfacePasses::prepare(std::shared_ptr<const Primitives> primitives, const SurfaceSettings& settings) {
  if (primitives->surfaces.empty()) return;
  if (!methods_.empty() && settings_ == settings) return;
  const SurfaceMethodInfo& method = surfaceMethodFor(settings);
  const SurfaceParameters parameters = surfaceParametersFor(method, settings);
  methods_.clear();
  primitives_ = std::move(primitives);
  settings_ = settings;
  for (const MetaballField& field : primitives_->surfaces) {
    requireValid(field, "surface");
    methods_.push_back(method.make(parameters));
    methods_.back()->prepare(field);
  }
}

void SurfacePasses::clear() {
  methods_.clear();
  primitives_.reset();
}

void SurfacePasses::add(FrameGraph& graph, ShaderLibrary& shaders, const SurfaceTarget& target) {
  if (methods_.empty()) graph.leaveOut("pass " + target.prefix + "surface", "the scene has none");
  SurfaceTarget next = target;
  for (const auto& method : methods_) {
    method->addPasses(graph, shaders, next);
    next.first = false;
  }
  if (methods_.empty()) return;
  const std::string reason = surfaceReason(settings_);
  for (const SurfaceMethodInfo& other : surfaceMethods()) {
    if (other.name != surfaceMethodFor(settings_).name)
      graph.leaveOut(fmt::format("method {}{}", target.prefix, other.name), reason);
  }
}

SurfaceLayerRefs SurfacePasses::addLayers(FrameGraph& graph, ShaderLibrary& shaders, SurfaceTarget target) {
  target.layers = {};
  for (const auto& method : methods_) {
    target.layersBefore = target.layers;
    for (TextureRef& layer : target.layers.of)
      layer = graph.create("surface layer",
                           {gl::TextureFormat::rgba32ui, target.tile.width, target.tile.height}, Clear::none);
    method->addPasses(graph, shaders, target);
  }
  return target.layers;
}

void SurfacePasses::takeStats(std::vector<SurfaceStats>& stats) {
  for (std::size_t i = 0; i < methods_.size(); ++i) {
    SurfaceStats some = methods_[i]->takeStats();
    if (const std::size_t balls = primitives_->surfaces[i].balls.size(); balls > 0)
      some.details.emplace_back(
          "most bytes per ball",
          std::round(static_cast<double>(methods_[i]->bytesOfBalls()) / static_cast<double>(balls)));
    addStats(stats, some);
  }
}

std::vector<ResourceStats> SurfacePasses::buffers() const {
  std::vector<ResourceStats> out;
  for (const auto& method : methods_) {
    const std::vector<ResourceStats> some = method->buffers();
    out.insert(out.end(), some.begin(), some.end());
  }
  return out;
}

}  // namespace meniscus

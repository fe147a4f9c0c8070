#include "bench/surface_errors.h"

#include <algorithm>
#include <cmath>

#include "render/renderer.h"

namespace meniscus::bench {

ReferenceImage truthOf(const BenchScene& scene) {
  return traceReference(scene.primitives->surfaces, scene.primitives->origin, scene.view);
}

SurfaceResult drawSurface(const BenchScene& scene, const ReferenceImage& truth,
                          const SurfaceSettings& settings) {
  SurfaceResult result;
  Renderer renderer;
  renderer.setPrimitives(scene.primitives);
  const HitChannels channels{.distance = true, .normal = true, .id = true};
  renderer.renderHits(scene.view, channels, settings);
  const SurfaceStats first = renderer.stats().surfaces.front();
  renderer.forgetStats();
  HitImage image;
  result.drawMs = processorMs([&] { image = renderer.renderHits(scene.view, channels, settings); });
  result.stats = renderer.stats().surfaces.front();
  for (const auto& detail : first.details) {  // some are told once
    const bool known = std::any_of(result.stats.details.begin(), result.stats.details.end(),
                                   [&](const auto& d) { return d.first == detail.first; });
    if (!known) result.stats.details.push_back(detail);
  }
  result.errors = compareHits(image, truth);
  double squares = 0;
  for (std::size_t i = 0; i < truth.distance.size(); ++i) {
    if (truth.grazing[i] != 0 || truth.hits.id[i] == 0) continue;
    ++result.hits;
    if (!std::isfinite(image.distance[i])) continue;
    const double error = std::abs(static_cast<double>(image.distance[i]) - truth.distance[i]);
    squares += error * error;
    result.wrongSheet += error > 0.1 ? 1 : 0;
  }
  if (result.errors.compared > 0)
    result.rmsDistance = std::sqrt(squares / static_cast<double>(result.errors.compared));
  return result;
}

}  // namespace meniscus::bench

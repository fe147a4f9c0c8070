#pragma once
// How wrong a picture of a surface is, for tables: shares of what the truth shows.

#include <string>

#include "bench/bench_scenes.h"
#include "core/hit_errors.h"
#include "core/reference_tracer.h"
#include "core/render_settings.h"
#include "render/render_stats.h"

namespace meniscus::bench {

struct SurfaceResult {
  HitErrors errors;
  double rmsDistance = 0;      ///< of |t - t0| where both hit, not grazing [Å]
  std::size_t wrongSheet = 0;  ///< of those, by more than 0.1 Å
  double hits = 0;             ///< pixels in which the truth has one, not grazing
  SurfaceStats stats;
  double drawMs = 0;  ///< processor time, all threads
};

/// The truth of a scene, to judge several pictures by.
ReferenceImage truthOf(const BenchScene& scene);

/// Draws once to compile, once to be judged and timed. Needs a current context.
SurfaceResult drawSurface(const BenchScene& scene, const ReferenceImage& truth,
                          const SurfaceSettings& settings);

}  // namespace meniscus::bench

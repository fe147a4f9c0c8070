#pragma once
// What the method "bezier" counts: some of it by its shaders, some beside them.

#include "render/surface/ray_counts.h"

namespace meniscus {

/// Sums of shaders/surface/bezier_step.frag.
struct BezierCounts {
  RayCounts common;
  std::uint32_t events, solved, mostInPiece, longest;
};

struct BezierStatistics {
  /// What was counted since the last call; all counts start anew.
  SurfaceStats take();

  RayCountCopies<BezierCounts> counts;
  double ballsInView = 0, ballsLeft = 0, layers = 0, cellLayers = 0, instancesDrawn = 0, repairs = 0,
         mostBytesPerPixel = 0;
};

}  // namespace meniscus

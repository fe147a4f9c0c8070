#pragma once
// What the method "bezier" counts: some of it by its shaders, some beside them.

#include "render/surface/ray_counts.h"

namespace meniscus {

/// Sums of shaders/include/bezier_pixel.glsl.
struct BezierCounts {
  RayCounts common;
  std::uint32_t events, solved, mostInPiece, longest, walked, looks;
};

struct BezierStatistics {
  /// What was counted since the last call; all counts start anew.
  SurfaceStats take();

  RayCountCopies<BezierCounts> counts;
  double ballsInView = 0, ballsLeft = 0, layers = 0, cellLayers = 0, instancesDrawn = 0, walks = 0,
         mostBytesPerPixel = 0;
};

}  // namespace meniscus

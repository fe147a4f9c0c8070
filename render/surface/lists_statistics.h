#pragma once
// What methods count that cast lists of balls: some of it by their shaders, some beside them.

#include <string>

#include "render/surface/ray_counts.h"

namespace meniscus {

/// Sums of shaders/include/lists_trace.glsl.
struct ListsCounts {
  RayCounts common;
  std::uint32_t looked, taken, unordered, longest;
};

struct ListsStatistics {
  /// What was counted since the last call; all counts start anew.
  SurfaceStats take(std::string method);

  RayCountCopies<ListsCounts> counts;
  double ballsInView = 0, nodes = 0, mostOfPixel = 0, bands = 0, mostBytesPerPixel = 0;
};

}  // namespace meniscus

#pragma once
// The same spheres and rays by Embree: what a ray tracer for the processor takes, for comparison.

#include <vector>

#include "core/primitives.h"
#include "core/view.h"

namespace meniscus::bench {

struct EmbreeTimes {
  double buildMs = 0, castMs = 0;
  std::size_t hits = 0;
  std::vector<float> distance;  ///< rows from the bottom; infinity = background
};

/// Builds the hierarchy and casts a ray through every pixel's centre, eight at a time, on all processors.
EmbreeTimes castByEmbree(const Primitives& primitives, const View& view);

}  // namespace meniscus::bench

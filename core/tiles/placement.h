#pragma once
// Where a primitive is seen from a view.

#include <cstdint>
#include <limits>

namespace meniscus::tiles {

/// Where a primitive can be seen.
struct Placement {
  std::int16_t x0 = 0, y0 = 0, x1 = -1, y1 = -1;  ///< tiles of the grid, both ends included
  /// View-space z that none of its points exceeds; -infinity: it is nowhere.
  float front = -std::numeric_limits<float>::infinity();
  bool visible() const { return front > -std::numeric_limits<float>::infinity(); }
};

/// A disc across the view (pixels of the picture) that hides what lies below z in view space. radius 0: none.
struct Occluder {
  double x = 0, y = 0;
  float radius = 0, z = 0;
};

}  // namespace meniscus::tiles

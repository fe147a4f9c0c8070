#pragma once
// What the method "bezier" counts: some of it by its shaders, some beside them.

#include "render/gl/storage.h"
#include "render/render_stats.h"

namespace meniscus {

class BezierStatistics {
 public:
  /// With the context current.
  void prepare();
  void bindStorage(unsigned binding) const { sums_.bindStorage(binding); }
  /// What was counted since the last call; all counts start anew.
  SurfaceStats take();
  std::uint64_t bytes() const { return sums_.bytes(); }

  double ballsInView = 0, ballsLeft = 0, layers = 0, cellLayers = 0, instancesDrawn = 0, repairs = 0;

 private:
  gl::Storage sums_;
};

}  // namespace meniscus

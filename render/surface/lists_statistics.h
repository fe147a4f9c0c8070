#pragma once
// What the method "lists" counts: some of it by its shaders, some beside them.

#include "render/gl/storage.h"
#include "render/render_stats.h"

namespace meniscus {

class ListsStatistics {
 public:
  /// With the context current.
  void prepare();
  void bindStorage(unsigned binding) const { sums_.bindStorage(binding); }
  /// What was counted since the last call; all counts start anew.
  SurfaceStats take();
  std::uint64_t bytes() const { return sums_.bytes(); }

  double ballsInView = 0, nodes = 0, mostOfPixel = 0, bands = 0, mostBytesPerPixel = 0, mostBytesPerBall = 0;

 private:
  gl::Storage sums_;
};

}  // namespace meniscus

#include "render/surface/ray_counts.h"

#include <glad/gl.h>

#include <algorithm>

namespace meniscus {

void addCounts(SurfaceStats& stats, const RayCounts& counts) {
  stats.pixels += counts.pixels;
  stats.pieces += counts.pieces;
  stats.iterations += counts.iterations;
  stats.mostIterations = std::max<std::uint64_t>(stats.mostIterations, counts.mostIterations);
  stats.overflow += counts.overflow;
  stats.grazing += counts.grazing;
  stats.notConverged += counts.unfinished;
}

void takeCopies(gl::Storage& buffer, void* copies, std::uint64_t bytes) {
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  buffer.read(copies, bytes);
  buffer.zero();
}

}  // namespace meniscus

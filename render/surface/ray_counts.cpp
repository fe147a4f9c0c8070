#include "render/surface/ray_counts.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include <algorithm>

#include "core/error.h"

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

void checkLoops(std::string_view method, std::uint32_t pixels) {
  if (pixels == 0) return;
  throw InputError(fmt::format(
      "surface method {}: more balls overlap in {} pixels than the driver's loops can go through; use "
      "--surface-method tiles",
      method, pixels));
}

void takeCopies(gl::Storage& buffer, void* copies, std::uint64_t bytes) {
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  buffer.read(copies, bytes);
  buffer.zero();
}

}  // namespace meniscus

#include "render/surface/lists_statistics.h"

#include <glad/gl.h>

#include <algorithm>
#include <array>

namespace meniscus {

namespace {

// Statistics of shaders/include/lists_trace.glsl.
struct Sums {
  std::uint32_t pixels, pieces, iterations, mostIterations, overflow, grazing, unfinished, hits;
  std::uint32_t looked, taken, unordered, longest;
};
constexpr int kSumCount = 64;

}  // namespace

void ListsStatistics::prepare() {
  sums_.reserve(sizeof(Sums) * kSumCount);
  sums_.zero();
}

SurfaceStats ListsStatistics::take() {
  SurfaceStats stats;
  stats.method = "lists";
  std::array<Sums, kSumCount> sums{};
  if (sums_.bytes() > 0) {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    sums_.read(sums.data(), sizeof sums);
    sums_.zero();
  }
  double looked = 0, taken = 0, unordered = 0, longest = 0, hits = 0;
  for (const Sums& s : sums) {
    stats.pixels += s.pixels;
    stats.pieces += s.pieces;
    stats.iterations += s.iterations;
    stats.mostIterations = std::max<std::uint64_t>(stats.mostIterations, s.mostIterations);
    stats.overflow += s.overflow;
    stats.grazing += s.grazing;
    stats.notConverged += s.unfinished;
    hits += s.hits;
    looked += s.looked;
    taken += s.taken;
    unordered += s.unordered;
    longest = std::max<double>(longest, s.longest);
  }
  stats.details = {{"crossings", hits},
                   {"pieces looked at for roots", looked},
                   {"balls in view", ballsInView},
                   {"nodes of lists", nodes},
                   {"longest list", mostOfPixel},
                   {"balls taken from lists", taken},
                   {"most balls taken by a pixel", longest},
                   {"lists put in order", unordered},
                   {"bands", bands},
                   {"most bytes per pixel", mostBytesPerPixel},
                   {"most bytes per ball", mostBytesPerBall}};
  ballsInView = nodes = mostOfPixel = bands = mostBytesPerPixel = mostBytesPerBall = 0;
  return stats;
}

}  // namespace meniscus

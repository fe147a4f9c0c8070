#include "render/surface/bezier_statistics.h"

#include <glad/gl.h>

#include <algorithm>
#include <array>

namespace meniscus {

namespace {

// Statistics of shaders/surface/bezier_step.frag.
struct Sums {
  std::uint32_t pixels, pieces, iterations, mostIterations, overflow, grazing, unfinished, events;
  std::uint32_t solved, mostInPiece, hits, longest;
};
constexpr int kSumCount = 64;

}  // namespace

void BezierStatistics::prepare() {
  sums_.reserve(sizeof(Sums) * kSumCount);
  sums_.zero();
}

SurfaceStats BezierStatistics::take() {
  SurfaceStats stats;
  stats.method = "bezier";
  std::array<Sums, kSumCount> sums{};
  if (sums_.bytes() > 0) {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    sums_.read(sums.data(), sizeof sums);
    sums_.zero();
  }
  double events = 0, solved = 0, hits = 0, mostInPiece = 0, longest = 0;
  for (const Sums& s : sums) {
    stats.pixels += s.pixels;
    stats.pieces += s.pieces;
    stats.iterations += s.iterations;
    stats.mostIterations = std::max<std::uint64_t>(stats.mostIterations, s.mostIterations);
    stats.overflow += s.overflow;
    stats.grazing += s.grazing;
    stats.notConverged += s.unfinished;
    events += s.events;
    solved += s.solved;
    hits += s.hits;
    mostInPiece = std::max<double>(mostInPiece, s.mostInPiece);
    longest = std::max<double>(longest, s.longest);
  }
  stats.details = {{"hits", hits},
                   {"events peeled", events},
                   {"pieces that took iterations", solved},
                   {"most iterations of one piece", mostInPiece},
                   {"longest list", longest},
                   {"balls in view", ballsInView},
                   {"balls left after culling", ballsLeft},
                   {"layers", layers},
                   {"layers of tiles", cellLayers},
                   {"rectangles drawn in layers", instancesDrawn},
                   {"repairs", repairs}};
  ballsInView = ballsLeft = layers = cellLayers = instancesDrawn = repairs = 0;
  return stats;
}

}  // namespace meniscus

#include "render/surface/bezier_statistics.h"

#include <algorithm>

namespace meniscus {

SurfaceStats BezierStatistics::take() {
  SurfaceStats stats;
  stats.method = "bezier";
  double events = 0, solved = 0, hits = 0, mostInPiece = 0, longest = 0, walked = 0, looks = 0;
  for (const BezierCounts& c : counts.take(stats)) {
    events += c.events;
    walked += c.walked;
    looks += c.looks;
    solved += c.solved;
    hits += c.common.hits;
    mostInPiece = std::max<double>(mostInPiece, c.mostInPiece);
    longest = std::max<double>(longest, c.longest);
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
                   {"draws without lists", walks},
                   {"pixels without lists", walked},
                   {"looks at their balls", looks},
                   {"most bytes per pixel", mostBytesPerPixel}};
  ballsInView = ballsLeft = layers = cellLayers = instancesDrawn = walks = mostBytesPerPixel = 0;
  return stats;
}

}  // namespace meniscus

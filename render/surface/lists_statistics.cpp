#include "render/surface/lists_statistics.h"

#include <algorithm>
#include <utility>

namespace meniscus {

SurfaceStats ListsStatistics::take(std::string method) {
  SurfaceStats stats;
  stats.method = std::move(method);
  double looked = 0, taken = 0, unordered = 0, longest = 0, hits = 0;
  for (const ListsCounts& c : counts.take(stats)) {
    hits += c.common.hits;
    looked += c.looked;
    taken += c.taken;
    unordered += c.unordered;
    longest = std::max<double>(longest, c.longest);
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
                   {"most bytes per pixel", mostBytesPerPixel}};
  ballsInView = nodes = mostOfPixel = bands = mostBytesPerPixel = 0;
  return stats;
}

}  // namespace meniscus

#pragma once
// Counting sorts in parallel: each chunk of the items counts its bins, sums say where its share of each bin
// begins, and each chunk brings its items there. Equal items keep their order.

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace meniscus::tiles {

inline constexpr std::size_t kLeastChunk = 4096;  ///< items that one task sorts
inline constexpr std::size_t kMostChunks = 64;

struct Chunks {
  std::size_t size, count;
};
inline Chunks chunksOf(std::size_t count) {
  const std::size_t size = std::max(kLeastChunk, (count + kMostChunks - 1) / kMostChunks);
  return {size, (count + size - 1) / size};
}

/// Calls f(chunk, first, last) for each chunk, in parallel.
template <typename F>
void forChunks(std::size_t count, F f) {
  const Chunks chunks = chunksOf(count);
  tbb::parallel_for(std::size_t{0}, chunks.count,
                    [&](std::size_t c) { f(c, c * chunks.size, std::min(count, (c + 1) * chunks.size)); });
}

/// Turns counts, chunk by chunk for each of `bins`, into the places where each chunk's share of each bin
/// begins; returns the sum.
inline std::size_t placeBins(std::vector<std::size_t>& counts, std::size_t chunks, std::size_t bins) {
  std::size_t sum = 0;
  for (std::size_t b = 0; b < bins; ++b) {
    for (std::size_t c = 0; c < chunks; ++c) {
      std::size_t& slot = counts[c * bins + b];
      const std::size_t here = slot;
      slot = sum;
      sum += here;
    }
  }
  return sum;
}

}  // namespace meniscus::tiles

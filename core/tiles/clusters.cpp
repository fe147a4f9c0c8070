#include "core/tiles/clusters.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "core/tiles/chunks.h"

namespace meniscus::tiles {

namespace {

// Below, placing every primitive costs less than a frame's other work.
constexpr std::size_t kFewest = 20000;
// Cells along an axis: so many bits that a cell holds a few primitives, which the sort then need not order.
constexpr int kMostBitsPerAxis = 10;
constexpr std::size_t kPerCell = 8;

int bitsPerAxis(std::size_t count) {
  return std::clamp((static_cast<int>(std::bit_width(count / kPerCell)) + 2) / 3, 1, kMostBitsPerAxis);
}

// Puts two zeros between the bits.
std::uint32_t spread(std::uint32_t x) {
  x = (x | x << 16) & 0x030000FFu;
  x = (x | x << 8) & 0x0300F00Fu;
  x = (x | x << 4) & 0x030C30C3u;
  return (x | x << 2) & 0x09249249u;
}

struct Keyed {
  std::uint32_t key, index;
};

// By key; equal keys stay in order.
void sortByKey(std::vector<Keyed>& items, int bits) {
  std::vector<Keyed> other(items.size());
  const std::size_t chunks = chunksOf(items.size()).count;
  std::vector<std::size_t> places;
  constexpr int kMostBits = 10;
  const int passes = (bits + kMostBits - 1) / kMostBits, perPass = (bits + passes - 1) / passes;
  const std::size_t bins = std::size_t{1} << perPass;
  for (int shift = 0; shift < bits; shift += perPass) {
    const auto binOf = [&](const Keyed& item) { return item.key >> shift & (bins - 1); };
    places.assign(chunks * bins, 0);
    forChunks(items.size(), [&](std::size_t c, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) ++places[c * bins + binOf(items[i])];
    });
    placeBins(places, chunks, bins);
    forChunks(items.size(), [&](std::size_t c, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) other[places[c * bins + binOf(items[i])]++] = items[i];
    });
    items.swap(other);
  }
}

}  // namespace

void Clusters::build(std::size_t count, const std::function<Ball(std::size_t)>& ballOf) {
  order_.clear();
  balls_.clear();
  list_.clear();
  if (count < kFewest) return;
  const auto drawn = [](const Ball& b) {
    return b.radius >= 0 && std::isfinite(b.radius + b.center.x + b.center.y + b.center.z);
  };
  struct Box {
    glm::vec3 low{std::numeric_limits<float>::infinity()}, high{-std::numeric_limits<float>::infinity()};
    std::size_t drawn = 0;
  };
  std::vector<Box> boxes(chunksOf(count).count);
  forChunks(count, [&](std::size_t c, std::size_t first, std::size_t last) {
    Box& box = boxes[c];
    for (std::size_t i = first; i < last; ++i) {
      const Ball ball = ballOf(i);
      if (!drawn(ball)) continue;
      box.low = glm::min(box.low, ball.center);
      box.high = glm::max(box.high, ball.center);
      ++box.drawn;
    }
  });
  Box all;
  for (Box& box : boxes) {
    all.low = glm::min(all.low, box.low);
    all.high = glm::max(all.high, box.high);
    all.drawn += std::exchange(box.drawn, all.drawn);  // now where the chunk's items begin
  }
  const int bits = bitsPerAxis(count);
  const glm::vec3 size = all.high - all.low;
  const float scale = static_cast<float>((1 << bits) - 1) / std::max({size.x, size.y, size.z, 1e-30f});
  std::vector<Keyed> items(all.drawn);
  forChunks(count, [&](std::size_t c, std::size_t first, std::size_t last) {
    std::size_t to = boxes[c].drawn;
    for (std::size_t i = first; i < last; ++i) {
      const Ball ball = ballOf(i);
      if (!drawn(ball)) continue;
      const glm::vec3 p = (ball.center - all.low) * scale;
      items[to++] = {spread(static_cast<std::uint32_t>(p.x)) | spread(static_cast<std::uint32_t>(p.y)) << 1 |
                         spread(static_cast<std::uint32_t>(p.z)) << 2,
                     static_cast<std::uint32_t>(i)};
    }
  });
  sortByKey(items, 3 * bits);
  order_.resize(items.size());
  balls_.resize(items.size());
  list_.resize((items.size() + kClusterSize - 1) / kClusterSize);
  tbb::parallel_for(std::size_t{0}, list_.size(), [&](std::size_t c) {
    const std::size_t first = c * kClusterSize, last = std::min(items.size(), first + kClusterSize);
    glm::vec3 from(std::numeric_limits<float>::infinity()), to(-from);
    for (std::size_t i = first; i < last; ++i) {
      order_[i] = items[i].index;
      balls_[i] = ballOf(items[i].index);
      from = glm::min(from, balls_[i].center);
      to = glm::max(to, balls_[i].center);
    }
    const glm::vec3 center = 0.5f * (from + to);
    float radius = 0;
    for (std::size_t i = first; i < last; ++i) {
      const Ball& ball = balls_[i];
      radius = std::max(radius, glm::distance(center, ball.center) + ball.radius);
    }
    // A little more, so that rounding brings no ball in front of its cluster.
    radius += 1e-5f * radius + 1e-6f * glm::length(center);
    list_[c] = {center, radius, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last)};
  });
}

std::uint64_t Clusters::bytes() const {
  return sizeof(std::uint32_t) * order_.capacity() + sizeof(Ball) * balls_.capacity() +
         sizeof(Cluster) * list_.capacity();
}

}  // namespace meniscus::tiles

#include "core/tiles/clusters.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>
#include <utility>

#include "core/tiles/chunks.h"

namespace meniscus::tiles {

namespace {

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

// Of a radius: float32's rounding, and what a motion that is not quite rigid lengthens.
constexpr float kSpare = 3e-5f;

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

// A little larger, so that rounding brings no ball in front of it, whatever it is turned by.
Clusters::Ball ballAround(std::span<const Clusters::Ball> balls) {
  glm::vec3 from(std::numeric_limits<float>::infinity()), to(-from);
  for (const Clusters::Ball& ball : balls) {
    from = glm::min(from, ball.center);
    to = glm::max(to, ball.center);
  }
  const glm::vec3 center = 0.5f * (from + to);
  float radius = 0;
  for (const Clusters::Ball& ball : balls)
    radius = std::max(radius, glm::distance(center, ball.center) + ball.radius);
  return {center, radius + kSpare * radius + 1e-6f * glm::length(center)};
}

}  // namespace

bool Clusters::worthwhile(std::size_t primitives) {
  return primitives >= kFewest;
}

void Clusters::add(std::size_t count, const std::function<Ball(std::size_t)>& ballOf,
                   std::span<const RigidMotion> copies) {
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
  const std::size_t before = order_.size(), clustersBefore = list_.size();
  order_.resize(before + items.size());
  balls_.resize(before + items.size());
  list_.resize(clustersBefore + (items.size() + kClusterSize - 1) / kClusterSize);
  tbb::parallel_for(clustersBefore, list_.size(), [&](std::size_t c) {
    const std::size_t first = before + (c - clustersBefore) * kClusterSize,
                      last = std::min(order_.size(), first + kClusterSize);
    for (std::size_t i = first; i < last; ++i) {
      order_[i] = items[i - before].index;
      balls_[i] = ballOf(order_[i]);
    }
    const Ball ball = ballAround(std::span<const Ball>(balls_).subspan(first, last - first));
    list_[c] = {ball.center, ball.radius, static_cast<std::uint32_t>(first),
                static_cast<std::uint32_t>(last)};
  });
  std::vector<Ball> clusters;
  for (std::size_t c = clustersBefore; c < list_.size(); ++c)
    clusters.push_back({list_[c].center, list_[c].radius});
  addCopies(static_cast<std::uint32_t>(clustersBefore), ballAround(clusters), count, copies);
}

// Of the clusters from `first` on.
void Clusters::addCopies(std::uint32_t first, const Ball& ball, std::size_t count,
                         std::span<const RigidMotion> copies) {
  const auto set = static_cast<std::uint32_t>(sets_.size()), last = static_cast<std::uint32_t>(list_.size());
  std::uint32_t cluster = 0;
  if (!copies_.empty()) {
    cluster = copies_.back().firstCluster + sets_[copies_.back().set].size();
  }
  sets_.push_back({first, last, ball});
  copies_.reserve(copies_.size() + copies.size());
  for (const RigidMotion& motion : copies) {
    copies_.push_back({motion, set, primitives_, cluster});
    primitives_ += static_cast<std::uint32_t>(count);
    cluster += last - first;
  }
}

const ClusterCopy& Clusters::copyOf(std::uint32_t cluster) const {
  // Of copies without clusters, the last one begins where the next begins.
  return *std::prev(
      std::upper_bound(copies_.begin(), copies_.end(), cluster,
                       [](std::uint32_t number, const ClusterCopy& c) { return number < c.firstCluster; }));
}

std::uint64_t Clusters::bytes() const {
  return sizeof(std::uint32_t) * order_.capacity() + sizeof(Ball) * balls_.capacity() +
         sizeof(Cluster) * list_.capacity() + sizeof(Set) * sets_.capacity() +
         sizeof(ClusterCopy) * copies_.capacity();
}

}  // namespace meniscus::tiles

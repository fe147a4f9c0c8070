#include "core/tiles/clusters.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace meniscus::tiles {

namespace {

// Below, placing every primitive costs less than a frame's other work.
constexpr std::size_t kFewest = 20000;
constexpr int kBitsPerAxis = 10;

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

// By key, ten bits at a time; equal keys stay in order.
void sortByKey(std::vector<Keyed>& items) {
  std::vector<Keyed> other(items.size());
  constexpr std::uint32_t kBins = 1u << kBitsPerAxis;
  for (int shift = 0; shift < 3 * kBitsPerAxis; shift += kBitsPerAxis) {
    std::array<std::uint32_t, kBins> next{};
    for (const Keyed& item : items) ++next[item.key >> shift & (kBins - 1)];
    std::uint32_t sum = 0;
    for (std::uint32_t& bin : next) sum += std::exchange(bin, sum);
    for (const Keyed& item : items) other[next[item.key >> shift & (kBins - 1)]++] = item;
    items.swap(other);
  }
}

}  // namespace

void Clusters::build(std::size_t count, const std::function<Ball(std::size_t)>& ballOf) {
  order_.clear();
  balls_.clear();
  list_.clear();
  if (count < kFewest) return;
  std::vector<Ball> balls(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) { balls[i] = ballOf(i); });
  const auto drawn = [](const Ball& b) {
    return b.radius >= 0 && std::isfinite(b.radius + b.center.x + b.center.y + b.center.z);
  };
  glm::vec3 low(std::numeric_limits<float>::infinity()), high(-low);
  std::vector<Keyed> items;
  items.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (!drawn(balls[i])) continue;
    low = glm::min(low, balls[i].center);
    high = glm::max(high, balls[i].center);
    items.push_back({0, static_cast<std::uint32_t>(i)});
  }
  const float extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-30f});
  const float scale = static_cast<float>((1 << kBitsPerAxis) - 1) / extent;
  tbb::parallel_for(std::size_t{0}, items.size(), [&](std::size_t i) {
    const glm::vec3 p = (balls[items[i].index].center - low) * scale;
    items[i].key = spread(static_cast<std::uint32_t>(p.x)) | spread(static_cast<std::uint32_t>(p.y)) << 1 |
                   spread(static_cast<std::uint32_t>(p.z)) << 2;
  });
  sortByKey(items);
  order_.resize(items.size());
  balls_.resize(items.size());
  list_.resize((items.size() + kClusterSize - 1) / kClusterSize);
  tbb::parallel_for(std::size_t{0}, list_.size(), [&](std::size_t c) {
    const std::size_t first = c * kClusterSize, last = std::min(items.size(), first + kClusterSize);
    glm::vec3 from(std::numeric_limits<float>::infinity()), to(-from);
    for (std::size_t i = first; i < last; ++i) {
      order_[i] = items[i].index;
      balls_[i] = balls[items[i].index];
      from = glm::min(from, balls[items[i].index].center);
      to = glm::max(to, balls[items[i].index].center);
    }
    const glm::vec3 center = 0.5f * (from + to);
    float radius = 0;
    for (std::size_t i = first; i < last; ++i) {
      const Ball& ball = balls_[i];
      radius = std::max(radius, glm::distance(center, ball.center) + ball.radius);
    }
    list_[c] = {center, radius * 1.00001f, static_cast<std::uint32_t>(first),
                static_cast<std::uint32_t>(last)};
  });
}

std::uint64_t Clusters::bytes() const {
  return sizeof(std::uint32_t) * order_.capacity() + sizeof(Ball) * balls_.capacity() +
         sizeof(Cluster) * list_.capacity();
}

}  // namespace meniscus::tiles

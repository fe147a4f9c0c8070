#include "core/ball_overlaps.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>

#include "core/error.h"

namespace meniscus {

namespace {

// Balls of supports from 2^(e-1) to 2^e, in cells of side 2^(e+1): whoever is not larger and reaches one of
// them lies in its cell or a neighbour of that.
struct SizeClass {
  struct Entry {
    std::uint64_t cell;
    std::uint32_t rank;
  };
  double side;
  std::vector<Entry> entries;  // by cell, then rank

  // 21 bits of each coordinate: cells that share a key are two million cells apart.
  static std::uint64_t keyOf(std::int64_t x, std::int64_t y, std::int64_t z) {
    constexpr std::int64_t kMask = (1 << 21) - 1;
    return static_cast<std::uint64_t>((x & kMask) << 42 | (y & kMask) << 21 | (z & kMask));
  }
  std::int64_t along(float x) const {
    return static_cast<std::int64_t>(std::floor(static_cast<double>(x) / side));
  }

  template <class Visit>
  void visitAround(const glm::vec3& at, const Visit& visit) const {
    for (std::int64_t i = 0; i < 27; ++i) {
      const std::uint64_t key =
          keyOf(along(at.x) + i % 3 - 1, along(at.y) + i / 3 % 3 - 1, along(at.z) + i / 9 - 1);
      auto entry = std::lower_bound(entries.begin(), entries.end(), key,
                                    [](const Entry& e, std::uint64_t k) { return e.cell < k; });
      for (; entry != entries.end() && entry->cell == key; ++entry) visit(entry->rank);
    }
  }
};

bool overlap(const Metaball& a, const Metaball& b) {
  const glm::dvec3 d = glm::dvec3(a.center) - glm::dvec3(b.center);
  const double reach = static_cast<double>(a.support) + static_cast<double>(b.support);
  return glm::dot(d, d) < reach * reach;
}

}  // namespace

BallOverlaps findOverlaps(const MetaballField& field, std::size_t mostEntries, const char* what) {
  const std::size_t count = field.balls.size();
  BallOverlaps out;
  out.order.resize(count);
  std::iota(out.order.begin(), out.order.end(), 0u);
  std::stable_sort(out.order.begin(), out.order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return field.balls[a].support < field.balls[b].support;
  });
  const auto ball = [&](std::uint32_t rank) -> const Metaball& { return field.balls[out.order[rank]]; };

  std::map<int, SizeClass> classes;
  const auto classOf = [](const Metaball& b) { return std::ilogb(b.support) + 1; };
  for (std::uint32_t rank = 0; rank < count; ++rank) {
    SizeClass& c = classes.try_emplace(classOf(ball(rank)), SizeClass{}).first->second;
    c.side = std::exp2(classOf(ball(rank)) + 1);
    const glm::vec3& at = ball(rank).center;
    c.entries.push_back({SizeClass::keyOf(c.along(at.x), c.along(at.y), c.along(at.z)), rank});
  }
  for (auto& [exponent, c] : classes)
    std::stable_sort(c.entries.begin(), c.entries.end(),
                     [](const auto& a, const auto& b) { return a.cell < b.cell; });

  // Each pair once, found by the ball that comes first.
  using Pair = std::pair<std::uint32_t, std::uint32_t>;
  tbb::enumerable_thread_specific<std::vector<Pair>> found;
  std::atomic<std::size_t> pairs{0};
  tbb::parallel_for(std::uint32_t{0}, static_cast<std::uint32_t>(count), [&](std::uint32_t rank) {
    std::vector<Pair>& mine = found.local();
    const std::size_t before = mine.size();
    for (auto at = classes.lower_bound(classOf(ball(rank))); at != classes.end(); ++at)
      at->second.visitAround(ball(rank).center, [&](std::uint32_t other) {
        if (other > rank && overlap(ball(rank), ball(other))) mine.emplace_back(rank, other);
      });
    if (2 * (pairs += mine.size() - before) > mostEntries)
      throw InputError(fmt::format(
          "{}: balls overlap more than {} times, which is more than its lists hold; choose another "
          "--surface-method, a smaller --blend, or draw less",
          what, mostEntries / 2));
  });
  out.first.assign(count + 1, 0);
  out.smaller.assign(count, 0);
  for (const std::vector<Pair>& some : found) {
    for (const auto& [a, b] : some) {
      ++out.first[a + 1];
      ++out.first[b + 1];
      ++out.smaller[b];
    }
  }
  std::partial_sum(out.first.begin(), out.first.end(), out.first.begin());
  out.others.resize(out.first.back());
  std::vector<std::uint32_t> next(out.first.begin(), out.first.end() - 1);
  for (const std::vector<Pair>& some : found) {
    for (const auto& [a, b] : some) {
      out.others[next[a]++] = b;
      out.others[next[b]++] = a;
    }
  }
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t rank) {
    std::sort(out.others.begin() + out.first[rank], out.others.begin() + out.first[rank + 1]);
  });
  return out;
}

}  // namespace meniscus

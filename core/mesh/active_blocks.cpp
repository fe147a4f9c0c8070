#include "core/mesh/active_blocks.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <atomic>
#include <numeric>

#include "core/error.h"

namespace meniscus::mesh {

namespace {

// Rounding of a sum of many terms, as a share of what they could add up to.
constexpr double kSlack = 1e-12;
// Boxes of more cubes along a side share their work among processors.
constexpr int kSharedSide = 32;

class Search {
 public:
  Search(const MetaballField& field, std::span<const WideBall> balls, const Grid& grid,
         std::size_t mostBlocks)
      : field_(field), balls_(balls), grid_(grid), most_(mostBlocks) {}

  std::vector<ActiveBlock> run() {
    std::vector<std::uint32_t> all(balls_.size());
    std::iota(all.begin(), all.end(), 0u);
    visit(glm::ivec3(0), grid_.side, all);
    std::vector<ActiveBlock> out;
    out.reserve(count_);
    for (auto& some : found_) std::move(some.begin(), some.end(), std::back_inserter(out));
    tbb::parallel_sort(out.begin(), out.end(),
                       [](const ActiveBlock& a, const ActiveBlock& b) { return a.key < b.key; });
    return out;
  }

 private:
  void visit(const glm::ivec3& first, int side, std::span<const std::uint32_t> candidates);
  bool mayMeet(const glm::ivec3& first, int side, std::span<const std::uint32_t> candidates,
               std::vector<std::uint32_t>& inside) const;

  const MetaballField& field_;
  std::span<const WideBall> balls_;
  const Grid& grid_;
  std::size_t most_;
  std::atomic<std::size_t> count_{0};
  tbb::enumerable_thread_specific<std::vector<ActiveBlock>> found_;
};

// `inside`: the candidates that reach into the box.
bool Search::mayMeet(const glm::ivec3& first, int side, std::span<const std::uint32_t> candidates,
                     std::vector<std::uint32_t>& inside) const {
  glm::dvec3 low, high;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = grid_.coordinate(axis, first[axis]);
    high[axis] = grid_.coordinate(axis, first[axis] + side);
  }
  double least = -field_.level, most = -field_.level, sum = field_.level;
  for (const std::uint32_t i : candidates) {
    const WideBall& ball = balls_[i];
    double near2 = 0, far2 = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double below = low[axis] - ball.center[axis], above = ball.center[axis] - high[axis];
      const double outside = std::max({below, above, 0.0}), reach = std::max(-below, -above);
      near2 += outside * outside;
      far2 += std::max(reach, outside) * std::max(reach, outside);
    }
    if (!(near2 < ball.support2 * (1 + kSlack))) continue;
    inside.push_back(i);
    const double nearest = fastKernel(field_.kernel, std::max(1 - near2 * ball.inverse2, 0.0)),
                 farthest = fastKernel(field_.kernel, std::max(1 - far2 * ball.inverse2, 0.0));
    const double q = ball.coefficient;
    least += q * (q > 0 ? farthest : nearest);
    most += q * (q > 0 ? nearest : farthest);
    sum += std::abs(q) * nearest;
  }
  const double slack = kSlack * sum;
  return most > -slack && least <= slack;
}

void Search::visit(const glm::ivec3& first, int side, std::span<const std::uint32_t> candidates) {
  std::vector<std::uint32_t> inside;
  if (!mayMeet(first, side, candidates, inside)) return;
  if (side == kBlockSide) {
    if (++count_ > most_)
      throw InputError(
          fmt::format("--mesh-spacing: with {:g} A the surface lies in more than {} blocks of {} cubes, "
                      "which is more memory "
                      "than a mesh may have here; give a larger spacing, or draw less",
                      grid_.spacing, most_, kBlockSide * kBlockSide * kBlockSide));
    found_.local().push_back({blockKey(first), first, std::move(inside)});
    return;
  }
  const int half = side / 2;
  const auto child = [&](int i) {
    visit(first + half * glm::ivec3(i & 1, i >> 1 & 1, i >> 2), half, inside);
  };
  if (side > kSharedSide) {
    tbb::parallel_for(0, 8, child);
  } else {
    for (int i = 0; i < 8; ++i) child(i);
  }
}

}  // namespace

std::uint64_t blockKey(const glm::ivec3& firstNode) {
  const glm::ivec3 at = firstNode / kBlockSide;
  return static_cast<std::uint64_t>(at.z) << 42 | static_cast<std::uint64_t>(at.y) << 21 |
         static_cast<std::uint64_t>(at.x);
}

std::vector<ActiveBlock> findActiveBlocks(const MetaballField& field, std::span<const WideBall> balls,
                                          const Grid& grid, std::size_t mostBlocks) {
  return Search(field, balls, grid, mostBlocks).run();
}

}  // namespace meniscus::mesh

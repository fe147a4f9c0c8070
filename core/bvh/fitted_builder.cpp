#include "core/bvh/fitted_builder.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <span>
#include <utility>

#include "core/bvh/subtree.h"

namespace meniscus::bvh {

namespace {

constexpr int kMostBins = 16;
// Where there are fewer members, fewer bins tell as much.
constexpr std::size_t kFewMembers = 32;
constexpr int kFewBins = 6;
// All leaves together have at most so many members per ball, or a thousand balls that almost coincide would
// be cut into as many cells as there are ways to be in some and not in others.
constexpr double kMostCopies = 16;
// Nodes with more are counted by several threads.
constexpr std::size_t kLeastToCountApart = 65536;

// What construction needs of a ball, side by side in memory.
struct Place {
  glm::vec3 center;
  float support;
  bool positive;
  std::uint32_t ball;  // in the field
};

// The bits of three coordinates of 10 bits, interleaved (Morton 1966).
std::uint32_t mortonCode(const glm::vec3& share) {
  const auto spread = [](float v) {
    auto x = static_cast<std::uint32_t>(std::clamp(v * 1024, 0.0f, 1023.0f));
    x = (x | x << 16) & 0x030000FFu;
    x = (x | x << 8) & 0x0300F00Fu;
    x = (x | x << 4) & 0x030C30C3u;
    return (x | x << 2) & 0x09249249u;
  };
  return spread(share.x) << 2 | spread(share.y) << 1 | spread(share.z);
}

// So that what is close in space is close in memory.
std::vector<Place> placesOf(const MetaballField& field, const Box& around) {
  const glm::vec3 size = glm::max(around.high - around.low, glm::vec3(1e-30f));
  std::vector<std::pair<std::uint32_t, std::uint32_t>> order(field.balls.size());
  tbb::parallel_for(std::size_t{0}, order.size(), [&](std::size_t i) {
    order[i] = {mortonCode((field.balls[i].center - around.low) / size), static_cast<std::uint32_t>(i)};
  });
  tbb::parallel_sort(order);
  std::vector<Place> places(order.size());
  tbb::parallel_for(std::size_t{0}, order.size(), [&](std::size_t i) {
    const Metaball& ball = field.balls[order[i].second];
    places[i] = {ball.center, ball.support, ball.coefficient > 0, order[i].second};
  });
  return places;
}

// Of n balls one has at least an n-th of the level where F >= 0: the share of its support within which it
// has. By n; larger ones rounded up to a power of two.
class Shares {
 public:
  Shares(const MetaballField& field) {
    double most = 0;
    for (const Metaball& ball : field.balls) most = std::max(most, static_cast<double>(ball.coefficient));
    const auto at = [&](double n) {
      return static_cast<float>(coreShare(field.kernel, field.level / n, most) * (1 + 1e-6));
    };
    for (std::size_t n = 0; n < few_.size(); ++n) few_[n] = n > 0 ? at(static_cast<double>(n)) : 0;
    for (std::size_t k = 0; k < powers_.size(); ++k) powers_[k] = at(std::ldexp(1.0, static_cast<int>(k)));
  }
  float of(std::size_t n) const {
    return n < few_.size() ? few_[n] : powers_[static_cast<std::size_t>(std::bit_width(n - 1))];
  }

 private:
  std::array<float, 256> few_{};
  std::array<float, 33> powers_{};
};

struct Cut {
  int axis = -1;  // -1: none is better than a leaf
  float at = 0;
};

// How many members begin and end in each bin, along each axis.
struct Counts {
  std::array<std::array<std::uint32_t, kMostBins>, 3> begin{}, end{};
  void add(const Counts& other) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t k = 0; k < kMostBins; ++k) {
        begin[axis][k] += other.begin[axis][k];
        end[axis][k] += other.end[axis][k];
      }
    }
  }
};

class FittedBuilder {
 public:
  FittedBuilder(const MetaballField& field, const TreeSettings& settings, float slack)
      : settings_(settings), slack_(slack), shares_(field) {
    const FieldBox supports = supportBox(field);
    box_ = {glm::vec3(supports.low), glm::vec3(supports.high)};
    balls_ = placesOf(field, box_);
  }

  Tree run() {
    Arena arena(balls_.size());
    std::iota(arena.begin(), arena.end(), 0u);
    const Cell all{box_, 0, balls_.size(), 0};
    Cell root = prepare(arena, all, all.box, 0);
    root.room = kMostCopies * static_cast<double>(balls_.size());
    return root.box.empty() ? Tree{} : subtree(std::move(arena), root, 0);
  }

 private:
  // Members of the nodes that a thread is at work on, one after the other.
  using Arena = std::vector<std::uint32_t>;
  struct Cell {
    Box box;  // empty: there is no surface in it
    std::size_t from = 0, count = 0;
    double room = 0;  // how many members the leaves below may have together
  };

  Tree subtree(Arena arena, const Cell& cell, int depth) {
    Tree part;
    part.nodes.resize(1);
    build(part, 0, arena, cell, depth);
    return part;
  }
  void build(Tree& tree, std::uint32_t at, Arena& arena, Cell cell, int depth);
  void makeLeaf(Tree& tree, std::uint32_t at, const Arena& arena, const Cell& cell) const;
  Box around(const Cell& left, const Cell& right) const {
    Box both = left.box;
    both.add(right.box);
    return both.grown(slack_ / 2);
  }
  bool pays(const Cell& cell, const Cell& left, const Cell& right) const;
  Cut bestCut(std::span<const std::uint32_t> members, const Box& box) const;
  Counts countIn(std::span<const std::uint32_t> members, const Box& box, const glm::vec3& scale,
                 int bins) const;
  Cell prepare(Arena& arena, const Cell& whole, const Box& box, int axis) const;
  Box fitted(std::span<const std::uint32_t> members, const Box& box) const;
  void discard(Arena& arena, Cell& cell) const;
  void keep(Arena& arena, Cell& cell) const;

  Box box_;
  std::vector<Place> balls_;
  TreeSettings settings_;
  float slack_;
  Shares shares_;
};

Counts FittedBuilder::countIn(std::span<const std::uint32_t> members, const Box& box, const glm::vec3& scale,
                              int bins) const {
  Counts counts;
  const glm::vec3 last(static_cast<float>(bins) - 0.5f);
  for (const std::uint32_t i : members) {
    const Place& ball = balls_[i];
    const glm::vec3 middle = ball.center - box.low;
    const float reach = ball.support + slack_;
    const glm::vec3 from = glm::clamp((middle - reach) * scale, glm::vec3(0), last);
    const glm::vec3 to = glm::clamp((middle + reach) * scale, glm::vec3(0), last);
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      ++counts.begin[a][static_cast<std::size_t>(from[axis])];
      ++counts.end[a][static_cast<std::size_t>(to[axis])];
    }
  }
  return counts;
}

Cut FittedBuilder::bestCut(std::span<const std::uint32_t> members, const Box& box) const {
  const int bins = members.size() < kFewMembers ? kFewBins : kMostBins;
  const glm::vec3 size = box.high - box.low;
  glm::vec3 scale(0);
  for (int axis = 0; axis < 3; ++axis)
    if (size[axis] > 0) scale[axis] = static_cast<float>(bins) / size[axis];
  Counts counts;
  if (members.size() < kLeastToCountApart) {
    counts = countIn(members, box, scale, bins);
  } else {
    counts = tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, members.size(), kLeastToShare), Counts{},
        [&](const tbb::blocked_range<std::size_t>& range, Counts sum) {
          sum.add(countIn(members.subspan(range.begin(), range.size()), box, scale, bins));
          return sum;
        },
        [](Counts a, const Counts& b) {
          a.add(b);
          return a;
        });
  }
  Cut best;
  double least = costOfLeaf(settings_.cost, members.size());
  const double step = costOfStep(settings_.cost), area = std::max(halfArea(box), 1e-300);
  for (int axis = 0; axis < 3; ++axis) {
    if (!(size[axis] > 0)) continue;
    const auto a = static_cast<std::size_t>(axis);
    // Half the surface of a part is what its ends have, and what its sides have by its length.
    const double across = static_cast<double>(size[(axis + 1) % 3]),
                 up = static_cast<double>(size[(axis + 2) % 3]);
    const double ends = across * up / area, sides = (across + up) / area;
    std::size_t left = 0, right = members.size();
    for (int k = 1; k < bins; ++k) {
      left += counts.begin[a][static_cast<std::size_t>(k - 1)];
      right -= counts.end[a][static_cast<std::size_t>(k - 1)];
      const double length = static_cast<double>(size[axis]) * k / bins;
      const double rest = static_cast<double>(size[axis]) - length;
      const double cost = step + (ends + sides * length) * costOfLeaf(settings_.cost, left) +
                          (ends + sides * rest) * costOfLeaf(settings_.cost, right);
      if (!(cost < least)) continue;
      const float at = box.low[axis] + static_cast<float>(length);
      if (!(at > box.low[axis] && at < box.high[axis])) continue;
      least = cost;
      best = {axis, at};
    }
  }
  return best;
}

Box FittedBuilder::fitted(std::span<const std::uint32_t> members, const Box& box) const {
  const auto positive =
      std::count_if(members.begin(), members.end(), [&](std::uint32_t i) { return balls_[i].positive; });
  const float share = settings_.tight ? shares_.of(static_cast<std::size_t>(positive)) : 1;
  Box around;
  if (!(share > 0)) return around;  // they never add up to the level
  for (const std::uint32_t i : members) {
    const Place& ball = balls_[i];
    if (settings_.tight && !ball.positive) continue;
    const float reach = ball.support * share;
    around.add({ball.center - reach, ball.center + reach});
  }
  return {glm::max(box.low, around.low), glm::min(box.high, around.high)};
}

// Those that reach into the cell.
void FittedBuilder::keep(Arena& arena, Cell& cell) const {
  const Box wide = cell.box.grown(slack_);
  const auto from = arena.begin() + static_cast<std::ptrdiff_t>(cell.from);
  const auto end = std::remove_if(from, arena.end(), [&](std::uint32_t i) {
    return !reachesInto(balls_[i].center, balls_[i].support, wide);
  });
  arena.erase(end, arena.end());
  cell.count = arena.size() - cell.from;
}

void FittedBuilder::discard(Arena& arena, Cell& cell) const {
  const Box wide = cell.box.grown(slack_);
  const float share = shares_.of(cell.count);
  const auto begin = arena.begin() + static_cast<std::ptrdiff_t>(cell.from);
  // Those that may have an n-th of the level somewhere in the cell come first.
  const auto others = std::stable_partition(begin, arena.end(), [&](std::uint32_t i) {
    return balls_[i].positive && reachesInto(balls_[i].center, balls_[i].support * share, wide);
  });
  const auto end = std::remove_if(others, arena.end(), [&](std::uint32_t i) {
    return std::none_of(begin, others, [&](std::uint32_t j) {
      const glm::vec3 v = balls_[i].center - balls_[j].center;
      const float reach = (balls_[i].support + balls_[j].support * share) * (1 + 1e-6f) + slack_;
      return glm::dot(v, v) < reach * reach;
    });
  });
  arena.erase(end, arena.end());
  cell.count = arena.size() - cell.from;
  if (others == begin) cell = {Box{}, cell.from, 0, 0};
}

// `box` is a part of a cell, cut off along an axis; its members go to the arena's end.
FittedBuilder::Cell FittedBuilder::prepare(Arena& arena, const Cell& whole, const Box& box, int axis) const {
  Cell cell{box, arena.size(), 0, 0};
  const float low = box.low[axis] - slack_, high = box.high[axis] + slack_;
  arena.resize(cell.from + whole.count);
  auto out = arena.begin() + static_cast<std::ptrdiff_t>(cell.from);
  for (std::size_t k = whole.from; k < whole.from + whole.count; ++k) {
    const Place& ball = balls_[arena[k]];
    *out = arena[k];
    out += ball.center[axis] + ball.support > low && ball.center[axis] - ball.support < high ? 1 : 0;
  }
  arena.erase(out, arena.end());
  cell.count = arena.size() - cell.from;
  if (settings_.fit && cell.count > 0) cell.box = fitted(std::span(arena).subspan(cell.from), box);
  if (!cell.box.empty()) keep(arena, cell);
  if (settings_.discard && cell.count > 0 && cell.count <= kMostToDiscardFrom && !cell.box.empty())
    discard(arena, cell);
  if (cell.count == 0) cell.box = {};
  if (cell.box.empty()) {
    arena.resize(cell.from);
    cell.count = 0;
  }
  return cell;
}

void FittedBuilder::makeLeaf(Tree& tree, std::uint32_t at, const Arena& arena, const Cell& cell) const {
  Node& node = tree.nodes[at];
  node.box = cell.box.empty() ? Box{} : cell.box.grown(slack_ / 2);
  node.first = static_cast<std::uint32_t>(tree.members.size());
  node.count = node.own = static_cast<std::uint32_t>(cell.count);
  for (std::size_t k = cell.from; k < cell.from + cell.count; ++k)
    tree.members.push_back(balls_[arena[k]].ball);
}

// Whether two parts, as they have turned out, are cheaper than the whole.
bool FittedBuilder::pays(const Cell& cell, const Cell& left, const Cell& right) const {
  const auto share = [&](const Cell& part) {
    return halfArea(part.box) * costOfLeaf(settings_.cost, part.count) / std::max(halfArea(cell.box), 1e-300);
  };
  return costOfStep(settings_.cost) + share(left) + share(right) < costOfLeaf(settings_.cost, cell.count);
}

void FittedBuilder::build(Tree& tree, std::uint32_t at, Arena& arena, Cell cell, int depth) {
  const std::size_t top = arena.size();
  while (true) {
    const std::span<const std::uint32_t> members(arena.data() + cell.from, cell.count);
    const bool few = costOfLeaf(settings_.cost, cell.count) <= costOfStep(settings_.cost);
    const Cut cut = few ? Cut{} : bestCut(members, cell.box);
    Cell left, right;
    const std::size_t before = arena.size();
    bool worthwhile = cut.axis >= 0;
    if (worthwhile) {
      Box low = cell.box, high = cell.box;
      low.high[cut.axis] = high.low[cut.axis] = cut.at;
      left = prepare(arena, cell, low, cut.axis);
      right = prepare(arena, cell, high, cut.axis);
      worthwhile = pays(cell, left, right);
    }
    const double wanted = static_cast<double>(left.count + right.count);
    const bool possible = depth < kMostDepth && wanted <= cell.room;
    if (!worthwhile || !possible) {
      if (worthwhile) ++tree.forcedLeaves;
      arena.resize(before);
      makeLeaf(tree, at, arena, cell);
      arena.resize(top);
      return;
    }
    left.room = cell.room * static_cast<double>(left.count) / wanted;
    right.room = cell.room * static_cast<double>(right.count) / wanted;
    if (left.box.empty() || right.box.empty()) {  // the other half is all there is
      cell = left.box.empty() ? right : left;
      ++depth;
      continue;
    }
    tree.nodes[at].box = around(left, right);
    const std::uint32_t child = addChildren(tree, at);
    if (left.count + right.count < kLeastToShare) {
      build(tree, child + 1, arena, right, depth + 1);
      arena.resize(right.from);
      build(tree, child, arena, left, depth + 1);
    } else {
      Tree parts[2];
      const auto apart = [&](const Cell& part) {
        const auto from = arena.begin() + static_cast<std::ptrdiff_t>(part.from);
        return subtree(Arena(from, from + static_cast<std::ptrdiff_t>(part.count)),
                       {part.box, 0, part.count, part.room}, depth + 1);
      };
      tbb::parallel_invoke([&] { parts[0] = apart(left); }, [&] { parts[1] = apart(right); });
      graft(tree, child, std::move(parts[0]));
      graft(tree, child + 1, std::move(parts[1]));
    }
    arena.resize(top);
    return;
  }
}

}  // namespace

Tree buildFitted(const MetaballField& field, const TreeSettings& settings, float slack) {
  if (field.balls.empty()) return {};
  Tree tree = FittedBuilder(field, settings, slack).run();
  countNodes(tree);
  return tree;
}

}  // namespace meniscus::bvh

#include "core/bvh/box_tree.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <limits>
#include <numeric>

#include "core/bvh/subtree.h"

namespace meniscus::bvh {

void Box::add(const Box& other) {
  low = glm::min(low, other.low);
  high = glm::max(high, other.high);
}

double halfArea(const Box& box) {
  if (box.empty()) return 0;
  const glm::dvec3 size = glm::dvec3(box.high) - glm::dvec3(box.low);
  return size.x * size.y + size.y * size.z + size.z * size.x;
}

double costOfLeaf(LeafCost cost, std::size_t members) {
  const double n = static_cast<double>(members);
  return cost == LeafCost::linear ? n : n * n;
}

void countNodes(Tree& tree) {
  tree.leaves = 0;
  tree.depth = 0;
  std::vector<std::pair<std::uint32_t, int>> stack;
  if (!tree.nodes.empty()) stack.emplace_back(0, 0);
  while (!stack.empty()) {
    const auto [at, depth] = stack.back();
    stack.pop_back();
    tree.depth = std::max(tree.depth, depth);
    if (tree.nodes[at].leaf()) {
      ++tree.leaves;
    } else {
      for (std::uint32_t i = 0; i < 2; ++i) stack.emplace_back(tree.nodes[at].first + i, depth + 1);
    }
  }
}

namespace {

constexpr int kBoxBins = 16;

struct Bin {
  Box box;
  std::size_t count = 0;
};

glm::vec3 middleOf(const Box& box) {
  return 0.5f * (box.low + box.high);
}

struct Split {
  int axis = -1;  // -1: none is better than a leaf
  int bin = 0;    // the first on the right
};

class BoxTreeBuilder {
 public:
  BoxTreeBuilder(std::span<const Box> boxes, LeafCost cost) : boxes_(boxes), cost_(cost) {}

  Tree run(std::span<std::uint32_t> order) {
    Tree tree;
    tree.nodes.resize(1);
    build(tree, 0, order, 0);
    return tree;
  }

 private:
  // Of the members' middles, along one axis, in kBoxBins.
  struct Bins {
    float from, scale;
    int of(float at) const { return std::clamp(static_cast<int>((at - from) * scale), 0, kBoxBins - 1); }
  };
  static Bins binsOf(const Box& middles, int axis) {
    const float size = middles.high[axis] - middles.low[axis];
    return {middles.low[axis], size > 0 ? static_cast<float>(kBoxBins) / size : 0};
  }

  void build(Tree& tree, std::uint32_t at, std::span<std::uint32_t> order, int depth);
  Split bestSplit(std::span<const std::uint32_t> order, const Box& box, const Box& middles) const;
  Tree subtree(std::span<std::uint32_t> order, int depth) {
    Tree part;
    part.nodes.resize(1);
    build(part, 0, order, depth);
    return part;
  }

  std::span<const Box> boxes_;
  LeafCost cost_;
};

Split BoxTreeBuilder::bestSplit(std::span<const std::uint32_t> order, const Box& box,
                                const Box& middles) const {
  std::array<Bins, 3> bins{};
  for (int axis = 0; axis < 3; ++axis) bins[static_cast<std::size_t>(axis)] = binsOf(middles, axis);
  std::array<std::array<Bin, kBoxBins>, 3> filled{};
  for (const std::uint32_t i : order) {
    const glm::vec3 middle = middleOf(boxes_[i]);
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      Bin& bin = filled[a][static_cast<std::size_t>(bins[a].of(middle[axis]))];
      bin.box.add(boxes_[i]);
      ++bin.count;
    }
  }
  Split best;
  const double area = std::max(halfArea(box), 1e-300);
  double least = costOfLeaf(cost_, order.size());
  for (int axis = 0; axis < 3; ++axis) {
    const auto& line = filled[static_cast<std::size_t>(axis)];
    std::array<double, kBoxBins> left{};
    Bin sum;
    for (std::size_t k = 1; k < kBoxBins; ++k) {
      sum.box.add(line[k - 1].box);
      sum.count += line[k - 1].count;
      left[k] = sum.count > 0 ? halfArea(sum.box) * costOfLeaf(cost_, sum.count) : -1;
    }
    sum = {};
    for (std::size_t k = kBoxBins - 1; k > 0; --k) {
      sum.box.add(line[k].box);
      sum.count += line[k].count;
      if (sum.count == 0 || left[k] < 0) continue;
      const double split =
          costOfStep(cost_) + (left[k] + halfArea(sum.box) * costOfLeaf(cost_, sum.count)) / area;
      if (split < least) {
        least = split;
        best = {axis, static_cast<int>(k)};
      }
    }
  }
  return best;
}

void BoxTreeBuilder::build(Tree& tree, std::uint32_t at, std::span<std::uint32_t> order, int depth) {
  Box box, middles;
  for (const std::uint32_t i : order) {
    box.add(boxes_[i]);
    const glm::vec3 middle = middleOf(boxes_[i]);
    middles.add({middle, middle});
  }
  tree.nodes[at].box = box;
  const Split split = order.size() > 1 ? bestSplit(order, box, middles) : Split{};
  if (split.axis < 0 || depth == kMostDepth) {
    Node& node = tree.nodes[at];
    node.first = static_cast<std::uint32_t>(tree.members.size());
    node.count = node.own = static_cast<std::uint32_t>(order.size());
    tree.members.insert(tree.members.end(), order.begin(), order.end());
    if (split.axis >= 0) ++tree.forcedLeaves;
    return;
  }
  const Bins bins = binsOf(middles, split.axis);
  const auto second = std::stable_partition(order.begin(), order.end(), [&](std::uint32_t i) {
    return bins.of(middleOf(boxes_[i])[split.axis]) < split.bin;
  });
  const auto count = static_cast<std::size_t>(second - order.begin());
  const std::span<std::uint32_t> left = order.first(count), right = order.subspan(count);
  const std::uint32_t child = addChildren(tree, at);
  if (order.size() < kLeastToShare) {
    build(tree, child, left, depth + 1);
    build(tree, child + 1, right, depth + 1);
    return;
  }
  Tree parts[2];
  tbb::parallel_invoke([&] { parts[0] = subtree(left, depth + 1); },
                       [&] { parts[1] = subtree(right, depth + 1); });
  graft(tree, child, std::move(parts[0]));
  graft(tree, child + 1, std::move(parts[1]));
}

}  // namespace

Tree buildBoxTree(std::span<const Box> boxes, LeafCost cost) {
  if (boxes.empty()) return {};
  std::vector<std::uint32_t> order(boxes.size());
  std::iota(order.begin(), order.end(), 0u);
  Tree tree = BoxTreeBuilder(boxes, cost).run(order);
  countNodes(tree);
  return tree;
}

// Children come after their parents.
void refitBoxTree(Tree& tree, std::span<const Box> boxes) {
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    Node& node = tree.nodes[i];
    node.box = {};
    if (node.leaf()) {
      for (std::uint32_t k = 0; k < node.own; ++k) node.box.add(boxes[tree.members[node.first + k]]);
    } else {
      node.box.add(tree.nodes[node.first].box);
      node.box.add(tree.nodes[node.first + 1].box);
    }
  }
}

}  // namespace meniscus::bvh

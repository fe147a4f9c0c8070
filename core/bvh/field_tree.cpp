#include "core/bvh/field_tree.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <span>
#include <utility>

#include "core/bvh/fitted_builder.h"
#include "core/bvh/subtree.h"

namespace meniscus::bvh {

namespace {

bool overlap(const Metaball& a, const Metaball& b) {
  const glm::vec3 v = a.center - b.center;
  const float reach = a.support + b.support;
  return glm::dot(v, v) < reach * reach;
}

// Gives the leaves of a tree that has only their own members those of others that overlap them.
class SplitFinder {
 public:
  SplitFinder(const MetaballField& field, const Tree& tree) : balls_(field.balls), tree_(tree) {}

  Tree run() const { return within(0, {}); }

 private:
  // The subtree of a node; `others`: those of outside that reach into its box, at least.
  Tree within(std::uint32_t at, std::vector<std::uint32_t> others) const;
  std::vector<std::uint32_t> reachingInto(const Box& box, std::span<const std::uint32_t> others,
                                          std::uint32_t sibling) const;
  std::pair<std::uint32_t, std::uint32_t> membersOf(std::uint32_t at) const;

  const std::vector<Metaball>& balls_;
  const Tree& tree_;
};

// All own members below a node, which lie side by side: from, to.
std::pair<std::uint32_t, std::uint32_t> SplitFinder::membersOf(std::uint32_t at) const {
  std::uint32_t left = at, right = at;
  while (!tree_.nodes[left].leaf()) left = tree_.nodes[left].first;
  while (!tree_.nodes[right].leaf()) right = tree_.nodes[right].first + 1;
  return {tree_.nodes[left].first, tree_.nodes[right].first + tree_.nodes[right].count};
}

std::vector<std::uint32_t> SplitFinder::reachingInto(const Box& box, std::span<const std::uint32_t> others,
                                                     std::uint32_t sibling) const {
  std::vector<std::uint32_t> out;
  const auto take = [&](std::uint32_t i) {
    if (reachesInto(balls_[i].center, balls_[i].support, box)) out.push_back(i);
  };
  for (const std::uint32_t i : others) take(i);
  const auto [from, to] = membersOf(sibling);
  for (std::uint32_t k = from; k < to; ++k) take(tree_.members[k]);
  return out;
}

Tree SplitFinder::within(std::uint32_t at, std::vector<std::uint32_t> others) const {
  const Node& node = tree_.nodes[at];
  Tree part;
  part.nodes = {node};
  if (node.leaf()) {
    const std::span own(tree_.members.data() + node.first, node.count);
    part.members.assign(own.begin(), own.end());
    for (const std::uint32_t i : others) {
      const bool meets =
          std::any_of(own.begin(), own.end(), [&](std::uint32_t j) { return overlap(balls_[i], balls_[j]); });
      if (meets) part.members.push_back(i);
    }
    part.nodes[0].first = 0;
    part.nodes[0].count = static_cast<std::uint32_t>(part.members.size());
    return part;
  }
  Tree children[2];
  const auto descend = [&](std::uint32_t side) {
    const std::uint32_t child = node.first + side;
    children[side] = within(child, reachingInto(tree_.nodes[child].box, others, node.first + (1 - side)));
  };
  const auto [from, to] = membersOf(at);
  if (to - from < kLeastToShare) {
    descend(0);
    descend(1);
  } else {
    tbb::parallel_invoke([&] { descend(0); }, [&] { descend(1); });
  }
  const std::uint32_t first = addChildren(part, 0);
  graft(part, first, std::move(children[0]));
  graft(part, first + 1, std::move(children[1]));
  return part;
}

FieldTree classicalTree(const MetaballField& field, const TreeSettings& settings, float slack) {
  std::vector<Box> boxes;
  boxes.reserve(field.balls.size());
  for (const Metaball& ball : field.balls) {
    const float reach = ball.support + slack / 2;
    boxes.push_back({ball.center - reach, ball.center + reach});
  }
  FieldTree tree;
  static_cast<Tree&>(tree) = buildBoxTree(boxes, settings.cost);
  if (settings.structure == Structure::split && !tree.nodes.empty()) {
    const std::size_t forced = tree.forcedLeaves;
    static_cast<Tree&>(tree) = SplitFinder(field, tree).run();
    tree.forcedLeaves = forced;
    countNodes(tree);
  }
  return tree;
}

}  // namespace

float extentOf(const MetaballField& field) {
  float extent = 0;
  for (const Metaball& ball : field.balls) {
    const glm::vec3 c = glm::abs(ball.center);
    extent = std::max(extent, std::max({c.x, c.y, c.z}) + ball.support);
  }
  return extent;
}

FieldTree buildFieldTree(const MetaballField& field, const TreeSettings& settings) {
  const float slack = kSlack * extentOf(field);
  FieldTree tree;
  if (settings.structure == Structure::fitted) {
    static_cast<Tree&>(tree) = buildFitted(field, settings, slack);
  } else {
    tree = classicalTree(field, settings, slack);
  }
  tree.settings = settings;
  tree.slack = slack;
  return tree;
}

}  // namespace meniscus::bvh

#pragma once
// Parts of a tree that threads build by themselves, and how they are put together: in an order that does not
// depend on which is done first.

#include "core/bvh/box_tree.h"

namespace meniscus::bvh {

/// A tree's node of `at`, and all below it, become `part`.
inline void graft(Tree& tree, std::uint32_t at, Tree&& part) {
  // part.nodes[0] goes to `at`, the others to the end.
  const auto nodes = static_cast<std::uint32_t>(tree.nodes.size());
  const auto members = static_cast<std::uint32_t>(tree.members.size());
  for (Node& node : part.nodes) node.first += node.leaf() ? members : nodes - 1;
  tree.nodes[at] = part.nodes.front();
  tree.nodes.insert(tree.nodes.end(), part.nodes.begin() + 1, part.nodes.end());
  tree.members.insert(tree.members.end(), part.members.begin(), part.members.end());
  tree.forcedLeaves += part.forcedLeaves;
}

/// Two children of `at` at the end of the nodes; the index of the first.
inline std::uint32_t addChildren(Tree& tree, std::uint32_t at) {
  const auto first = static_cast<std::uint32_t>(tree.nodes.size());
  tree.nodes.resize(tree.nodes.size() + 2);
  tree.nodes[at].first = first;
  tree.nodes[at].count = Node::kInner;
  return first;
}

/// Fewer members are not worth a thread.
inline constexpr std::size_t kLeastToShare = 4096;

}  // namespace meniscus::bvh

#pragma once
// A bounding volume hierarchy over boxes, each of which is in one leaf: greedy, top-down, with binned surface
// area costs. I. Wald, On fast Construction of SAH-based Bounding Volume Hierarchies, RT 2007,
// doi 10.1109/RT.2007.4342588.

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace meniscus::bvh {

struct Box {
  glm::vec3 low{1e30f}, high{-1e30f};  ///< [Å]; low > high: nothing

  bool empty() const { return !(low.x <= high.x && low.y <= high.y && low.z <= high.z); }
  void add(const Box& other);
  Box grown(float by) const { return {low - by, high + by}; }
};

/// Half the surface of a box [Å^2]; 0 of an empty one.
double halfArea(const Box& box);

/// No leaf lies deeper, so that a stack of as many nodes is enough for any walk: what cannot be split before
/// stays together, and is counted.
inline constexpr int kMostDepth = 64;

struct Node {
  static constexpr std::uint32_t kInner = 0xFFFFFFFFu;
  Box box;
  std::uint32_t first = 0;       ///< an inner node's: of its two children; a leaf's: in the tree's `members`
  std::uint32_t count = kInner;  ///< of a leaf's members
  std::uint32_t own = 0;         ///< of those, how many are in no other leaf; they come first
  bool leaf() const { return count != kInner; }
};

/// What a leaf of n members is taken to cost.
enum class LeafCost : std::uint8_t {
  linear,  ///< n
  square   ///< n^2: as many places at which as many shares are added up (Gourmel et al. 2010, §5.1.1)
};

/// In units of one ball's share at one place. Steps of the walk: measured, where leaves of n^2 are the
/// cheapest to walk for what they take to build (docs/measured/bvh.md); for leaves of n what is customary.
double costOfLeaf(LeafCost cost, std::size_t members);
constexpr double costOfStep(LeafCost cost) {
  return cost == LeafCost::square ? 16 : 2;
}

struct Tree {
  std::vector<Node> nodes;  ///< [0] is the root; none at all without members
  std::vector<std::uint32_t> members;
  std::size_t leaves = 0;
  std::size_t forcedLeaves = 0;  ///< that kMostDepth, or room for members, cut short
  int depth = 0;                 ///< of the deepest leaf; the root's is 0
};

/// Leaves, depth and what else is counted, from the nodes.
void countNodes(Tree& tree);

/// The same tree whatever the number of threads.
Tree buildBoxTree(std::span<const Box> boxes, LeafCost cost);

/// The same nodes and leaves around boxes that have moved. Leaves the boxes of a tree to which members were
/// added that are not their leaf's own (core/bvh/field_tree.h) wrong.
void refitBoxTree(Tree& tree, std::span<const Box> boxes);

}  // namespace meniscus::bvh

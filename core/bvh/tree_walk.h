#pragma once
// A ray's way through a tree, nearest nodes first.

#include <array>
#include <glm/vec3.hpp>

#include "core/bvh/box_tree.h"

namespace meniscus::bvh {

/// A ray as boxes take it; origin and direction relative to the boxes' own.
struct WalkRay {
  glm::dvec3 origin, inverse;  ///< of each component of the direction; infinite where that is 0
  WalkRay(const glm::dvec3& o, const glm::dvec3& direction) : origin(o), inverse(1.0 / direction) {}
};

/// The part of [from, to] within a box; from > to: none.
inline void clip(const WalkRay& ray, const Box& box, double& from, double& to) {
  for (int axis = 0; axis < 3; ++axis) {
    const bool forward = ray.inverse[axis] > 0;
    const double low = static_cast<double>(box.low[axis]), high = static_cast<double>(box.high[axis]);
    const double enter = ((forward ? low : high) - ray.origin[axis]) * ray.inverse[axis];
    const double leave = ((forward ? high : low) - ray.origin[axis]) * ray.inverse[axis];
    // Comparisons with NaN, of a ray within a face, change nothing.
    if (enter > from) from = enter;
    if (leave < to) to = leave;
  }
}

/// Calls visit(leaf's node, from, to), which may lower `to`, the end of what is still looked for, by
/// returning it. Counts the nodes whose boxes the ray meets.
template <class Visit>
void walk(const Tree& tree, const WalkRay& ray, double from, double to, std::uint64_t& nodes,
          const Visit& visit) {
  struct Entry {
    std::uint32_t node;
    double from, to;
  };
  std::array<Entry, kMostDepth + 2> stack;
  std::size_t top = 0;
  const auto push = [&](std::uint32_t node, double a, double b) { stack[top++] = {node, a, b}; };
  if (tree.nodes.empty()) return;
  double a = from, b = to;
  clip(ray, tree.nodes[0].box, a, b);
  if (a <= b) push(0, a, b);
  while (top > 0) {
    const Entry entry = stack[--top];
    if (entry.from > to) continue;
    ++nodes;
    const Node& node = tree.nodes[entry.node];
    if (node.leaf()) {
      to = visit(node, entry.from, entry.to < to ? entry.to : to, to);
      continue;
    }
    double nearFrom = from, nearTo = to, farFrom = from, farTo = to;
    std::uint32_t near = node.first, far = node.first + 1;
    clip(ray, tree.nodes[near].box, nearFrom, nearTo);
    clip(ray, tree.nodes[far].box, farFrom, farTo);
    if (farFrom < nearFrom) {
      std::swap(near, far);
      std::swap(nearFrom, farFrom);
      std::swap(nearTo, farTo);
    }
    if (farFrom <= farTo) push(far, farFrom, farTo);
    if (nearFrom <= nearTo) push(near, nearFrom, nearTo);
  }
}

}  // namespace meniscus::bvh

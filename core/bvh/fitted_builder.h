#pragma once
// How a fitted tree is built; what it is: core/bvh/field_tree.h.

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/bvh/field_tree.h"

namespace meniscus::bvh {

Tree buildFitted(const MetaballField& field, const TreeSettings& settings, float slack);

/// Whether a ball and a box share more than a point.
inline bool reachesInto(const glm::vec3& center, float radius, const Box& box) {
  const glm::vec3 v = glm::max(glm::max(box.low - center, center - box.high), 0.0f);
  return glm::dot(v, v) < radius * radius;
}

}  // namespace meniscus::bvh

#pragma once
// What a field is besides its few largest terms, on a grid: the ambient field of "GPU-Accelerated Ray Casting
// of Node-Based Implicit Surfaces" (SIGGRAPH 2006 poster). A method that adds the K largest terms at a point
// itself takes the rest from here.

#include <glm/vec3.hpp>
#include <vector>

#include "core/metaball_field.h"

namespace meniscus {

struct AmbientField {
  glm::vec3 base{0.0f};       ///< of node (0, 0, 0), relative to Primitives::origin [Å]
  float spacing = 1;          ///< [Å]
  glm::ivec3 size{0};         ///< nodes
  std::vector<float> values;  ///< x fastest; without the level
  /// Trilinear; outside the grid its nearest value.
  double at(const glm::dvec3& point) const;
};

/// The sum of all terms but the `terms` largest by absolute value, at the nodes of a grid over all supports
/// with `cells` cubes along its longest side. In double precision, on all processors.
AmbientField makeAmbientField(const MetaballField& field, int terms, int cells);

/// The same sum at one point.
double restOfField(const MetaballField& field, int terms, const glm::dvec3& point);

}  // namespace meniscus

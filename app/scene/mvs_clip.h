#pragma once
// MolViewSpec's clipping by whole atoms: what is cut away are the atoms whose centres are.

#include <glm/vec3.hpp>

#include "app/scene/mvs_nodes.h"

namespace meniscus {

class MvsClip {
 public:
  /// A plane cuts away the side its normal points to, a sphere or box its inside; with `invert` the other way
  /// round. Throws InputError naming the place.
  MvsClip(const MvsNode& node, std::vector<std::string>& unsupported);

  bool cuts(const glm::dvec3& point) const;

 private:
  enum class Shape { plane, sphere, box } shape_ = Shape::plane;
  glm::dvec3 center_{0.0};                                  ///< or a point of the plane
  glm::dvec3 axes_[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  ///< [0]: the plane's normal; else the box's edges
  glm::dvec3 half_{0.5};                                    ///< half the box's size; x: the sphere's radius
  bool invert_ = false;
};

}  // namespace meniscus

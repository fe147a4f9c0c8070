#pragma once
// Light from all around, as a picture: equirectangular (plate carrée). The middle of the picture lies
// straight ahead of the viewer, its right quarter to the right, its upper edge above. Between the middles of
// texels light is interpolated linearly, across the seam behind the viewer, too; directions above the first
// row's middles and below the last's have that row's light.

#include <glm/vec3.hpp>
#include <vector>

namespace meniscus {

class EnvironmentMap {
 public:
  /// texels: linear light (Rec. 709), finite and not negative, row after row from the top; width x height of
  /// them, at least one.
  EnvironmentMap(int width, int height, std::vector<glm::vec3> texels);

  int width() const { return width_; }
  int height() const { return height_; }
  /// direction: unit, in view axes: x to the right, y up, z towards the viewer.
  glm::dvec3 light(const glm::dvec3& direction) const;

 private:
  glm::dvec3 texel(int column, int row) const;

  int width_, height_;
  std::vector<glm::vec3> texels_;
};

}  // namespace meniscus

#include "core/environment_map.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "core/error.h"

namespace meniscus {

EnvironmentMap::EnvironmentMap(int width, int height, std::vector<glm::vec3> texels)
    : width_(width), height_(height), texels_(std::move(texels)) {
  MENISCUS_CHECK(width > 0 && height > 0 &&
                 texels_.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
}

// Columns go around, rows end.
glm::dvec3 EnvironmentMap::texel(int column, int row) const {
  column = (column % width_ + width_) % width_;
  row = std::clamp(row, 0, height_ - 1);
  return glm::dvec3(texels_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                            static_cast<std::size_t>(column)]);
}

glm::dvec3 EnvironmentMap::light(const glm::dvec3& direction) const {
  constexpr double kPi = 3.14159265358979323846;
  const double right = std::atan2(direction.x, -direction.z) / (2 * kPi);
  const double down = std::acos(std::clamp(direction.y, -1.0, 1.0)) / kPi;
  const double x = (right + 0.5) * width_ - 0.5, y = down * height_ - 0.5;
  const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
  const glm::dvec3 upper = glm::mix(texel(column, row), texel(column + 1, row), x - column);
  const glm::dvec3 lower = glm::mix(texel(column, row + 1), texel(column + 1, row + 1), x - column);
  return glm::mix(upper, lower, y - row);
}

}  // namespace meniscus

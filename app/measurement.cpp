#include "app/measurement.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>

#include "core/error.h"

namespace meniscus {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// By the tangent: exact to rounding near 0 and 180 degrees, too, where the cosine is not.
double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
  const double sine = glm::length(glm::cross(a, b)), cosine = glm::dot(a, b);
  return sine == 0 && cosine == 0 ? kNaN : glm::degrees(std::atan2(sine, cosine));
}

double torsion(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 first = glm::cross(a, b), second = glm::cross(b, c);
  if (glm::length(first) == 0 || glm::length(second) == 0) return kNaN;
  return glm::degrees(std::atan2(glm::length(b) * glm::dot(a, second), glm::dot(first, second)));
}

}  // namespace

double measuredValue(std::span<const glm::dvec3> p) {
  MENISCUS_CHECK(p.size() >= 2 && p.size() <= 4);
  if (p.size() == 2) return glm::length(p[1] - p[0]);
  if (p.size() == 3) return angleBetween(p[0] - p[1], p[2] - p[1]);
  return torsion(p[1] - p[0], p[2] - p[1], p[3] - p[2]);
}

std::string measureText(std::span<const glm::dvec3> points) {
  const double value = measuredValue(points);
  if (std::isnan(value)) return "no angle";
  return points.size() == 2 ? fmt::format("{:.2f} Å", value) : fmt::format("{:.1f}°", value);
}

void addMeasure(std::span<const glm::dvec3> points, Rgb color, Scene& scene) {
  for (std::size_t i = 1; i < points.size(); ++i) scene.dashes.push_back({points[i - 1], points[i], color});
  // An angle is written at its vertex, the others in the middle; the atoms of the ends do not hide it.
  const bool angle = points.size() == 3;
  const glm::dvec3& a = points[points.size() == 4 ? 1 : 0];
  const glm::dvec3& b = points[points.size() == 4 ? 2 : 1];
  scene.labels.push_back({measureText(points), angle ? b : (a + b) * 0.5, 0.5 * glm::length(b - a) + 2});
}

}  // namespace meniscus

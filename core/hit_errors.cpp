#include "core/hit_errors.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>
#include <limits>
#include <vector>

#include "core/error.h"

namespace meniscus {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Right for small angles too, where the cosine has no digits. What is no direction is as wrong as can be.
double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
  const double angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
  return std::isfinite(angle) && glm::dot(a, a) > 0 ? angle : glm::pi<double>();
}

}  // namespace

HitErrors compareHits(const HitImage& image, const ReferenceImage& truth) {
  const std::size_t pixels = truth.distance.size();
  MENISCUS_CHECK(image.size == truth.hits.size && image.distance.size() == pixels);
  HitErrors out;
  out.pixels = pixels;
  double squares = 0, angleSquares = 0;
  std::size_t relatives = 0;
  std::vector<double> distances;
  for (std::size_t i = 0; i < pixels; ++i) {
    const double t = static_cast<double>(image.distance[i]), t0 = truth.distance[i];
    const bool hit = t != kInfinity, hit0 = t0 != kInfinity;
    if (truth.grazing[i] != 0) {
      ++out.grazing;
      if (hit != hit0) ++out.grazingDisputes;
      continue;
    }
    if (hit != hit0) ++(hit ? out.falseHits : out.missed);
    if (!hit || !hit0) continue;
    ++out.compared;
    const double error = std::isfinite(t) ? std::abs(t - t0) : kInfinity;
    distances.push_back(error);
    if (t0 > 0) {
      squares += (error / t0) * (error / t0);
      ++relatives;
    }
    if (!image.normal.empty()) {
      const double angle = angleBetween(glm::dvec3(image.normal[i]), glm::dvec3(truth.hits.normal[i]));
      angleSquares += angle * angle;
      out.largestNormalDeg = std::max(out.largestNormalDeg, glm::degrees(angle));
    }
    if (!image.id.empty() && image.id[i] != truth.hits.id[i]) ++out.idsDiffer;
  }
  if (relatives > 0) out.relativeRms = std::sqrt(squares / static_cast<double>(relatives));
  if (distances.empty()) return out;
  out.normalRmsDeg = glm::degrees(std::sqrt(angleSquares / static_cast<double>(distances.size())));
  // Nearest rank: the smallest value that 99 % do not exceed.
  const std::size_t rank = (distances.size() * 99 + 99) / 100 - 1;
  std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(rank), distances.end());
  out.distanceP99 = distances[rank];
  out.largestDistance = *std::max_element(distances.begin(), distances.end());
  return out;
}

}  // namespace meniscus

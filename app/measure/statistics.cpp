#include "app/measure/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace meniscus::measure {

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 != 0 ? values[half] : (values[half - 1] + values[half]) / 2;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(share * static_cast<double>(values.size())) - 1;
  return values[static_cast<std::size_t>(std::clamp(rank, 0.0, static_cast<double>(values.size() - 1)))];
}

std::vector<bool> paretoFront(const std::vector<XY>& points) {
  std::vector<bool> front(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const XY& a = points[i];
    front[i] = std::none_of(points.begin(), points.end(), [&](const XY& b) {
      return b.x <= a.x && b.y <= a.y && (b.x < a.x || b.y < a.y);
    });
  }
  return front;
}

}  // namespace meniscus::measure

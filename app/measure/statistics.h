#pragma once
// What a series of times is summed up as.

#include <vector>

namespace meniscus::measure {

/// The middle value, or the mean of the two in the middle. NaN of nothing.
double median(std::vector<double> values);

/// The smallest value that `share` (0..1] of all do not exceed (nearest rank). NaN of nothing.
double quantile(std::vector<double> values, double share);

/// Which points (x, y) no other beats: none is smaller in one coordinate and not larger in the other. In the
/// order of the points.
struct XY {
  double x = 0, y = 0;
};
std::vector<bool> paretoFront(const std::vector<XY>& points);

}  // namespace meniscus::measure

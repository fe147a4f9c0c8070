#include "core/sampling.h"

#include <cmath>
#include <cstdint>

namespace meniscus {

namespace {

float toGrid(double offset) {
  return static_cast<float>(std::floor(offset * 256.0) / 256.0);
}

}  // namespace

double radicalInverse2(std::uint32_t i) {
  double value = 0, digit = 0.5;
  for (; i != 0; i >>= 1, digit *= 0.5) value += digit * (i & 1u);
  return value;
}

glm::vec2 sampleOffset(int index, int count) {
  if (count <= 1) return {0, 0};
  // The rank among the first `count` radical inverses instead of the value itself: every row is taken once,
  // whatever the count, and the mean stays in the centre.
  const double own = radicalInverse2(static_cast<std::uint32_t>(index));
  int rank = 0;
  for (int i = 0; i < count; ++i) rank += radicalInverse2(static_cast<std::uint32_t>(i)) < own;
  return {toGrid((index + 0.5) / count - 0.5), toGrid((rank + 0.5) / count - 0.5)};
}

}  // namespace meniscus

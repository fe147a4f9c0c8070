#include "core/sampling.h"

#include <cmath>
#include <cstdint>

namespace meniscus {

namespace {

double radicalInverse2(std::uint32_t i) {
  double value = 0, digit = 0.5;
  for (; i != 0; i >>= 1, digit *= 0.5) value += digit * (i & 1u);
  return value;
}

float toGrid(double offset) { return static_cast<float>(std::floor(offset * 256.0) / 256.0); }

}  // namespace

glm::vec2 sampleOffset(int index, int count) {
  if (count <= 1) return {0, 0};
  // The radical inverses of 0 .. count-1 lie in steps of at most 1/count; their mean is moved to the centre.
  double mean = 0;
  for (int i = 0; i < count; ++i) mean += radicalInverse2(static_cast<std::uint32_t>(i));
  mean /= count;
  const double x = (index + 0.5) / count - 0.5;
  double y = radicalInverse2(static_cast<std::uint32_t>(index)) - mean;
  if (y >= 0.5) y -= 1;
  return {toGrid(x), toGrid(y)};
}

}  // namespace meniscus

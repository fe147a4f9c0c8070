#pragma once
// A double as the sum of two floats, as shaders/shared/double_float.glsl takes it.

namespace meniscus {

inline float high(double x) {
  return static_cast<float>(x);
}
inline float low(double x) {
  return static_cast<float>(x - static_cast<double>(high(x)));
}

}  // namespace meniscus

#pragma once
// sRGB (IEC 61966-2-1).

#include <array>
#include <cmath>
#include <cstddef>

namespace meniscus {

/// Linear light, 0 to 1, of a stored value, 0 to 1.
inline double linearFromSrgb(double stored) {
  return stored <= 0.04045 ? stored / 12.92 : std::pow((stored + 0.055) / 1.055, 2.4);
}

/// The other way round.
inline double srgbFromLinear(double linear) {
  return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

/// Linear light of each value of 8 bits.
inline const std::array<double, 256>& linearOfBytes() {
  static const std::array<double, 256> table = [] {
    std::array<double, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = linearFromSrgb(static_cast<double>(i) / 255);
    return values;
  }();
  return table;
}

}  // namespace meniscus

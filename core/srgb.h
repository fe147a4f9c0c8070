#pragma once
// sRGB (IEC 61966-2-1).

#include <cmath>

namespace meniscus {

/// Linear light, 0 to 1, of a stored value, 0 to 1.
inline double linearFromSrgb(double stored) {
  return stored <= 0.04045 ? stored / 12.92 : std::pow((stored + 0.055) / 1.055, 2.4);
}

}  // namespace meniscus

#pragma once
// A field of metaballs: F(x) = sum of q_i f(1 - |x - p_i|^2 / R_i^2) - T, a surface where F = 0, inside where
// F > 0. It does not know how it is ray-cast.

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace meniscus {

/// f(w) of w = 1 - r^2/R^2, 0 outside the support; f(0) = 0, f(1) = 1, increasing.
enum class KernelShape : std::uint8_t {
  sextic,   ///< w^2 (5 + 4 w) / 9: degree six in r. Wyvill, McPheeters, Wyvill 1986, doi 10.1007/BF01900346
  quartic,  ///< w^2: Murakami and Ichihara 1987; the blob of POV-Ray
  power     ///< w^exponent: Gourmel et al. 2010, doi 10.1111/j.1467-8659.2009.01597.x
};

inline constexpr int kLeastKernelExponent = 2;
inline constexpr int kMostKernelExponent = 16;

struct Kernel {
  KernelShape shape = KernelShape::sextic;
  int exponent = 3;  ///< of KernelShape::power, kLeastKernelExponent..kMostKernelExponent
  bool operator==(const Kernel&) const = default;
};

/// f(w), 0 for w <= 0.
double kernelValue(const Kernel& kernel, double w);
/// df/dw, 0 for w <= 0.
double kernelSlope(const Kernel& kernel, double w);
/// The w in [0, 1] with f(w) = value, 0 <= value <= 1.
double kernelInverse(const Kernel& kernel, double value);
/// Degree of one ball's f along a ray: 6, 4 or twice the exponent.
int kernelDegree(const Kernel& kernel);

/// In the layout in which methods read it; lengths in Å.
struct Metaball {
  glm::vec3 center;     ///< relative to Primitives::origin
  float support;        ///< R: the ball contributes nothing farther out
  float coefficient;    ///< q, of either sign
  std::uint32_t color;  ///< 0xRRGGBB, sRGB
  std::uint32_t id;     ///< 1-based
};

struct MetaballField {
  std::vector<Metaball> balls;
  Kernel kernel;
  double level = 0.5;  ///< T > 0
  /// Whether every coefficient is positive: then what one ball alone holds inside stays inside.
  bool allPositive() const;
};

struct FieldBox {
  glm::dvec3 low, high;  ///< [Å]; low > high for a field without balls
};
/// Of all supports.
FieldBox supportBox(const MetaballField& field);

/// The level at which a ball of coefficient 1 whose support is `blend` (> 1) times a radius has that radius.
double levelOfBlend(const Kernel& kernel, double blend);

/// Radius, as a share of the support, of the core in which a ball of coefficient q alone reaches the level; 0
/// if it never does.
double coreShare(const Kernel& kernel, double level, double coefficient);

/// Throws InputError, naming `what` and the ball, if a number is not finite, a support or the level not
/// positive, an exponent out of range.
void requireValid(const MetaballField& field, const char* what);

}  // namespace meniscus

// shared/metaball.glsl on the GPU against the same text as C++ in float32 and in double, and its Bernstein
// forms against the kernels they stand for. The tolerances are derived in shared_math_cells.h.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/metaball_field.h"
#include "tests/gpu/shared_math_cells.h"
#include "tests/support/gl_fixture.h"

namespace meniscus {
namespace {

using namespace test;

class SharedMetaball : public test::GlTest {};

TEST_F(SharedMetaball, Kernels) {
  const Generator w = [](Random& random, std::size_t i) {
    const double edges[] = {0, 1, 1e-6, 1 - 1e-6};
    return Inputs{static_cast<float>(i < 4 ? edges[i] : random.uniform(0, 1)),
                  static_cast<float>(kLeastKernelExponent + random.index(15))};
  };
  const Shape shape{.groups = {{0, 1}}, .exact = [](std::size_t input) { return input == 1; }};
  expectConditioned(MENISCUS_SHARED_CALL(callSexticKernel), 70, w, shape);
  expectConditioned(MENISCUS_SHARED_CALL(callSexticSlope), 71, w, shape);
  expectConditioned(MENISCUS_SHARED_CALL(callQuarticKernel), 72, w, shape);
  expectConditioned(MENISCUS_SHARED_CALL(callQuarticSlope), 73, w, shape);
  expectConditioned(MENISCUS_SHARED_CALL(callPowerKernel), 74, w, shape);
  expectConditioned(MENISCUS_SHARED_CALL(callPowerSlope), 75, w, shape);
}

// A chord of a ball and an interval on it, now and then the whole chord or one without length.
Inputs intervalOnChord(Random& random, std::size_t i) {
  const double support = random.logUniform(1e-3, 1e3), middle = support * random.uniform(-20, 20);
  const double closest = support * (i % 5 == 0 ? 1 - random.logUniform(1e-6, 1e-2) : random.uniform(0, 1));
  const double half = std::sqrt(support * support - closest * closest);
  double a = random.uniform(-half, half), b = random.uniform(-half, half);
  if (a > b) std::swap(a, b);
  if (i % 7 == 0) a = -half;
  if (i % 11 == 0) b = half;
  if (i % 13 == 0) b = a;
  return {static_cast<float>(middle), static_cast<float>(half * half),
          static_cast<float>(1 / (support * support)), static_cast<float>(middle + a),
          static_cast<float>(middle + b)};
}

// What cancels at the ends of a chord is h^2 - (t - m)^2: roundings are relative to the chord's own peak.
double peak(const f64::Cell& c) {
  return c.in_[1] * c.in_[2];
}

TEST_F(SharedMetaball, Pieces) {
  Shape shape{.groups = {{0, 3}}, .size = peak};
  expectConditioned(MENISCUS_SHARED_CALL(callWindowOn), 76, intervalOnChord, shape);
  shape.groups = {{0, 5}};
  shape.size = [](const f64::Cell& c) { return peak(c) * peak(c); };
  expectConditioned(MENISCUS_SHARED_CALL(callQuarticPiece), 77, intervalOnChord, shape);
  shape.groups = {{0, 7}};
  expectConditioned(MENISCUS_SHARED_CALL(callSexticPiece), 78, intervalOnChord, shape);
  const Generator power = [](Random& random, std::size_t i) {
    Inputs out = intervalOnChord(random, i);
    out.push_back(static_cast<float>(kLeastKernelExponent + random.index(15)));
    out.push_back(static_cast<float>(16 * random.index(3)));
    return out;
  };
  shape.groups = {{0, 16}};
  shape.exact = [](std::size_t input) { return input == 5 || input == 6; };
  // Three roundings for each of alpha products.
  shape.size = [](const f64::Cell& c) { return std::pow(peak(c), c.in_[5]) * 6; };
  expectConditioned(MENISCUS_SHARED_CALL(callPowerPiece), 79, power, shape);
}

// The Bernstein form, evaluated by de Casteljau's rule, is the kernel of w along the ray.
template <std::size_t N>
double bernsteinValue(const double (&coefficients)[N], std::size_t degree, double u) {
  double c[N];
  std::copy(std::begin(coefficients), std::end(coefficients), c);
  for (std::size_t n = degree; n > 0; --n)
    for (std::size_t k = 0; k < n; ++k) c[k] += (c[k + 1] - c[k]) * u;
  return c[0];
}

TEST(MetaballPieces, AreTheKernelAlongTheRay) {
  Random random(80);
  for (std::size_t i = 0; i < 20000; ++i) {
    const Inputs in = intervalOnChord(random, i);
    const double middle = in[0], half2 = in[1], inverse = in[2], t0 = in[3], t1 = in[4];
    const f64::Window window = f64::windowOn(middle, half2, inverse, t0, t1);
    const double u = random.uniform(0, 1), t = t0 + (t1 - t0) * u;
    const double w = (half2 - (t - middle) * (t - middle)) * inverse;
    // The inputs are float32: an end may lie outside the chord by their rounding, where windowOn() cuts off.
    const double slack = 1e-4 * (1 + half2 * inverse);
    EXPECT_NEAR(bernsteinValue(f64::quarticPiece(window).c, 4, u), kernelValue({KernelShape::quartic}, w),
                slack);
    EXPECT_NEAR(bernsteinValue(f64::sexticPiece(window).c, 6, u), kernelValue({KernelShape::sextic}, w),
                slack);
    const int alpha = kLeastKernelExponent + static_cast<int>(random.index(15));
    EXPECT_NEAR(bernsteinValue(f64::powerPiece(window, alpha).c, 2 * static_cast<std::size_t>(alpha), u),
                kernelValue({KernelShape::power, alpha}, w), slack);
  }
}

// The paper's coefficients on the whole chord, with a = h^2 / R^2 (Kanamori et al. 2008, Appendix A).
TEST(MetaballPieces, OnTheWholeChordAreThePapers) {
  for (const double a : {0.01, 0.3, 0.75, 1.0}) {
    const f64::Window window = f64::windowOn(0, a, 1, -std::sqrt(a), std::sqrt(a));
    const f64::QuarticPiece quartic = f64::quarticPiece(window);
    const f64::SexticPiece sextic = f64::sexticPiece(window);
    const double expectedQuartic[] = {0, 0, 8.0 / 3 * a * a, 0, 0};
    const double expectedSextic[] = {0, 0, 16.0 / 27 * a * a, 8 * (8 * a + 5) * a * a / 45, 16.0 / 27 * a * a,
                                     0, 0};
    for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(quartic.c[k], expectedQuartic[k], 1e-14) << a << " " << k;
    for (std::size_t k = 0; k < 7; ++k) EXPECT_NEAR(sextic.c[k], expectedSextic[k], 1e-14) << a << " " << k;
  }
}

}  // namespace
}  // namespace meniscus

// Kernels, levels and cores against closed forms, and fields that are refused.

#include "core/metaball_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/error.h"
#include "tests/support/kernels.h"

namespace meniscus {
namespace {

using test::kKernels;

TEST(Kernel, GoesFromZeroToOne) {
  for (const Kernel& kernel : kKernels) {
    EXPECT_EQ(kernelValue(kernel, 0), 0);
    EXPECT_EQ(kernelValue(kernel, -0.5), 0);
    EXPECT_DOUBLE_EQ(kernelValue(kernel, 1), 1);
    EXPECT_EQ(kernelSlope(kernel, -0.5), 0);
    for (double w = 0.05; w < 1; w += 0.05) {
      EXPECT_GT(kernelValue(kernel, w), kernelValue(kernel, w - 0.05));
      const double h = 1e-6;
      EXPECT_NEAR(kernelSlope(kernel, w), (kernelValue(kernel, w + h) - kernelValue(kernel, w - h)) / (2 * h),
                  1e-8);
    }
  }
}

TEST(Kernel, InverseInverts) {
  for (const Kernel& kernel : kKernels) {
    EXPECT_EQ(kernelInverse(kernel, 0), 0);
    EXPECT_DOUBLE_EQ(kernelInverse(kernel, 1), 1);
    for (double v = 1e-12; v < 1; v *= 3)
      EXPECT_NEAR(kernelValue(kernel, kernelInverse(kernel, v)), v, 4e-16 + 1e-13 * v) << v;
  }
}

// A single ball's radius as a share of its support, from the literature's tables.
TEST(Kernel, CoreOfALoneBall) {
  EXPECT_NEAR(coreShare({KernelShape::sextic}, 0.5, 1), 0.5, 1e-14);
  EXPECT_NEAR(coreShare({KernelShape::sextic}, 0.25, 1), 0.665, 1e-4);
  EXPECT_NEAR(coreShare({KernelShape::quartic}, 0.5, 1), std::sqrt(1 - std::sqrt(0.5)), 1e-14);
  EXPECT_NEAR(coreShare({KernelShape::power, 4}, 0.3, 1), std::sqrt(1 - std::pow(0.3, 0.25)), 1e-14);
  EXPECT_NEAR(coreShare({KernelShape::sextic}, 1.0, 2), 0.5, 1e-14);  // coefficient and level scale together
  EXPECT_EQ(coreShare({KernelShape::sextic}, 0.5, 0.4), 0);           // never reached
  EXPECT_EQ(coreShare({KernelShape::sextic}, 0.5, -1), 0);
  EXPECT_EQ(coreShare({KernelShape::sextic}, 1, 1), 0);
}

TEST(Kernel, BlendShowsTheRadius) {
  for (const Kernel& kernel : kKernels)
    for (const double blend : {1.05, 1.5, 2.0, 3.0})
      EXPECT_NEAR(coreShare(kernel, levelOfBlend(kernel, blend), 1) * blend, 1, 1e-12) << blend;
  EXPECT_DOUBLE_EQ(levelOfBlend({KernelShape::sextic}, 2), 0.5);
}

MetaballField oneBall() {
  MetaballField field;
  field.balls.push_back({{1, 2, 3}, 3.4f, 1, 0xFF0000, 7});
  return field;
}

TEST(MetaballField, ValidOnesAreTaken) {
  EXPECT_NO_THROW(requireValid(oneBall(), "x.pdb"));
  MetaballField field = oneBall();
  field.balls.push_back({{1, 2, 3}, 1e-3f, -2, 0, 8});
  EXPECT_NO_THROW(requireValid(field, "x.pdb"));
  EXPECT_FALSE(field.allPositive());
  EXPECT_TRUE(oneBall().allPositive());
}

TEST(MetaballField, WhatIsNoNumberIsRefusedByName) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  const auto expectRefused = [](const MetaballField& field, const char* part) {
    try {
      requireValid(field, "x.pdb");
      ADD_FAILURE() << "taken: " << part;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("x.pdb: "), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  for (const float bad : {nan, infinity, -infinity}) {
    for (int k = 0; k < 3; ++k) {
      MetaballField field = oneBall();
      field.balls[0].center[k] = bad;
      expectRefused(field, "atom 7");
    }
    MetaballField field = oneBall();
    field.balls[0].support = bad;
    expectRefused(field, "atom 7");
    field = oneBall();
    field.balls[0].coefficient = bad;
    expectRefused(field, "atom 7");
    field = oneBall();
    field.level = static_cast<double>(bad);
    expectRefused(field, "level");
  }
  MetaballField field = oneBall();
  field.balls[0].support = 0;
  expectRefused(field, "support of 0");
  field = oneBall();
  field.level = 0;
  expectRefused(field, "level 0");
  field = oneBall();
  field.kernel = {KernelShape::power, 17};
  expectRefused(field, "exponent 17");
}

}  // namespace
}  // namespace meniscus

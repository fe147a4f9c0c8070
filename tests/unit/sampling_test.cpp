// Sample positions within a pixel.

#include "core/sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/render_settings.h"

namespace meniscus {
namespace {

constexpr double kGrid = 256.0;

TEST(Sampling, OneSampleIsTheCentre) {
  EXPECT_EQ(sampleOffset(0, 1), glm::vec2(0));
  EXPECT_EQ(sampleOffset(0, 0), glm::vec2(0));
}

TEST(Sampling, EveryCountUsesDifferentColumnsAndRows) {
  for (int count = 2; count <= kMaxSamples; ++count) {
    std::set<float> columns, rows;
    for (int i = 0; i < count; ++i) {
      const glm::vec2 offset = sampleOffset(i, count);
      EXPECT_TRUE(columns.insert(offset.x).second) << "sample " << i << " of " << count;
      EXPECT_TRUE(rows.insert(offset.y).second) << "sample " << i << " of " << count;
    }
  }
}

TEST(Sampling, EveryOffsetLiesInThePixelOnTheGrid) {
  for (int count = 2; count <= kMaxSamples; ++count) {
    for (int i = 0; i < count; ++i) {
      const glm::vec2 offset = sampleOffset(i, count);
      for (const float value : {offset.x, offset.y}) {
        EXPECT_GE(value, -0.5f);
        EXPECT_LT(value, 0.5f);
        const double steps = static_cast<double>(value) * kGrid;
        EXPECT_EQ(steps, std::round(steps)) << "added to 65,535 it would be rounded";
      }
    }
  }
}

// Rounding down to the grid moves the mean by at most one step; nothing else may.
TEST(Sampling, MeanIsTheCentre) {
  for (int count = 2; count <= kMaxSamples; ++count) {
    glm::dvec2 mean(0.0);
    for (int i = 0; i < count; ++i) mean += glm::dvec2(sampleOffset(i, count)) / static_cast<double>(count);
    EXPECT_LE(std::abs(mean.x), 1 / kGrid) << count;
    EXPECT_LE(std::abs(mean.y), 1 / kGrid) << count;
  }
}

// Each of `count` equal columns holds one sample (up to the grid), which is what smooths a nearly vertical
// edge.
TEST(Sampling, ColumnsAreStratified) {
  for (const int count : {2, 3, 4, 7, 16, 64, 256}) {
    for (int i = 0; i < count; ++i) {
      const double middle = (i + 0.5) / count - 0.5;
      EXPECT_NEAR(static_cast<double>(sampleOffset(i, count).x), middle, 1 / kGrid) << i << " of " << count;
    }
  }
}

// For powers of two every row band of height 1/count holds one sample, too.
TEST(Sampling, RowsAreStratifiedForPowersOfTwo) {
  for (const int count : {2, 4, 8, 16, 32, 64, 128, 256}) {
    std::set<int> bands;
    double lowest = 1;
    for (int i = 0; i < count; ++i) lowest = std::min(lowest, static_cast<double>(sampleOffset(i, count).y));
    for (int i = 0; i < count; ++i) {
      const double above = static_cast<double>(sampleOffset(i, count).y) - lowest;
      bands.insert(static_cast<int>(std::lround(above * count)));
    }
    EXPECT_EQ(bands.size(), static_cast<std::size_t>(count));
  }
}

}  // namespace
}  // namespace meniscus

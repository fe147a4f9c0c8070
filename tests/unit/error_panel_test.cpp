#include "app/error_panel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace meniscus {
namespace {

constexpr float kMiss = std::numeric_limits<float>::infinity();

HitImage hits(ImageSize size, std::vector<float> distance) {
  HitImage image;
  image.size = size;
  image.distance = std::move(distance);
  return image;
}

Rgb colorAt(const std::vector<std::byte>& pixels, std::size_t i) {
  return std::to_integer<Rgb>(pixels[4 * i]) << 16 | std::to_integer<Rgb>(pixels[4 * i + 1]) << 8 |
         std::to_integer<Rgb>(pixels[4 * i + 2]);
}

double luminance(Rgb color) {
  return 0.2126 * (color >> 16 & 255u) + 0.7152 * (color >> 8 & 255u) + 0.0722 * (color & 255u);
}

TEST(ErrorColor, GrowsBrighterWithTheLogarithm) {
  EXPECT_EQ(errorColor(0), errorColor(kLeastError));
  EXPECT_EQ(errorColor(1e9), errorColor(kMostError));
  EXPECT_EQ(errorColor(std::numeric_limits<double>::quiet_NaN()), errorColor(0));
  double before = luminance(errorColor(0));
  for (double at = 0.05; at < 1.001; at += 0.05) {
    const double now = luminance(errorColor(kLeastError * std::pow(kMostError / kLeastError, at)));
    EXPECT_GT(now, before);
    before = now;
  }
  EXPECT_EQ(errorColor(std::sqrt(kLeastError * kMostError)), 0x21918Cu) << "the middle of the scale";
}

// Rows of hits begin at the bottom, those of pictures at the top.
TEST(DrawErrors, CountsAndColorsEveryPixel) {
  const HitImage truth = hits({2, 3}, {10, 20, kMiss, kMiss, 30, 40});
  const HitImage picture = hits({2, 3}, {10, 20.5f, kMiss, 7, kMiss, 40});
  const ErrorPicture made = drawErrors(picture, truth, {0x123456, false});
  EXPECT_EQ(made.missed, 1u);
  EXPECT_EQ(made.falseHits, 1u);
  EXPECT_EQ(made.largest, 0.5);
  EXPECT_EQ(made.distanceP99, 0);  // of three distances
  EXPECT_EQ(made.summary(), (std::vector<std::string>{"largest 0.5 Å", "99 % at most 0 Å", "pixels missed: 1",
                                                      "pixels too many: 1"}));
  ASSERT_EQ(made.pixels.size(), 24u);
  EXPECT_EQ(colorAt(made.pixels, 0), kMissedColor);
  EXPECT_EQ(colorAt(made.pixels, 1), errorColor(0));
  EXPECT_EQ(colorAt(made.pixels, 2), 0x123456u);
  EXPECT_EQ(colorAt(made.pixels, 3), kFalseColor);
  EXPECT_EQ(colorAt(made.pixels, 4), errorColor(0));
  EXPECT_EQ(colorAt(made.pixels, 5), errorColor(0.5));
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(made.pixels[4 * i + 3], std::byte{0xFF});

  const ErrorPicture open = drawErrors(picture, truth, {0x123456, true});
  EXPECT_EQ(open.pixels[4 * 2 + 3], std::byte{0});
  EXPECT_EQ(open.pixels[4 * 3 + 3], std::byte{0xFF});
}

TEST(DrawErrors, KnowsEmptyPictures) {
  const HitImage nothing = hits({2, 1}, {kMiss, kMiss});
  const ErrorPicture made = drawErrors(nothing, nothing, {});
  EXPECT_EQ(made.largest, 0);
  EXPECT_EQ(made.missed + made.falseHits, 0u);
}

TEST(DrawErrorScale, RunsFromOneEndToTheOther) {
  const std::vector<std::byte> scale = drawErrorScale(101, 3);
  ASSERT_EQ(scale.size(), 4u * 303);
  for (std::size_t row = 0; row < 3; ++row) {
    EXPECT_EQ(colorAt(scale, 101 * row), errorColor(kLeastError));
    EXPECT_EQ(colorAt(scale, 101 * row + 100), errorColor(kMostError));
  }
  EXPECT_EQ(drawErrorScale(1, 1).size(), 4u);
}

}  // namespace
}  // namespace meniscus

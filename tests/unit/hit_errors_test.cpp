// Errors of pictures whose errors are known.

#include "core/hit_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace meniscus {
namespace {

constexpr float kMiss = std::numeric_limits<float>::infinity();

// `count` pixels in a row, all hit at 10 Å, facing the viewer, of atom 1.
ReferenceImage truthOf(int count) {
  const auto n = static_cast<std::size_t>(count);
  ReferenceImage truth;
  truth.hits = {{count, 1},
                std::vector<float>(n, 10.0f),
                std::vector<glm::vec3>(n, {0, 0, 1}),
                std::vector<std::uint32_t>(n, 1)};
  truth.distance.assign(n, 10.0);
  truth.pieces.assign(n, 1);
  truth.grazing.assign(n, 0);
  return truth;
}

void miss(HitImage& image, std::size_t at) {
  image.distance[at] = kMiss;
  image.normal[at] = glm::vec3(0);
  image.id[at] = 0;
}

TEST(HitErrors, OfTheTruthAreNone) {
  const ReferenceImage truth = truthOf(100);
  const HitErrors errors = compareHits(truth.hits, truth);
  EXPECT_EQ(errors.pixels, 100u);
  EXPECT_EQ(errors.compared, 100u);
  EXPECT_EQ(errors.missed + errors.falseHits + errors.grazing + errors.grazingDisputes + errors.idsDiffer,
            0u);
  EXPECT_EQ(errors.relativeRms + errors.distanceP99 + errors.largestDistance, 0);
  EXPECT_EQ(errors.normalRmsDeg + errors.largestNormalDeg, 0);
}

TEST(HitErrors, GrazingPixelsCountApart) {
  ReferenceImage truth = truthOf(100);
  HitImage image = truth.hits;
  miss(image, 0);  // missed
  miss(image, 1);
  for (const std::size_t at : {2u, 3u, 4u}) {  // false
    miss(truth.hits, at);
    truth.distance[at] = std::numeric_limits<double>::infinity();
  }
  for (const std::size_t at : {4u, 5u, 6u}) truth.grazing[at] = 1;
  miss(image, 5);
  image.distance[6] = 99;  // both hit: no dispute, and not compared
  const HitErrors errors = compareHits(image, truth);
  EXPECT_EQ(errors.missed, 2u);
  EXPECT_EQ(errors.falseHits, 2u);
  EXPECT_EQ(errors.grazing, 3u);
  EXPECT_EQ(errors.grazingDisputes, 2u);
  EXPECT_EQ(errors.compared, 93u);
  EXPECT_EQ(errors.largestDistance, 0);
}

TEST(HitErrors, OfDistances) {
  const ReferenceImage truth = truthOf(200);
  HitImage image = truth.hits;
  image.distance[0] = 14;
  image.distance[1] = 7;
  image.distance[2] = 11;
  image.distance[3] = 10.5f;
  const HitErrors errors = compareHits(image, truth);
  EXPECT_DOUBLE_EQ(errors.relativeRms, std::sqrt((0.16 + 0.09 + 0.01 + 0.0025) / 200));
  EXPECT_EQ(errors.largestDistance, 4);
  EXPECT_EQ(errors.distanceP99, 1);  // two of 200 exceed it
}

// The image's float is compared with the truth's double, not with another rounding.
TEST(HitErrors, SeeTheRoundingOfTheImage) {
  ReferenceImage truth = truthOf(1);
  truth.distance[0] = 10 + 1e-7;
  EXPECT_NEAR(compareHits(truth.hits, truth).largestDistance, 1e-7, 1e-14);
}

TEST(HitErrors, OfNormalsAndIds) {
  const ReferenceImage truth = truthOf(4);
  HitImage image = truth.hits;
  const double small = 1e-4, right = 3.14159265358979 / 2;
  image.normal[0] = glm::vec3(std::sin(small), 0, std::cos(small));
  image.normal[1] = glm::vec3(1, 0, 0);
  image.id[2] = 7;
  HitErrors errors = compareHits(image, truth);
  EXPECT_NEAR(errors.largestNormalDeg, 90, 1e-6);
  EXPECT_NEAR(errors.normalRmsDeg, std::sqrt((small * small + right * right) / 4) * 180 / 3.14159265358979,
              1e-6);
  EXPECT_EQ(errors.idsDiffer, 1u);
  image.normal.clear();
  image.id.clear();
  errors = compareHits(image, truth);
  EXPECT_EQ(errors.largestNormalDeg + errors.normalRmsDeg, 0);
  EXPECT_EQ(errors.idsDiffer, 0u);
}

TEST(HitErrors, WhatIsNoNumberIsNotOverlooked) {
  const ReferenceImage truth = truthOf(3);
  HitImage image = truth.hits;
  image.distance[1] = std::numeric_limits<float>::quiet_NaN();
  image.normal[2] = glm::vec3(std::numeric_limits<float>::quiet_NaN());
  const HitErrors errors = compareHits(image, truth);
  EXPECT_EQ(errors.largestDistance, std::numeric_limits<double>::infinity());
  EXPECT_NEAR(errors.largestNormalDeg, 180, 1e-9);
}

}  // namespace
}  // namespace meniscus

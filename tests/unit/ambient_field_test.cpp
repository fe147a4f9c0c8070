// Which balls reach into each other, and what a field is besides its largest terms, against plain loops.

#include "core/ambient_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/ball_overlaps.h"
#include "core/error.h"
#include "core/generated_scenes.h"
#include "tests/support/exact_field.h"

namespace meniscus {
namespace {

void expectAllPairs(const MetaballField& field) {
  const BallOverlaps overlaps = findOverlaps(field, std::size_t{1} << 26, "test");
  const std::size_t count = field.balls.size();
  ASSERT_EQ(overlaps.order.size(), count);
  const auto ball = [&](std::size_t rank) -> const Metaball& { return field.balls[overlaps.order[rank]]; };
  std::set<std::uint32_t> seen(overlaps.order.begin(), overlaps.order.end());
  EXPECT_EQ(seen.size(), count);
  for (std::uint32_t rank = 0; rank < count; ++rank) {
    EXPECT_LE(ball(rank > 0 ? rank - 1 : 0).support, ball(rank).support);
    std::vector<std::uint32_t> expected;
    for (std::uint32_t other = 0; other < count; ++other) {
      const double reach = static_cast<double>(ball(rank).support) + static_cast<double>(ball(other).support);
      const double apart = glm::length(glm::dvec3(ball(rank).center) - glm::dvec3(ball(other).center));
      if (other != rank && apart < reach) expected.push_back(other);
    }
    const auto found = overlaps.of(rank);
    ASSERT_EQ(std::vector<std::uint32_t>(found.begin(), found.end()), expected) << rank;
    ASSERT_EQ(overlaps.smaller[rank],
              std::lower_bound(expected.begin(), expected.end(), rank) - expected.begin());
  }
}

TEST(BallOverlaps, FindsEveryPair) {
  expectAllPairs(packedBalls(700, 3)->surfaces.front());
  expectAllPairs(test::randomField({}, 0.3, 200, 20, 3, 4));
  MetaballField field;  // supports from 1e-3 to 1e3, on either side of the origin
  test::Random random(5);
  for (unsigned i = 1; i <= 400; ++i) {
    const double support = random.logUniform(1e-3, 1e3);
    field.balls.push_back({glm::vec3(random.direction() * support * random.uniform(0.1, 2)),
                           static_cast<float>(support), 1, 0, i});
  }
  expectAllPairs(field);
  field.balls.assign(50, {{1, 2, 3}, 2, 1, 0, 1});
  expectAllPairs(field);
  field.balls.clear();
  expectAllPairs(field);
}

TEST(BallOverlaps, RefusesListsThatAreTooLong) {
  MetaballField field;
  field.balls.assign(100, {{1, 2, 3}, 2, 1, 0, 1});
  try {
    findOverlaps(field, 1000, "--surface-method newton");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("--surface-method newton: balls overlap more than 500 times"),
              std::string::npos);
  }
}

TEST(AmbientField, IsTheSumOfAllButTheLargestAtItsNodes) {
  const MetaballField field = test::randomField({}, 0.3, 60, 4, 4, 6);
  for (const int terms : {0, 1, 3, 100}) {
    const AmbientField grid = makeAmbientField(field, terms, 12);
    EXPECT_EQ(*std::max_element(&grid.size.x, &grid.size.x + 3), 13);
    test::Random random(7);
    double most = 0;
    for (int i = 0; i < 200; ++i) {
      const glm::ivec3 node(random.index(static_cast<std::size_t>(grid.size.x)),
                            random.index(static_cast<std::size_t>(grid.size.y)),
                            random.index(static_cast<std::size_t>(grid.size.z)));
      const glm::dvec3 at = glm::dvec3(grid.base) + static_cast<double>(grid.spacing) * glm::dvec3(node);
      // By sorting, term by term.
      std::vector<test::Real> values;
      for (const Metaball& ball : field.balls) {
        const glm::dvec3 v = at - glm::dvec3(ball.center);
        const test::Real r = static_cast<test::Real>(ball.support);
        values.push_back(
            static_cast<test::Real>(ball.coefficient) *
            test::exactKernel(field.kernel, 1 - static_cast<test::Real>(glm::dot(v, v)) / (r * r)));
      }
      std::sort(values.begin(), values.end(),
                [](test::Real a, test::Real b) { return std::abs(a) > std::abs(b); });
      test::Real sum = 0;
      for (std::size_t k = static_cast<std::size_t>(terms); k < values.size(); ++k) sum += values[k];
      EXPECT_NEAR(grid.at(at), static_cast<double>(sum), 2e-6);
      EXPECT_NEAR(restOfField(field, terms, at), static_cast<double>(sum), 1e-12);
      most = std::max(most, std::abs(static_cast<double>(sum)));
    }
    EXPECT_EQ(most > 0, terms < 60);
  }
}

TEST(AmbientField, ErrorFallsWithTheResolution) {
  const MetaballField field = packedBalls(200, 2)->surfaces.front();
  double before = 1e9;
  for (const int cells : {8, 32, 128}) {
    const AmbientField grid = makeAmbientField(field, 2, cells);
    test::Random random(9);
    double squares = 0;
    for (int i = 0; i < 500; ++i) {
      const glm::dvec3 at = random.inBox(6);
      const double error = grid.at(at) - restOfField(field, 2, at);
      squares += error * error;
    }
    EXPECT_LT(squares, before / 4);
    before = squares;
  }
}

}  // namespace
}  // namespace meniscus

#include "app/measurement.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "core/primitives.h"
#include "tests/support/random.h"

namespace meniscus {
namespace {

TEST(Measure, KnownValues) {
  const glm::dvec3 o(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  EXPECT_DOUBLE_EQ(measuredValue(std::array{x, y}), std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(measuredValue(std::array{x, o, y}), 90);
  EXPECT_DOUBLE_EQ(measuredValue(std::array{x, o, x}), 0);
  EXPECT_DOUBLE_EQ(measuredValue(std::array{x, o, -x}), 180);
  // Seen along the axis from o to z, from x to y is counter-clockwise for one who looks at +z coming, that is
  // clockwise for one who looks along it.
  EXPECT_DOUBLE_EQ(measuredValue(std::array{x, o, z, z + y}), 90);
  EXPECT_DOUBLE_EQ(measuredValue(std::array{x, o, z, z - y}), -90);
  EXPECT_DOUBLE_EQ(std::abs(measuredValue(std::array{x, o, z, z - x})), 180);
  EXPECT_TRUE(std::isnan(measuredValue(std::array{o, o, x})));
  EXPECT_TRUE(std::isnan(measuredValue(std::array{o, z, z + z, x})));
  EXPECT_EQ(measureText(std::array{x, y}), "1.41 Å");
  EXPECT_EQ(measureText(std::array{x, o, y}), "90.0°");
  EXPECT_EQ(measureText(std::array{o, o, x}), "no angle");
}

TEST(Measure, StaysWhenAllIsMovedAndTorsionsTurnInAMirror) {
  test::Random random(7);
  const auto point = [&] {
    return glm::dvec3(random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5));
  };
  for (int i = 0; i < 200; ++i) {
    std::array<glm::dvec3, 4> points{point(), point(), point(), point()};
    const glm::dquat turn = glm::normalize(glm::dquat(random.uniform(0.1, 1), point()));
    const glm::dvec3 shift = point();
    std::array<glm::dvec3, 4> moved, mirrored;
    for (std::size_t k = 0; k < 4; ++k) {
      moved[k] = turn * points[k] + shift;
      mirrored[k] = points[k] * glm::dvec3(1, 1, -1);
    }
    for (std::size_t n = 2; n <= 4; ++n)
      EXPECT_NEAR(measuredValue(std::span(moved).first(n)), measuredValue(std::span(points).first(n)), 1e-8);
    EXPECT_NEAR(measuredValue(mirrored), -measuredValue(points), 1e-9);
  }
}

TEST(AddMeasure, DrawsDashesWithIdsOfTheirOwn) {
  Scene scene;
  const std::array points{glm::dvec3(0, 0, 0), glm::dvec3(3, 0, 0), glm::dvec3(3, 4, 0)};
  addMeasure(points, 0x112233, scene);
  ASSERT_EQ(scene.labels.size(), 1u);
  EXPECT_EQ(scene.labels.front().text, "90.0°");
  EXPECT_EQ(countIds(scene), 2u);
  const Primitives primitives = buildPrimitives(scene, LineGroups::residues);
  double drawn = 0;
  for (const CylinderPrimitive& c : primitives.cylinders) {
    EXPECT_TRUE(c.idA == 1 || c.idA == 2);
    EXPECT_EQ(c.colorA, 0x112233u);
    drawn += static_cast<double>(glm::length(c.b - c.a));
  }
  EXPECT_GT(drawn, 0.5 * 7);
  EXPECT_LT(drawn, 0.7 * 7);
  EXPECT_EQ(primitives.groups.size(), 3u);
  EXPECT_FALSE(atomOfId(scene, 1));
}

}  // namespace
}  // namespace meniscus

// shaders/shared/ in float32 against long double: rays against spheres and cylinders, from 1e-2 to 1e5 Å
// away.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "core/shared_math.h"
#include "render/view_block.h"
#include "tests/stability/extremes.h"
#include "tests/support/exact_rays.h"
#include "tests/support/random.h"

namespace meniscus {
namespace {

using test::ExactRay;
using test::kEpsilon;
using test::kOrigin;
using test::Random;
using test::Real;
using test::Vec3;

// A picture in which something of size `radius` at `distance` from the eye covers 1 to 300 pixels, away from
// its middle.
struct PlacedView {
  View view;
  glm::vec3 center;  // relative to kOrigin
};

PlacedView placeView(Random& random, double radius, double distance, Projection projection) {
  PlacedView s;
  View& v = s.view;
  v.projection = projection;
  v.size = {2048, 1536};
  v.center = {1024, 768};
  v.rotation = glm::mat3_cast(random.rotation());
  const double pixelsAcross = random.logUniform(1, 300);
  v.pixelSize = radius / pixelsAcross / (projection == Projection::perspective ? distance : 1.0);
  const double halfWidth = 1024 * v.pixelSize;
  const double slope = std::min(halfWidth, projection == Projection::perspective ? 0.7 : halfWidth);
  const glm::dvec2 aside(random.uniform(-slope, slope), random.uniform(-0.7 * slope, 0.7 * slope));
  // The pivot lies on the optical axis, up to some radii from the depth of the sphere.
  const double pivotDepth = distance * random.uniform(0.7, 1.3);
  v.distance = pivotDepth;
  const glm::dvec3 centerView = projection == Projection::perspective
                                    ? glm::dvec3(aside * distance, pivotDepth - distance)
                                    : glm::dvec3(aside, pivotDepth - distance);
  s.center = glm::vec3(random.direction() * random.uniform(0, 200));
  v.pivot = kOrigin + glm::dvec3(s.center) - glm::transpose(v.rotation) * centerView;
  v.nearZ = projection == Projection::perspective ? v.distance : centerView.z + 3 * radius;
  v.farZ = centerView.z - 3 * radius;
  return s;
}

struct FloatHit {
  bool hit = false;
  float distance = 0;
  glm::vec3 normal{0};
  glm::vec3 point{0};  // relative to the centre
};

// What the fragment shader does.
struct FloatRay {
  f32::ViewBlock block;
  f32::ProjectedCenter center;
  f32::Split range;
  glm::vec3 direction, point;

  FloatRay(const View& view, glm::vec3 cHi, glm::vec3 cLo, float reach, glm::vec2 pixel) {
    block = makeViewBlock(view, kOrigin, {0, 0, 2048, 1536}, {0, 0});
    center = f32::projectCenter(block, cHi, cLo);
    range = f32::centerRange(block, cHi, cLo);
    direction = f32::rayDirection(block, pixel);
    point = f32::rayPoint(block, pixel, {center.pixelX.hi, center.pixelY.hi},
                          {center.pixelX.lo, center.pixelY.lo}, center.view, center.depth,
                          f32::nearEye(block, center.depth, reach));
  }
  FloatHit visible(const f32::Chord& chord) const {
    if (!chord.hit) return {};
    const bool inside = center.view.z + chord.entry.z > block.depth.z;
    const glm::vec3 p = inside ? chord.exit : chord.entry;
    if (center.view.z + p.z > block.depth.z) return {};
    return {true, f32::rayDistance(block, center.view, range, p),
            inside ? -chord.exitNormal : chord.entryNormal, p};
  }
};

// Float coordinates of a pixel at which the ray passes the centre at about `offset` (in pixels) from it.
glm::vec2 pixelNear(const View& view, glm::vec3 center, glm::dvec2 offset) {
  const Vec3 p = test::exactViewPoint(view, kOrigin, center);
  const Real depth = view.projection == Projection::perspective ? Real(view.distance) - p.z : Real(1);
  return glm::vec2(glm::dvec2(static_cast<double>(p.x / depth / Real(view.pixelSize)) + view.center.x,
                              static_cast<double>(p.y / depth / Real(view.pixelSize)) + view.center.y) +
                   offset);
}

void checkSphere(Random& random, Projection projection) {
  const auto radius = static_cast<float>(random.logUniform(1e-3, 1e3));
  const double distance = random.logUniform(1e-2, 1e5);
  const PlacedView s = placeView(random, static_cast<double>(radius), distance, projection);
  const double pixelRadius = static_cast<double>(radius) / s.view.pixelSize /
                             (projection == Projection::perspective ? distance : 1.0);
  // Half of the rays graze: they pass the centre at (1 +- 1e-4) radii.
  const double share = random.uniform(0, 1) < 0.5 ? random.uniform(0, 1.2) : 1 + random.uniform(-1e-4, 1e-4);
  const double angle = random.uniform(0, 6.283185307179586);
  const glm::vec2 pixel =
      pixelNear(s.view, s.center, pixelRadius * share * glm::dvec2(std::cos(angle), std::sin(angle)));

  const FloatRay ray(s.view, s.center, glm::vec3(0), radius, pixel);
  const FloatHit hit = ray.visible(f32::sphereChord(ray.point, ray.direction, radius));
  const ExactRay exact = test::exactRay(s.view, pixel);
  const Vec3 center = test::exactViewPoint(s.view, kOrigin, s.center);
  const auto chord = test::exactSphere(exact, center, Real(radius));
  const Vec3 toCenter = center - exact.origin;
  const Real closest = glm::length(toCenter - glm::dot(toCenter, exact.direction) * exact.direction);

  // Rounding of the ray relative to the sphere: a few units of its radius, or of the distance if the eye is
  // as near.
  const Real slack =
      Real(16 * kEpsilon) * (Real(radius) + std::min<Real>(glm::length(toCenter), 4 * Real(radius)));
  if (!hit.hit) {
    EXPECT_FALSE(chord && closest < Real(radius) - slack && chord->out > slack)
        << "false miss, radius " << radius << " distance " << distance;
    return;
  }
  EXPECT_LT(closest, Real(radius) + slack) << "false hit, radius " << radius << " distance " << distance;
  const Vec3 at = exact.origin + Real(hit.distance) * exact.direction;
  const Real rounding = Real(std::abs(hit.distance)) * Real(kEpsilon) * Real(1.01);
  EXPECT_LE(std::abs(glm::length(at - center) - Real(radius)), 4 * slack + rounding)
      << "radius " << radius << " distance " << distance << " share " << share;
  EXPECT_NEAR(glm::length(hit.normal), 1.0f, 1e-5f);
  if (chord && closest < Real(0.9) * Real(radius)) {
    const Real truth = chord->in > 0 ? chord->in : chord->out;
    EXPECT_LE(std::abs(Real(hit.distance) - truth), 8 * slack + rounding);
  }
}

TEST(QuadricMath, SphereMatchesLongDoubleAtEveryScale) {
  Random random(1);
  for (int i = 0; i < 100000 && !HasFailure(); ++i) checkSphere(random, Projection::perspective);
}

TEST(QuadricMath, SphereMatchesLongDoubleInOrthographicViews) {
  Random random(2);
  for (int i = 0; i < 50000 && !HasFailure(); ++i) checkSphere(random, Projection::orthographic);
}

void checkCylinder(Random& random, Projection projection) {
  const auto radius = static_cast<float>(random.logUniform(1e-3, 1e3));
  const double half = static_cast<double>(radius) * random.logUniform(0.2, 20);
  const double distance = random.logUniform(1e-2, 1e5);
  const double size = static_cast<double>(radius) + half;
  const PlacedView s = placeView(random, size, distance, projection);
  // One in five is seen almost end-on.
  glm::dvec3 axis = random.direction();
  if (random.uniform(0, 1) < 0.2) {
    axis = glm::normalize(glm::transpose(s.view.rotation) * glm::dvec3(0, 0, 1) +
                          random.direction() * random.logUniform(1e-6, 1e-1));
  }
  const glm::vec3 a(glm::dvec3(s.center) - axis * half), b(glm::dvec3(s.center) + axis * half);
  const double length = static_cast<double>(glm::length(b - a));
  if (!(length > 0)) return;
  const double pixelSize = size / s.view.pixelSize / (projection == Projection::perspective ? distance : 1.0);
  const glm::vec2 pixel =
      pixelNear(s.view, s.center,
                pixelSize * glm::dvec2(random.uniform(-1, 1), random.uniform(-1, 1)) * random.uniform(0, 1));

  // What the vertex shader does.
  const f32::Split x = f32::twoSum(a.x, b.x), y = f32::twoSum(a.y, b.y), z = f32::twoSum(a.z, b.z);
  const glm::vec3 along = b - a;
  const float halfLength = 0.5f * glm::length(along);
  const FloatRay ray(s.view, 0.5f * glm::vec3(x.hi, y.hi, z.hi), 0.5f * glm::vec3(x.lo, y.lo, z.lo),
                     radius + halfLength, pixel);
  const f32::ViewBlock& view = ray.block;
  const glm::vec3 axisView = glm::normalize(f32::turn(view, along));
  const FloatHit hit =
      ray.visible(f32::cylinderChord(ray.point, ray.direction, axisView, halfLength, radius));

  const ExactRay exact = test::exactRay(s.view, pixel);
  const Vec3 endA = test::exactViewPoint(s.view, kOrigin, a), endB = test::exactViewPoint(s.view, kOrigin, b);
  const Real slack = Real(64 * kEpsilon) * Real(size);
  const auto larger = test::exactCylinder(exact, endA, endB, Real(radius) + slack);
  const Vec3 stretch = glm::normalize(endB - endA) * slack;
  if (!hit.hit) {
    // A miss is right if a slightly smaller cylinder is missed, too.
    if (Real(radius) <= slack || glm::length(endB - endA) <= 2 * slack) return;
    const auto smaller = test::exactCylinder(exact, endA + stretch, endB - stretch, Real(radius) - slack);
    EXPECT_FALSE(smaller && smaller->out > slack)
        << "false miss, radius " << radius << " distance " << distance;
    return;
  }
  EXPECT_TRUE(larger || test::exactCylinder(exact, endA - stretch, endB + stretch, Real(radius) + slack))
      << "false hit, radius " << radius << " distance " << distance;
  const Vec3 at = exact.origin + Real(hit.distance) * exact.direction;
  const Real rounding = Real(std::abs(hit.distance)) * Real(kEpsilon) * Real(1.01);
  EXPECT_LE(std::abs(test::cylinderDistance(at, endA, endB, Real(radius))), 4 * slack + rounding)
      << "radius " << radius << " half length " << half << " distance " << distance;
}

TEST(QuadricMath, CylinderMatchesLongDoubleAtEveryScale) {
  Random random(3);
  for (int i = 0; i < 100000 && !HasFailure(); ++i) checkCylinder(random, Projection::perspective);
}

TEST(QuadricMath, CylinderMatchesLongDoubleInOrthographicViews) {
  Random random(4);
  for (int i = 0; i < 50000 && !HasFailure(); ++i) checkCylinder(random, Projection::orthographic);
}

// The formula in common use: discriminant as the difference of two squares of the camera distance.
bool textbookHit(glm::vec3 toCenter, glm::vec3 direction, float radius, float& t) {
  const float b = glm::dot(toCenter, direction);
  const float square = b * b + radius * radius - glm::dot(toCenter, toCenter);
  if (square < 0) return false;
  t = b - std::sqrt(square);
  return true;
}

TEST(QuadricMath, NoFalseMissAndNoErrorAbove1e3AngstromAt10000Angstrom) {
  Random random(5);
  const float radius = 1.7f;
  int hits = 0, textbookMisses = 0;
  Real worst = 0;
  for (int i = 0; i < 400000; ++i) {
    PlacedView s = placeView(random, 1.7, 10000, Projection::perspective);
    s.view.pixelSize = 1.7 / 10000 / 20;  // the atom covers 40 pixels
    const double share = std::sqrt(random.uniform(0, 1)), angle = random.uniform(0, 6.283185307179586);
    const glm::vec2 pixel =
        pixelNear(s.view, s.center, 20 * share * glm::dvec2(std::cos(angle), std::sin(angle)));
    const ExactRay exact = test::exactRay(s.view, pixel);
    const Vec3 center = test::exactViewPoint(s.view, kOrigin, s.center);
    const auto chord = test::exactSphere(exact, center, Real(radius));
    const FloatRay ray(s.view, s.center, glm::vec3(0), radius, pixel);
    const FloatHit hit = ray.visible(f32::sphereChord(ray.point, ray.direction, radius));
    if (!chord) continue;
    ++hits;
    ASSERT_TRUE(hit.hit) << "false miss of ray " << i;
    worst = std::max(worst, std::abs(Real(hit.distance) - chord->in));
    float t = 0;
    const glm::vec3 toCenter = ray.center.view - glm::vec3(0, 0, static_cast<float>(s.view.distance));
    if (!textbookHit(toCenter, ray.direction, radius, t)) ++textbookMisses;
  }
  EXPECT_GT(hits, 390000);
  EXPECT_LT(worst, 1e-3L);
  RecordProperty("worst_error_angstrom", std::to_string(static_cast<double>(worst)));
  RecordProperty("textbook_misses_percent", std::to_string(100.0 * textbookMisses / hits));
  EXPECT_GT(textbookMisses, hits / 10) << "the test no longer shows what it is for";
}

TEST(QuadricMath, NamedDegenerateCases) {
  const glm::vec3 forward(0, 0, -1);
  EXPECT_FALSE(f32::sphereChord({2, 0, 0}, forward, 1).hit);
  EXPECT_TRUE(f32::sphereChord({1, 0, 0}, forward, 1).hit) << "a tangent ray hits";
  EXPECT_FALSE(f32::sphereChord({NAN, 0, 0}, forward, 1).hit);
  EXPECT_FALSE(f32::sphereChord({0, 0, 0}, forward, NAN).hit);
  // From the centre outwards: the exit is the sphere itself.
  const f32::Chord inside = f32::sphereChord({0, 0, 0}, forward, 3);
  EXPECT_EQ(inside.exit, glm::vec3(0, 0, -3));

  const glm::vec3 axis(0, 0, 1);
  const f32::Chord endOn = f32::cylinderChord({0.5f, 0, 0}, forward, axis, 2, 1);
  ASSERT_TRUE(endOn.hit);
  EXPECT_EQ(endOn.entry, glm::vec3(0.5f, 0, 2));
  EXPECT_EQ(endOn.entryNormal, axis);
  EXPECT_EQ(endOn.exitNormal, -axis);
  EXPECT_FALSE(f32::cylinderChord({1.5f, 0, 0}, forward, axis, 2, 1).hit);
  EXPECT_FALSE(f32::cylinderChord({NAN, 0, 0}, forward, axis, 2, 1).hit);
  const f32::Chord across = f32::cylinderChord({0, 0, 1}, {1, 0, 0}, axis, 2, 1);
  ASSERT_TRUE(across.hit);
  EXPECT_EQ(across.entry, glm::vec3(-1, 0, 1));
  EXPECT_EQ(across.entryNormal, glm::vec3(-1, 0, 0));
  EXPECT_FALSE(f32::cylinderChord({0, 0, 2.5f}, {1, 0, 0}, axis, 2, 1).hit) << "beyond the cap";
}

TEST(DoubleFloat, KeepsFortyEightBits) {
  Random random(6);
  for (int i = 0; i < 100000; ++i) {
    const double a = random.direction().x * random.logUniform(1e-6, 1e6);
    const double b = random.direction().y * random.logUniform(1e-6, 1e6);
    const auto split = [](double x) {
      const auto hi = static_cast<float>(x);
      return f32::makeSplit(hi, static_cast<float>(x - static_cast<double>(hi)));
    };
    const auto value = [](f32::Split s) { return static_cast<double>(s.hi) + static_cast<double>(s.lo); };
    const f32::Split sa = split(a), sb = split(b);
    const double ra = value(sa), rb = value(sb);  // what the split holds of a and b
    const double bound = 0x1p-44;
    EXPECT_LE(std::abs(value(f32::addSplit(sa, sb)) - (ra + rb)), bound * (std::abs(ra) + std::abs(rb)));
    EXPECT_LE(std::abs(value(f32::multiplySplit(sa, sb)) - ra * rb), bound * std::abs(ra * rb));
    EXPECT_LE(std::abs(value(f32::quotient(sa, sb)) - ra / rb), bound * std::abs(ra / rb));
    EXPECT_LE(std::abs(value(f32::sqrtSplit(split(std::abs(a)))) - std::sqrt(value(split(std::abs(a))))),
              bound * std::sqrt(std::abs(ra)));
    EXPECT_EQ(value(f32::twoSum(sa.hi, sb.hi)), static_cast<double>(sa.hi) + static_cast<double>(sb.hi));
    EXPECT_EQ(value(f32::twoProduct(sa.hi, sb.hi)), static_cast<double>(sa.hi) * static_cast<double>(sb.hi));
  }
}

TEST(Octahedral, RoundTripsEveryDirection) {
  Random random(7);
  for (int i = 0; i < 100000; ++i) {
    const glm::vec3 n(random.direction());
    EXPECT_LT(glm::length(f32::decodeNormal(f32::encodeNormal(n)) - n), 1e-6f);
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {-1.0f, 1.0f}) {
      glm::vec3 n(0);
      n[axis] = sign;
      EXPECT_LT(glm::length(f32::decodeNormal(f32::encodeNormal(n)) - n), 1e-6f);
    }
  }
}

}  // namespace
}  // namespace meniscus

// shaders/shared/ in float32 against long double: rays against ellipsoids from balls to needles and discs of
// 10,000 : 1, from 1e-2 to 1e5 Å away, and the bounds of their projections.

#include <gtest/gtest.h>

#include <cmath>

#include "core/shared_math.h"
#include "render/view_block.h"
#include "tests/stability/extremes.h"
#include "tests/support/exact_rays.h"
#include "tests/support/random.h"

namespace meniscus {
namespace {

using test::ExactEllipsoid;
using test::ExactRay;
using test::kEpsilon;
using test::kOrigin;
using test::Random;
using test::Real;
using test::Vec3;

// An ellipsoid that covers 1 to 300 pixels of a picture, away from its middle.
struct Placed {
  View view;
  EllipsoidPrimitive ellipsoid;
  double longest;
};

Placed place(Random& random, Projection projection, double thinnest) {
  Placed p;
  p.longest = random.logUniform(1e-3, 1e3);
  double middle = p.longest * random.logUniform(thinnest, 1),
         shortest = p.longest * random.logUniform(thinnest, 1);
  if (middle < shortest) std::swap(middle, shortest);
  const glm::dmat3 turn = glm::mat3_cast(random.rotation());
  p.ellipsoid = {glm::vec3(random.inBox(200)),
                 static_cast<float>(shortest),
                 glm::vec3(turn[0] * p.longest),
                 glm::vec3(turn[1] * middle),
                 0,
                 1};
  const bool perspective = projection == Projection::perspective;
  const double distance = random.logUniform(1e-2, 1e5);
  View& v = p.view;
  v.projection = projection;
  v.size = {2048, 1536};
  v.center = {1024, 768};
  v.rotation = glm::mat3_cast(random.rotation());
  v.pixelSize = p.longest / random.logUniform(1, 300) / (perspective ? distance : 1.0);
  const double halfWidth = 1024 * v.pixelSize;
  const double slope = perspective ? std::min(halfWidth, 0.7) : halfWidth;
  const glm::dvec2 aside(random.uniform(-slope, slope), random.uniform(-0.7 * slope, 0.7 * slope));
  v.distance = distance * random.uniform(0.7, 1.3);
  const glm::dvec3 center(aside * (perspective ? distance : 1.0), v.distance - distance);
  v.pivot = kOrigin + glm::dvec3(p.ellipsoid.center) - glm::transpose(v.rotation) * center;
  v.nearZ = perspective ? v.distance : center.z + 3 * p.longest;
  v.farZ = center.z - 3 * p.longest;
  return p;
}

// What the vertex shader hands to the fragment shader.
struct FloatEllipsoid {
  f32::ViewBlock block;
  f32::ProjectedCenter center;
  f32::Split range;
  glm::vec3 u, v, w, radii;

  explicit FloatEllipsoid(const Placed& p) {
    block = makeViewBlock(p.view, kOrigin, {0, 0, 2048, 1536}, {0, 0});
    center = f32::projectCenter(block, p.ellipsoid.center, glm::vec3(0));
    range = f32::centerRange(block, p.ellipsoid.center, glm::vec3(0));
    u = glm::normalize(f32::turn(block, p.ellipsoid.axisA));
    v = glm::normalize(f32::turn(block, p.ellipsoid.axisB));
    w = glm::cross(u, v);
    radii = {glm::length(p.ellipsoid.axisA), glm::length(p.ellipsoid.axisB), p.ellipsoid.shortest};
  }
  f32::Chord chord(glm::vec2 pixel) const {
    const glm::vec3 point = f32::rayPoint(block, pixel, {center.pixelX.hi, center.pixelY.hi},
                                          {center.pixelX.lo, center.pixelY.lo}, center.view, center.depth,
                                          f32::nearEye(block, center.depth, radii.x));
    return f32::ellipsoidChord(point, f32::rayDirection(block, pixel), u, v, w, radii);
  }
};

// Pixel of a point of view space.
glm::dvec2 pixelOf(const View& view, const Vec3& p) {
  const Real depth = view.projection == Projection::perspective ? Real(view.distance) - p.z : Real(1);
  return {static_cast<double>(p.x / depth / Real(view.pixelSize)) + view.center.x,
          static_cast<double>(p.y / depth / Real(view.pixelSize)) + view.center.y};
}

// A point of the ellipsoid, or beside it, `share` of the way from its centre to its surface.
Vec3 somewhere(Random& random, const ExactEllipsoid& e, double share) {
  const Vec3 unit = Vec3(random.direction()) * Real(share);
  return e.center + unit.x * e.radii.x * e.axes[0] + unit.y * e.radii.y * e.axes[1] +
         unit.z * e.radii.z * e.axes[2];
}

// Adds to `worst` the error in roundings of the longest semi-axis.
void checkRay(Random& random, Projection projection, Real& worst) {
  const Placed p = place(random, projection, 1e-4);
  const ExactEllipsoid e = test::exactEllipsoid(p.view, kOrigin, p.ellipsoid);
  const glm::vec2 pixel(pixelOf(p.view, somewhere(random, e, random.uniform(0, 1.1))));
  const FloatEllipsoid f(p);
  const ExactRay ray = test::exactRay(p.view, pixel);
  const auto chord = test::exactEllipsoidChord(ray, e);
  const f32::Chord c = f.chord(pixel);
  const Vec3 toCenter = e.center - ray.origin;
  // Rounding of the ray relative to the ellipsoid, as for spheres.
  const Real slack =
      Real(64 * kEpsilon) * (Real(p.longest) + std::min<Real>(glm::length(toCenter), 4 * Real(p.longest)));
  if (!c.hit) {
    if (!chord) return;
    const Vec3 deepest = ray.origin + (chord->in + chord->out) / 2 * ray.direction;
    EXPECT_LE(test::ellipsoidDistance(deepest, e), slack) << "false miss, longest " << p.longest;
    return;
  }
  EXPECT_NEAR(glm::length(c.entryNormal), 1.0f, 1e-5f);
  EXPECT_NEAR(glm::length(c.exitNormal), 1.0f, 1e-5f);
  EXPECT_LE(glm::dot(c.entryNormal, f32::rayDirection(f.block, pixel)), 2e-6f) << "entered from outside";
  const bool inside = f.center.view.z + c.entry.z > f.block.depth.z;
  const glm::vec3 point = inside ? c.exit : c.entry;
  if (f.center.view.z + point.z > f.block.depth.z) return;  // behind the eye
  const float distance = f32::rayDistance(f.block, f.center.view, f.range, point);
  const Real error = test::ellipsoidDistance(ray.origin + Real(distance) * ray.direction, e);
  const Real rounding = std::abs(Real(distance)) * Real(kEpsilon) * Real(1.01);
  EXPECT_LE(error, slack + rounding) << "longest " << p.longest << " middle " << f.radii.y << " shortest "
                                     << f.radii.z << " distance " << distance;
  worst = std::max(worst, (error - rounding) / (slack / 64));
}

TEST(EllipsoidMath, MatchesLongDoubleAtEveryScaleAndShape) {
  Random random(11);
  Real worst = 0;
  for (int i = 0; i < 100000 && !HasFailure(); ++i) checkRay(random, Projection::perspective, worst);
  RecordProperty("worst_error_roundings", std::to_string(static_cast<double>(worst)));
}

TEST(EllipsoidMath, MatchesLongDoubleInOrthographicViews) {
  Random random(12);
  Real worst = 0;
  for (int i = 0; i < 50000 && !HasFailure(); ++i) checkRay(random, Projection::orthographic, worst);
  RecordProperty("worst_error_roundings", std::to_string(static_cast<double>(worst)));
}

TEST(EllipsoidMath, NormalsAreThoseOfTheSurface) {
  Random random(13);
  for (int i = 0; i < 20000; ++i) {
    const glm::dmat3 turn = glm::mat3_cast(random.rotation());
    const glm::dvec3 radii(random.logUniform(0.1, 10), random.logUniform(0.1, 10),
                           random.logUniform(0.1, 10));
    const glm::dvec3 unit = random.direction();
    const glm::dvec3 surface = turn * (unit * radii);
    const glm::dvec3 normal = glm::normalize(turn * (unit / radii));
    const glm::dvec3 direction = glm::normalize(random.direction() - normal);
    if (glm::dot(direction, normal) > -0.1) continue;
    const f32::Chord c =
        f32::ellipsoidChord(glm::vec3(surface - direction * random.uniform(-1, 1)), glm::vec3(direction),
                            glm::vec3(turn[0]), glm::vec3(turn[1]), glm::vec3(turn[2]), glm::vec3(radii));
    ASSERT_TRUE(c.hit);
    EXPECT_LT(glm::length(glm::dvec3(c.entry) - surface), 2e-4);
    EXPECT_LT(glm::length(glm::dvec3(c.entryNormal) - normal), 2e-3);
  }
}

TEST(EllipsoidMath, OfEqualSemiAxesIsTheSphere) {
  Random random(14);
  for (int i = 0; i < 20000; ++i) {
    const glm::mat3 turn(glm::mat3_cast(random.rotation()));
    const auto radius = static_cast<float>(random.logUniform(1e-3, 1e3));
    const glm::vec3 direction(random.direction());
    const glm::vec3 point =
        static_cast<float>(random.uniform(0, 1.5)) * radius * glm::vec3(random.direction());
    const f32::Chord sphere = f32::sphereChord(point, direction, radius);
    const f32::Chord c = f32::ellipsoidChord(point, direction, turn[0], turn[1], turn[2], glm::vec3(radius));
    const float depth2 = glm::dot(sphere.entry - sphere.exit, sphere.entry - sphere.exit);
    if (depth2 < 1e-4f * radius * radius) continue;  // grazed
    ASSERT_EQ(c.hit, sphere.hit);
    EXPECT_LT(glm::length(c.entry - sphere.entry), 1e-4f * radius);
    EXPECT_LT(glm::length(c.exitNormal - sphere.exitNormal), 1e-4f);
  }
}

TEST(EllipsoidMath, BoundsHoldTheSurfaceAndTouchIt) {
  Random random(15);
  int bounded = 0;
  for (int i = 0; i < 4000; ++i) {
    const Placed p = place(random, i % 2 == 0 ? Projection::perspective : Projection::orthographic,
                           i % 3 == 0 ? 1e-4 : 0.1);
    const ExactEllipsoid e = test::exactEllipsoid(p.view, kOrigin, p.ellipsoid);
    const FloatEllipsoid f(p);
    const glm::vec3 shares = f.radii / f.radii.x;
    const f32::Extent x = f32::ellipsoidExtent(f.block, f.center.view.x / f.center.depth, f.center.depth,
                                               f.radii.x, shares * glm::vec3(f.u.x, f.v.x, f.w.x),
                                               shares * glm::vec3(f.u.z, f.v.z, f.w.z));
    if (!x.bounded) {
      const Real depth = Real(p.view.distance) - e.center.z;
      EXPECT_LT(depth, Real(1.01) * e.radii.x) << "bounded in front of the eye";
      continue;
    }
    ++bounded;
    // The largest and smallest pixel of surface points, found by climbing from random ones.
    const double center = pixelOf(p.view, e.center).x;
    const double low = static_cast<double>(x.low) / p.view.pixelSize,
                 high = static_cast<double>(x.high) / p.view.pixelSize;
    const double tolerance = 2e-4 * (high - low) + 1e-6;
    double lowest = 0, highest = 0;
    glm::dvec3 lowAt(0), highAt(0);
    const auto pixelAt = [&](const glm::dvec3& unit) {
      const Vec3 s = Vec3(unit) * e.radii;
      return pixelOf(p.view, e.center + s.x * e.axes[0] + s.y * e.axes[1] + s.z * e.axes[2]).x - center;
    };
    for (int k = 0; k < 600; ++k) {
      const double step = k < 100 ? 10 : std::exp(-0.02 * (k - 100));
      for (const bool up : {false, true}) {
        const glm::dvec3 unit = glm::normalize((up ? highAt : lowAt) + step * random.direction());
        const double pixel = pixelAt(unit);
        if (!(up ? pixel > highest : pixel < lowest)) continue;
        (up ? highest : lowest) = pixel;
        (up ? highAt : lowAt) = unit;
      }
    }
    EXPECT_GE(lowest, low - tolerance);
    EXPECT_LE(highest, high + tolerance);
    EXPECT_NEAR(lowest, low, 0.01 * (high - low) + tolerance);
    EXPECT_NEAR(highest, high, 0.01 * (high - low) + tolerance);
    if (HasFailure()) return;
  }
  EXPECT_GT(bounded, 2000);
}

TEST(EllipsoidMath, NamedDegenerateCases) {
  const glm::vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), forward(0, 0, -1);
  const auto chord = [&](glm::vec3 point, glm::vec3 radii) {
    return f32::ellipsoidChord(point, forward, x, y, z, radii);
  };
  const f32::Chord through = chord({0, 0, 0}, {3, 2, 1});
  ASSERT_TRUE(through.hit);
  EXPECT_EQ(through.entry, z);
  EXPECT_EQ(through.exit, -z);
  EXPECT_EQ(through.entryNormal, z);
  EXPECT_TRUE(chord({3, 0, 0}, {3, 2, 1}).hit) << "a tangent ray hits";
  EXPECT_FALSE(chord({3.001f, 0, 0}, {3, 2, 1}).hit);
  EXPECT_TRUE(chord({0, 0, 0}, {1e-4f, 1e-4f, 1}).hit) << "a needle end-on";
  EXPECT_EQ(chord({0, 0, 0}, {1e-4f, 1e-4f, 1}).entry, z);
  EXPECT_FALSE(chord({NAN, 0, 0}, {1, 1, 1}).hit);
  EXPECT_FALSE(chord({0, 0, 0}, {1, 1, NAN}).hit);
}

}  // namespace
}  // namespace meniscus

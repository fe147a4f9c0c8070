// The truth for metaballs over scales and in scenes that break methods, against dense sampling and bisection
// in extended precision.

#include "core/reference_tracer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/exact_field.h"

namespace meniscus {
namespace {

using test::bisected;
using test::ExactField;
using test::Random;
using test::Real;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Case {
  Kernel kernel;
  double level;
  int hollow;  ///< every so many balls one is negative
};

const std::vector<Case> kCases{{{KernelShape::sextic}, 0.5, 0},    {{KernelShape::sextic}, 0.2, 3},
                               {{KernelShape::quartic}, 0.5, 0},   {{KernelShape::quartic}, 0.3, 2},
                               {{KernelShape::power, 2}, 0.1, 3},  {{KernelShape::power, 3}, 0.4, 4},
                               {{KernelShape::power, 7}, 0.05, 3}, {{KernelShape::power, 16}, 0.02, 0},
                               {{KernelShape::power, 16}, 0.01, 3}};

glm::dvec2 centerOf(std::size_t pixel, int width) {
  const auto w = static_cast<std::size_t>(width);
  return {static_cast<double>(pixel % w) + 0.5, static_cast<double>(pixel / w) + 0.5};
}

// Where the ray passes the near plane.
Real startOf(const View& view, glm::dvec2 pixel) {
  if (view.projection == Projection::orthographic) return 0;
  return (Real(view.distance) - Real(view.nearZ)) / -test::exactRay(view, pixel).direction.z;
}

// Samples before the hit, or to the end, have one sign; the hit changes it.
void expectFirst(const ExactField& f, Real start, double distance, std::size_t pixel, int samples) {
  const bool hit = distance < kInfinity;
  const Real from = std::max(start, f.first), to = hit ? Real(distance) - 1e-9L : f.last;
  if (from < to) {
    const bool sign = f(from) > 0;
    int others = 0;
    for (int i = 0; i <= samples; ++i) others += (f(from + (to - from) * i / samples) > 0) != sign ? 1 : 0;
    EXPECT_EQ(others, 0) << "pixel " << pixel;
    EXPECT_TRUE(hit || !sign) << "pixel " << pixel;
  }
  EXPECT_TRUE(!hit || (f(Real(distance) - 1e-9L) > 0) != (f(Real(distance) + 1e-9L) > 0))
      << "pixel " << pixel;
}

TEST(ReferenceTruth, DenseSamplesFindNoEarlierRoot) {
  const glm::dvec3 origin(-4, 17, 3);
  unsigned seed = 1;
  for (const Case& c : kCases) {
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
      const MetaballField field = test::randomField(c.kernel, c.level, 40, 6, c.hollow, ++seed);
      View view = test::viewOfBall(projection, {160, 120}, origin, 8);
      if (seed % 3 == 0) view.nearZ = 0;  // cut: many rays start inside
      const ReferenceImage image = traceReference(field, origin, view);
      Random random(seed);
      for (int i = 0; i < 30; ++i) {
        const std::size_t pixel = random.index(image.distance.size());
        if (image.grazing[pixel] != 0) continue;
        const glm::dvec2 at = centerOf(pixel, 160);
        const ExactField f(field, origin, view, at);
        expectFirst(f, startOf(view, at), image.distance[pixel], pixel, 100'000);
      }
    }
  }
}

// ReferenceImage::grazing as its definition says, from five pictures without it: so what the tube of rays
// proves is true, in every pixel.
TEST(ReferenceTruth, GrazingIsWhatTheMovedRaysDecide) {
  unsigned seed = 100;
  for (const Case& c : kCases) {
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
      const MetaballField field = test::randomField(c.kernel, c.level, 60, 6, c.hollow, ++seed);
      View view = test::viewOfBall(projection, {160, 120}, glm::dvec3(0), 8);
      if (seed % 3 == 0) view.nearZ = 1;
      const ReferenceImage image = traceReference(field, glm::dvec3(0), view);
      ReferenceOptions plain;
      plain.grazing = false;
      const ReferenceImage middle = traceReference(field, glm::dvec3(0), view, plain);
      std::vector<ReferenceImage> moved;
      for (const glm::dvec2 move :
           {glm::dvec2(0.02, 0), glm::dvec2(-0.02, 0), glm::dvec2(0, 0.02), glm::dvec2(0, -0.02)}) {
        View aside = view;
        aside.center -= move;
        moved.push_back(traceReference(field, glm::dvec3(0), aside, plain));
      }
      const auto tangent = [&](const ReferenceImage& of, std::size_t i) {
        const double cosine =
            std::abs(glm::dot(glm::dvec3(of.hits.normal[i]), rayThrough(view, centerOf(i, 160)).direction));
        return std::sqrt(1 - cosine * cosine) / cosine;
      };
      std::size_t wrong = 0, grazing = 0, farther = 0;
      for (std::size_t i = 0; i < image.distance.size(); ++i) {
        const double t = middle.distance[i];
        bool differs = false, doubtful = middle.grazing[i] != 0;
        for (const ReferenceImage& other : moved) {
          const double t1 = other.distance[i];
          doubtful |= other.grazing[i] != 0;
          if ((t < kInfinity) != (t1 < kInfinity)) differs = true;
          if (!(t < kInfinity) || !(t1 < kInfinity)) continue;
          const double apart =
              0.02 * view.pixelSize * (projection == Projection::perspective ? std::max(t, t1) : 1);
          const double allowed = (1 + 3 * std::min(tangent(middle, i), tangent(other, i))) * apart;
          if (std::abs(t1 - t) > allowed * 1.01) differs = true;
          if (std::abs(t1 - t) > allowed * 0.99) doubtful = true;  // tangents from float normals
        }
        // Entries against exits are not to be told apart here.
        if (differs && image.grazing[i] == 0) ++wrong;
        if (!differs && !doubtful && image.grazing[i] != 0 && view.nearZ != 1) ++wrong;
        grazing += image.grazing[i];
        if (t < kInfinity &&
            std::abs(image.distance[i] - t) > 1e-12 * t / std::min(1.0, 1 / tangent(middle, i)))
          ++farther;
        EXPECT_EQ(image.distance[i] < kInfinity, t < kInfinity);
      }
      EXPECT_EQ(wrong, 0u) << seed;
      EXPECT_EQ(farther, 0u) << seed;
      EXPECT_GT(grazing, 0u) << seed;
      EXPECT_LT(image.shiftedPixels, image.distance.size() / 20) << seed;
      EXPECT_EQ(image.undecidedPixels, 0u) << seed;
    }
  }
}

// One ball, of any size, anywhere, seen from any distance: a sphere in extended precision.
TEST(ReferenceTruth, OneBallOverAllScales) {
  Random random(5);
  double worst = 0;
  for (int i = 0; i < 4000; ++i) {
    const Kernel kernel = kCases[random.index(kCases.size())].kernel;
    MetaballField field{
        {{glm::vec3(random.inBox(100)), static_cast<float>(random.logUniform(1e-3, 1e3)), 1, 0, 1}},
        kernel,
        random.logUniform(1e-6, 0.99)};
    const double support = static_cast<double>(field.balls[0].support),
                 radius = support * coreShare(kernel, field.level, 1);
    const glm::dvec3 origin = random.inBox(random.logUniform(1, 1e6));
    View view;
    view.projection = (random.bits() & 1u) != 0 ? Projection::perspective : Projection::orthographic;
    view.rotation = glm::mat3_cast(random.rotation());
    view.pivot = origin + glm::dvec3(field.balls[0].center) + random.inBox(support);
    view.distance = 2 * support + random.logUniform(1e-2, 1e5);
    view.size = {1, 1};
    const bool perspective = view.projection == Projection::perspective;
    view.pixelSize = 0.01 * radius / (perspective ? view.distance : 1);
    view.nearZ = perspective ? view.distance * (1 - 1e-9) : 10 * support;
    // Aims at a point within the ball's outline, or just beside.
    const test::Vec3 center = test::exactViewPoint(view, origin, field.balls[0].center);
    const glm::dvec2 aim = glm::dvec2(center) +
                           radius * random.uniform(0, 1.05) * glm::normalize(glm::dvec2(random.direction()));
    view.center = glm::dvec2(0.5) -
                  aim / (perspective ? view.distance - static_cast<double>(center.z) : 1.0) / view.pixelSize;
    const ReferenceImage image = traceReference(field, origin, view);
    const auto chord = test::exactSphere(test::exactRay(view, {0.5, 0.5}), center, Real(radius));
    if (!chord || chord->out - chord->in < 1e-4L * Real(radius)) continue;  // at the edge rounding decides
    ASSERT_LT(image.distance[0], kInfinity) << i;
    // Of radius and place one rounding each, as steep as the surface is seen; t itself is a double.
    const Real end = chord->in < startOf(view, {0.5, 0.5}) ? chord->out : chord->in;
    const double t = static_cast<double>(end),
                 steep = 2 * radius / static_cast<double>(chord->out - chord->in);
    const double unit = 0x1p-53 * (t + 2 * support * steep * support / radius);
    worst = std::max(worst, std::abs(image.distance[0] - t) / unit);
  }
  RecordProperty("roundings", std::to_string(worst));
  EXPECT_LT(worst, 4);
}

TEST(ReferenceTruth, WhereTheSceneLiesDoesNotMatter) {
  const MetaballField field = test::randomField({KernelShape::sextic}, 0.5, 60, 6, 4, 9);
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    const ReferenceImage here =
        traceReference(field, glm::dvec3(0), test::viewOfBall(projection, {80, 60}, glm::dvec3(0), 8));
    const glm::dvec3 far(1e6, -1e6, 1e6);
    const ReferenceImage there = traceReference(field, far, test::viewOfBall(projection, {80, 60}, far, 8));
    EXPECT_EQ(here.grazing, there.grazing);
    EXPECT_EQ(here.hits.id, there.hits.id);
    for (std::size_t i = 0; i < here.distance.size(); ++i) {
      if (here.distance[i] == there.distance[i] || here.grazing[i] != 0) continue;
      EXPECT_NEAR(here.distance[i], there.distance[i], 1e-9 * here.distance[i]);
    }
  }
}

// From 1e7 Å the rays of a perspective view are parallel to 1e-6.
TEST(ReferenceTruth, FarPerspectiveIsOrthographic) {
  const MetaballField field = test::randomField({KernelShape::quartic}, 0.3, 60, 6, 4, 10);
  View view = test::viewOfBall(Projection::orthographic, {80, 60}, glm::dvec3(0), 8);
  const ReferenceImage flat = traceReference(field, glm::dvec3(0), view);
  const double nearZ = view.nearZ;
  view.projection = Projection::perspective;
  view.distance = 1e7;
  view.pixelSize /= view.distance;
  const ReferenceImage far = traceReference(field, glm::dvec3(0), view);
  std::size_t hits = 0;
  for (std::size_t i = 0; i < flat.distance.size(); ++i) {
    if (flat.grazing[i] != 0 || far.grazing[i] != 0) continue;
    ASSERT_EQ(flat.distance[i] < kInfinity, far.distance[i] < kInfinity) << i;
    if (!(flat.distance[i] < kInfinity)) continue;
    ++hits;
    const double cosine = static_cast<double>(flat.hits.normal[i].z);
    EXPECT_NEAR(nearZ - flat.distance[i], view.distance - far.distance[i], 3e-5 / cosine) << i;
  }
  EXPECT_GT(hits, 500u);
}

TEST(ReferenceTruth, WideAndNarrowFieldsOfView) {
  const MetaballField field = test::randomField({KernelShape::sextic}, 0.5, 60, 6, 5, 11);
  for (const double fovDeg : {0.01, 1.0, 150.0, 170.0}) {
    Camera camera;
    camera.fovY = fovDeg * 3.141592653589793 / 180;
    camera.distance = fovDeg > 10 ? 9.0 : 9 / std::tan(camera.fovY / 2);
    const View view = makeView(camera, {64, 48}, {glm::dvec3(0), 10});
    const ReferenceImage image = traceReference(field, glm::dvec3(0), view);
    std::size_t hits = 0;
    for (std::size_t i = 0; i < image.distance.size(); i += 23) {
      if (image.grazing[i] != 0) continue;
      const glm::dvec2 at = centerOf(i, 64);
      const ExactField f(field, glm::dvec3(0), view, at);
      expectFirst(f, startOf(view, at), image.distance[i], i, 10'000);
      if (image.distance[i] < kInfinity) ++hits;
    }
    EXPECT_GT(hits, fovDeg > 160 ? 0u : 10u) << fovDeg;
  }
}

// Along the axis from outside: where the sum in extended precision changes sign.
double exactFirst(const MetaballField& field, const View& view, Real step) {
  const ExactField f(field, glm::dvec3(0), view, {0.5, 0.5});
  Real t = std::max(f.first, Real(0));
  while (t < f.last && f(t + step) <= 0) t += step;
  return t < f.last ? static_cast<double>(bisected(f, t, t + step)) : kInfinity;
}

// Both may be infinite.
void expectNear(double distance, double exact, double tolerance) {
  EXPECT_TRUE(distance == exact || std::abs(distance - exact) <= tolerance) << distance << " for " << exact;
}

TEST(ReferenceTruth, LevelsFromNothingToTheMaximum) {
  for (const Case& c : kCases) {
    const MetaballField balls{{{{0, 0, 0}, 3, 1, 0, 1}, {{0.5f, 0, 1}, 2, 0.5f, 0, 2}}, c.kernel, 1};
    for (const double level : {1e-30, 1e-12, 1e-6, 1e-3, 0.9}) {
      MetaballField field = balls;
      field.level = level;
      const View view = test::alongZ(0.25, 0.125, 10);
      const ReferenceImage image = traceReference(field, glm::dvec3(0), view);
      expectNear(image.distance[0], exactFirst(field, view, 1e-4L), 2e-13);
      EXPECT_EQ(image.undecidedPixels, 0u) << level;
    }
    // Just below the largest value of one ball: a speck, met in its middle.
    MetaballField speck{{{{0, 0, 0}, 3, 1, 0, 1}}, c.kernel, 1 - 1e-10};
    const double radius = 3 * std::sqrt(1e-10 / kernelSlope(c.kernel, 1));
    const double distance = traceReference(speck, glm::dvec3(0), test::alongZ(0, 0, 10, 1e-6)).distance[0];
    EXPECT_NEAR(distance, 10 - radius, 1e-5 * radius);
    speck.level = 1 + 1e-10;
    EXPECT_EQ(traceReference(speck, glm::dvec3(0), test::alongZ(0, 0, 10, 1e-6)).distance[0], kInfinity);
  }
}

TEST(ReferenceTruth, SupportsOfAMillionToOne) {
  for (const Case& c : kCases) {
    // A speck in front of the large ball, one on its surface, one in its depth.
    MetaballField field{{{{0, 0, 0}, 1000, 1, 0, 1}, {{0, 0, 1003}, 1e-3f, 1, 0, 2}}, c.kernel, 0.5};
    const double share = coreShare(c.kernel, 0.5, 1);
    const auto small = static_cast<double>(field.balls[1].support);
    const auto at = [&](double x) {
      return traceReference(field, glm::dvec3(0), test::alongZ(x, 0, 2000, 1e-5));
    };
    EXPECT_NEAR(at(0).distance[0], 997 - share * small, 1e-12);
    EXPECT_NEAR(at(0.999 * share * small).distance[0], 997 - share * small * std::sqrt(1 - 0.999 * 0.999),
                1e-11);
    EXPECT_EQ(at(0).hits.id[0], 2u);
    const double beside = 1.001 * share * small, large = 1000 * share;
    EXPECT_NEAR(at(beside).distance[0], 2000 - std::sqrt(large * large - beside * beside), 1e-11);
    const auto surface = static_cast<float>(large);
    field.balls[1].center.z = surface;
    const View view = test::alongZ(0, 0, static_cast<double>(surface) + 0.5, 1e-5);
    EXPECT_NEAR(traceReference(field, glm::dvec3(0), view).distance[0], exactFirst(field, view, 1e-5L),
                1e-11);
    field.balls[1] = {{0, 0, 100}, 1e-3f, -10, 0, 2};  // a bubble
    const double inside = traceReference(field, glm::dvec3(0), test::alongZ(0, 0, 150, 1e-5)).distance[0];
    const ExactField bubble(field, glm::dvec3(0), test::alongZ(0, 0, 150, 1e-5), {0.5, 0.5});
    EXPECT_NEAR(inside, 50, small);
    EXPECT_NE(bubble(Real(inside) - 1e-10L) > 0, bubble(Real(inside) + 1e-10L) > 0);
  }
}

// A thousand supports along one ray, with hits early, late and nowhere.
TEST(ReferenceTruth, ThousandBallsAlongOneRay) {
  for (const Case& c : {kCases[0], kCases[3], kCases[8]}) {
    for (const double length : {2.0, 100.0}) {
      for (const double strength : {0.001, 0.02, 1.0}) {
        Random random(3);
        MetaballField field{{}, c.kernel, 0.5};
        for (std::uint32_t i = 0; i < 1000; ++i) {
          const double z = length * (static_cast<double>(i) / 1000 - 0.5),
                       q = strength * (c.hollow != 0 && i % 3 == 0 ? -1 : 1);
          field.balls.push_back({glm::vec3(0, 0, static_cast<float>(z)),
                                 static_cast<float>(random.uniform(1.5, 2)), static_cast<float>(q), 0,
                                 i + 1});
        }
        View view = test::alongZ(0, 0, 100, 0.25);
        view.size = {3, 2};
        view.center = {0.5, 0.5};
        const ReferenceImage image = traceReference(field, glm::dvec3(0), view);
        expectNear(image.distance[0], exactFirst(field, view, 5e-3L), 1e-11);
        EXPECT_EQ(image.undecidedPixels, 0u);
      }
    }
  }
}

// Rays down the rows of a lattice enter and leave many supports at the same point.
TEST(ReferenceTruth, LatticeAlongAnAxis) {
  for (const Case& c : kCases) {
    MetaballField field{{}, c.kernel, c.level};
    for (int x = 0; x < 10; ++x)
      for (int y = 0; y < 10; ++y)
        for (int z = 0; z < 10; ++z) {
          const int sign = c.hollow != 0 && (x + y + z) % 2 == 0 ? -1 : 1;
          field.balls.push_back({glm::vec3(2 * x - 9, 2 * y - 9, 2 * z - 9), 3, static_cast<float>(sign), 0,
                                 static_cast<std::uint32_t>(100 * x + 10 * y + z + 1)});
        }
    View view = test::alongZ(0, 0, 20, 0.5);  // every second pixel centre on a row or between four
    view.size = {40, 40};
    view.center = {20.5, 20.5};
    const ReferenceImage image = traceReference(field, glm::dvec3(0), view);
    std::size_t checked = 0;
    for (std::size_t i = 0; i < image.distance.size(); i += 41) {
      if (image.grazing[i] != 0) continue;
      const glm::dvec2 at = centerOf(i, 40);
      expectFirst(ExactField(field, glm::dvec3(0), view, at), 0, image.distance[i], i, 3'000);
      ++checked;
    }
    EXPECT_GT(checked, 10u);
  }
}

}  // namespace
}  // namespace meniscus

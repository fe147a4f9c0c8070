// The truth for metaballs against closed forms, and against dense sampling in extended precision.

#include "core/reference_tracer.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "tests/support/exact_field.h"
#include "tests/support/kernels.h"

namespace meniscus {
namespace {

using test::alongZ;
using test::bisected;
using test::ExactField;
using test::kKernels;
using test::Real;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

MetaballField fieldOf(const Kernel& kernel, double level, std::vector<Metaball> balls) {
  return {std::move(balls), kernel, level};
}

Metaball ball(glm::vec3 center, float support, float coefficient = 1, std::uint32_t id = 1) {
  return {center, support, coefficient, 0, id};
}

// Distance along the one ray of a view of one pixel.
double distanceOf(const MetaballField& field, const View& view) {
  return traceReference(field, glm::dvec3(0), view).distance.at(0);
}

TEST(ReferenceTracer, OneBallIsASphere) {
  const glm::dvec3 origin(31.5, -12.25, 1000.125);
  for (const Kernel& kernel : kKernels) {
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
      for (const float coefficient : {1.0f, 3.0f}) {
        const MetaballField field = fieldOf(kernel, 0.3, {ball({0.5f, -1, 2}, 3, coefficient, 77)});
        const double radius = 3 * coreShare(kernel, 0.3, static_cast<double>(coefficient));
        const glm::dvec3 center = origin + glm::dvec3(0.5, -1, 2);
        const View view = test::viewOfBall(projection, {48, 40}, center + 0.1, 3);
        const ReferenceImage image = traceReference(field, origin, view);
        const auto exact = [&](double x, double y) {
          return test::exactSphere(test::exactRay(view, {x, y}),
                                   test::exactViewPoint(view, origin, {0.5f, -1, 2}), Real(radius));
        };
        std::size_t hits = 0;
        for (std::size_t i = 0; i < image.distance.size(); ++i) {
          const double x = static_cast<double>(i % 48) + 0.5, y = static_cast<double>(i / 48) + 0.5;
          const auto chord = exact(x, y);
          ASSERT_EQ(image.distance[i] < kInfinity, chord.has_value()) << x << " " << y;
          const bool grazes = exact(x + 0.02, y).has_value() != chord.has_value() ||
                              exact(x - 0.02, y).has_value() != chord.has_value() ||
                              exact(x, y + 0.02).has_value() != chord.has_value() ||
                              exact(x, y - 0.02).has_value() != chord.has_value();
          EXPECT_EQ(image.grazing[i] != 0, grazes) << x << " " << y;
          if (!chord) {
            EXPECT_EQ(image.hits.id[i], 0u);
            EXPECT_EQ(image.hits.normal[i], glm::vec3(0));
            continue;
          }
          ++hits;
          const test::ExactRay ray = test::exactRay(view, {x, y});
          const test::Vec3 normal =
              (ray.origin + chord->in * ray.direction - test::exactViewPoint(view, origin, {0.5f, -1, 2})) /
              Real(radius);
          // A rounding of the radius moves a grazing hit by radius / half chord times as much.
          const double half = static_cast<double>(chord->out - chord->in) / 2;
          EXPECT_NEAR(image.distance[i], static_cast<double>(chord->in), 1e-13 * (1 + radius / half));
          EXPECT_LT(glm::length(glm::dvec3(image.hits.normal[i]) - glm::dvec3(normal)), 2e-7);
          EXPECT_EQ(image.hits.distance[i], static_cast<float>(image.distance[i]));
          EXPECT_EQ(image.hits.id[i], 77u);
          EXPECT_EQ(image.pieces[i], 1u);
        }
        EXPECT_GT(hits, 50u);
        EXPECT_EQ(image.undecidedPixels, 0u);
      }
    }
  }
}

TEST(ReferenceTracer, TwoBallsOnAnAxis) {
  for (const Kernel& kernel : kKernels) {
    for (const double apart : {0.4, 1.0, 1.9}) {
      const auto a = static_cast<float>(apart);
      const double level = 0.2;
      // End on: the sum along the axis.
      const MetaballField along =
          fieldOf(kernel, level, {ball({0, 0, a}, 2, 1, 1), ball({0, 0, -a}, 2, 1, 2)});
      const auto sum = [&](Real z) {
        return test::exactKernel(kernel, 1 - (z - Real(a)) * (z - Real(a)) / 4) +
               test::exactKernel(kernel, 1 - (z + Real(a)) * (z + Real(a)) / 4) - Real(level);
      };
      const double surface = static_cast<double>(bisected(sum, Real(a) + 2, Real(a)));
      EXPECT_NEAR(distanceOf(along, alongZ(0, 0, 10)), 10 - surface, 1e-13) << apart;
      EXPECT_EQ(traceReference(along, glm::dvec3(0), alongZ(0, 0, 10)).hits.id[0], 1u);
      // From the side, through the waist: both balls alike.
      const MetaballField across = fieldOf(kernel, level, {ball({a, 0, 0}, 2), ball({-a, 0, 0}, 2)});
      const double square =
          4 * (1 - kernelInverse(kernel, level / 2)) - static_cast<double>(a) * static_cast<double>(a);
      const double distance = distanceOf(across, alongZ(0, 0, 10));
      if (square < 0) {
        EXPECT_EQ(distance, kInfinity);
      } else {
        EXPECT_NEAR(distance, 10 - std::sqrt(square), 1e-13);
      }
    }
  }
}

TEST(ReferenceTracer, CoincidentBallsAreOneOfTheirSum) {
  for (const Kernel& kernel : kKernels) {
    const View view = test::viewOfBall(Projection::perspective, {24, 24}, glm::dvec3(0), 3);
    const MetaballField many =
        fieldOf(kernel, 0.5, std::vector<Metaball>(1000, ball({0.25f, 0, 0}, 3, 0.125f)));
    const MetaballField one = fieldOf(kernel, 0.5, {ball({0.25f, 0, 0}, 3, 125)});
    const ReferenceImage a = traceReference(many, glm::dvec3(0), view),
                         b = traceReference(one, glm::dvec3(0), view);
    EXPECT_EQ(a.grazing, b.grazing);
    for (std::size_t i = 0; i < a.distance.size(); ++i) {
      ASSERT_EQ(a.distance[i] < kInfinity, b.distance[i] < kInfinity);
      if (a.distance[i] < kInfinity) {
        EXPECT_NEAR(a.distance[i], b.distance[i], 1e-12);
      }
    }
  }
}

// A shell: a ball less a smaller one about the same centre. F depends on the radius alone.
TEST(ReferenceTracer, NegativeCoefficientsMakeACavity) {
  for (const Kernel& kernel : kKernels) {
    const double level = 0.05;
    const MetaballField field =
        fieldOf(kernel, level, {ball({0, 0, 0}, 3, 1, 1), ball({0, 0, 0}, 1.5f, -2, 2)});
    const auto radial = [&](Real r) {
      return test::exactKernel(kernel, 1 - r * r / 9) - 2 * test::exactKernel(kernel, 1 - r * r / 2.25L) -
             Real(level);
    };
    Real inside = 0.5L;  // somewhere in the shell
    while (radial(inside) <= 0) inside += 0.01L;
    const double outer = static_cast<double>(bisected(radial, Real(3), inside));
    const double inner = static_cast<double>(bisected(radial, Real(0), inside));
    const double middle = static_cast<double>(inside);
    EXPECT_NEAR(distanceOf(field, alongZ(0, 0, 10)), 10 - outer, 1e-13);
    EXPECT_NEAR(distanceOf(field, alongZ(0.3, 0.2, 10)), 10 - std::sqrt(outer * outer - 0.13), 1e-13);
    // From the cavity: its far wall, entered from inside.
    EXPECT_NEAR(distanceOf(field, alongZ(0, 0, 0)), inner, 1e-13);
    EXPECT_NEAR(distanceOf(field, alongZ(0.1, 0, 0.125)), 0.125 + std::sqrt(inner * inner - 0.01), 1e-13);
    // From within the shell: out into the cavity. From the far half of the shell: out of it all.
    const ReferenceImage image = traceReference(field, glm::dvec3(0), alongZ(0, 0, middle));
    EXPECT_NEAR(image.distance[0], middle - inner, 1e-13);
    EXPECT_NEAR(image.hits.normal[0].z, 1, 1e-6);
    EXPECT_EQ(image.hits.id[0], 1u);
    EXPECT_NEAR(distanceOf(field, alongZ(0, 0, -middle)), outer - middle, 1e-13);
  }
}

// Two balls about one centre with F = -10 (r^2 - 2)^2 + 140 - T for r < 2, all numbers exact in float32: at
// T = 140 a double root all around, at a little less a thin shell, at a little more nothing.
TEST(ReferenceTracer, DoubleRootsAreGrazingMisses) {
  MetaballField field =
      fieldOf({KernelShape::quartic}, 140, {ball({0, 0, 0}, 3, 324), ball({0, 0, 0}, 2, -224)});
  const View view = alongZ(0, 0, 10);
  ReferenceImage image = traceReference(field, glm::dvec3(0), view);
  EXPECT_EQ(image.distance[0], kInfinity);
  EXPECT_EQ(image.grazing[0], 1);
  EXPECT_EQ(image.undecidedPixels, 1u);
  for (const double gap : {1.0, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10}) {
    field.level = 140 - gap;
    image = traceReference(field, glm::dvec3(0), view);
    const double outer = std::sqrt(2 + std::sqrt(gap / 10)), inner = std::sqrt(2 - std::sqrt(gap / 10));
    // dF/dr there is 40 r sqrt(gap / 10); F is known to about 1e-12.
    EXPECT_NEAR(image.distance[0], 10 - outer, 1e-14 + 1e-13 / std::sqrt(gap)) << gap;
    EXPECT_EQ(image.undecidedPixels, 0u) << gap;
    // From within the shell, and from the hollow in its middle.
    const double between = std::sqrt(2.0);
    EXPECT_NEAR(distanceOf(field, alongZ(0, 0, between)), between - inner, 1e-14 + 1e-13 / std::sqrt(gap))
        << gap;
    EXPECT_NEAR(distanceOf(field, alongZ(0, 0, 0)), inner, 1e-14 + 1e-13 / std::sqrt(gap)) << gap;
    field.level = 140 + gap;
    image = traceReference(field, glm::dvec3(0), view);
    EXPECT_EQ(image.distance[0], kInfinity) << gap;
    EXPECT_EQ(image.undecidedPixels, 0u) << gap;
  }
}

// w^2 = 9/16 at the radius 1 of a support of 2: the ray at 1 Å touches, exactly.
TEST(ReferenceTracer, TangentRaysFlip) {
  const MetaballField field = fieldOf({KernelShape::quartic}, 0.5625, {ball({0, 0, 0}, 2)});
  const auto traced = [&](double x) { return traceReference(field, glm::dvec3(0), alongZ(x, 0, 10, 1)); };
  EXPECT_EQ(traced(1).distance[0], kInfinity);
  EXPECT_EQ(traced(1).grazing[0], 1);
  for (const double off : {1e-3, 1e-6, 1e-9, 1e-12}) {
    EXPECT_LT(traced(1 - off).distance[0], 10) << off;
    EXPECT_NEAR(traced(1 - off).distance[0], 10 - std::sqrt(off * (2 - off)), 3e-16 / std::sqrt(off) + 1e-14)
        << off;
    EXPECT_EQ(traced(1 + off).distance[0], kInfinity) << off;
    EXPECT_EQ(traced(1 - off).grazing[0], 1) << off;
    EXPECT_EQ(traced(1 + off).grazing[0], 1) << off;
  }
  EXPECT_EQ(traced(1 - 0.0201).grazing[0], 0);
  EXPECT_EQ(traced(1 + 0.0201).grazing[0], 0);
  EXPECT_EQ(traced(1 - 0.0199).grazing[0], 1);
  EXPECT_EQ(traced(1 + 0.0199).grazing[0], 1);
}

// A small ball in front of a large one: at its edge the moved ray hits the other.
TEST(ReferenceTracer, AnotherSheetIsGrazing) {
  const MetaballField field =
      fieldOf({KernelShape::quartic}, 0.5625, {ball({0, 0, 9}, 2, 1, 1), ball({0, 0, 0}, 8, 1, 2)});
  const auto traced = [&](double x) { return traceReference(field, glm::dvec3(0), alongZ(x, 0, 20, 0.1)); };
  // Where the small one begins to blend with the large one nothing jumps: 9 - 2 is within the support of 8,
  // so its edge is found by bisection.
  double low = 0, high = 3;
  for (int i = 0; i < 60; ++i) {
    const double x = (low + high) / 2;
    (traced(x).hits.id[0] == 1 ? low : high) = x;
  }
  const double front = traced(low).distance[0], back = traced(high).distance[0];
  EXPECT_GT(back - front, 1);
  EXPECT_EQ(traced(low - 0.0019).grazing[0], 1);
  EXPECT_EQ(traced(low + 0.0019).grazing[0], 1);
  EXPECT_EQ(traced(low - 0.0021).grazing[0], 0);
  EXPECT_EQ(traced(low + 0.0021).grazing[0], 0);
  EXPECT_EQ(traced(0).grazing[0], 0);
}

TEST(ReferenceTracer, FromInsideItIsTheExit) {
  const MetaballField field = fieldOf({KernelShape::sextic}, 0.5, {ball({0, 0, 0}, 4, 1, 5)});  // radius 2
  for (const double z : {1.9, 0.5, 0.0, -1.5}) {
    const ReferenceImage image = traceReference(field, glm::dvec3(0), alongZ(0, 0, z));
    EXPECT_NEAR(image.distance[0], z + 2, 1e-14) << z;
    EXPECT_EQ(image.hits.normal[0], glm::vec3(0, 0, 1)) << z;
    EXPECT_EQ(image.hits.id[0], 5u);
    EXPECT_EQ(image.grazing[0], 0);
  }
  EXPECT_NEAR(distanceOf(field, alongZ(0, 0, 2.5)), 0.5, 1e-14);  // inside the support, outside the surface
  EXPECT_EQ(distanceOf(field, alongZ(0, 0, -2.5)), kInfinity);
  EXPECT_EQ(distanceOf(field, alongZ(0, 0, -5)), kInfinity);

  // The eye inside, and a near plane that cuts the ball in front of the eye.
  View view = test::viewOfBall(Projection::perspective, {16, 12}, glm::dvec3(0), 2);
  view.distance = 1;
  view.nearZ = 1 - 1e-6;
  const ReferenceImage inside = traceReference(field, glm::dvec3(0), view);
  view.distance = 6;
  view.nearZ = 0.75;
  const ReferenceImage cut = traceReference(field, glm::dvec3(0), view);
  std::size_t exits = 0;
  for (std::size_t i = 0; i < inside.distance.size(); ++i) {
    const glm::dvec2 pixel(static_cast<double>(i % 16) + 0.5, static_cast<double>(i / 16) + 0.5);
    View eye = view;
    eye.distance = 1;
    const auto near = test::exactSphere(test::exactRay(eye, pixel), test::Vec3(0), 2);
    EXPECT_NEAR(inside.distance[i], static_cast<double>(near->out), 1e-13);
    const test::ExactRay ray = test::exactRay(view, pixel);
    const auto chord = test::exactSphere(ray, test::Vec3(0), 2);
    const Real plane = (Real(view.distance) - Real(view.nearZ)) / -ray.direction.z;
    if (!chord || chord->out < plane) {
      EXPECT_EQ(cut.distance[i], kInfinity);
    } else {
      EXPECT_LT(chord->in, plane);
      EXPECT_NEAR(cut.distance[i], static_cast<double>(chord->out), 1e-13);
      ++exits;
    }
  }
  EXPECT_GT(exits, 20u);
}

TEST(ReferenceTracer, NothingAboveTheMaximum) {
  for (const Kernel& kernel : kKernels) {
    std::vector<Metaball> balls(7, ball({0, 0, 0}, 2, 0.5f));
    balls.push_back(ball({1, 0, 0}, 2, -0.5f));
    const View view = test::viewOfBall(Projection::perspective, {16, 16}, glm::dvec3(0), 2);
    for (const double level : {3.5000001, 4.0, 1e6}) {
      const ReferenceImage image = traceReference(fieldOf(kernel, level, balls), glm::dvec3(0), view);
      for (std::size_t i = 0; i < image.distance.size(); ++i) {
        EXPECT_EQ(image.distance[i], kInfinity);
        EXPECT_EQ(image.grazing[i], 0);
      }
    }
    const ReferenceImage none = traceReference(fieldOf(kernel, 0.5, {}), glm::dvec3(0), view);
    EXPECT_EQ(none.distance, std::vector<double>(256, kInfinity));
  }
}

TEST(ReferenceTracer, TheNearestOfSeveralFields) {
  const std::vector<MetaballField> fields{
      fieldOf({KernelShape::sextic}, 0.5, {ball({0, 0, 0}, 4, 1, 1)}),
      fieldOf({KernelShape::quartic}, 0.5625, {ball({1, 0, 1.5f}, 3, 1, 2)}),
      fieldOf({KernelShape::power, 7}, 0.3, {ball({-1, 0.5f, 1}, 3, 1, 3)})};
  View view = test::viewOfBall(Projection::perspective, {40, 30}, glm::dvec3(0), 2.5);
  const ReferenceImage all = traceReference(std::span(fields), glm::dvec3(0), view);
  std::array<std::size_t, 4> seen{};
  std::array<ReferenceImage, 3> single;
  for (std::size_t f = 0; f < 3; ++f) single[f] = traceReference(fields[f], glm::dvec3(0), view);
  for (std::size_t i = 0; i < all.distance.size(); ++i) {
    double nearest = kInfinity;
    std::uint32_t id = 0;
    for (const ReferenceImage& image : single) {
      if (image.distance[i] >= nearest) continue;
      nearest = image.distance[i];
      id = image.hits.id[i];
    }
    EXPECT_TRUE(all.distance[i] == nearest || std::abs(all.distance[i] - nearest) < 1e-12);
    EXPECT_EQ(all.hits.id[i], id);
    ++seen[id];
  }
  for (const std::size_t count : seen) EXPECT_GT(count, 10u);
}

TEST(ReferenceTracer, WhatIsNoNumberIsRefused) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(distanceOf(fieldOf({}, 0.5, {ball({0, nan, 0}, 4)}), alongZ(0, 0, 1)), InputError);
  EXPECT_THROW(distanceOf(fieldOf({}, 0.5, {ball({0, 0, 0}, nan)}), alongZ(0, 0, 1)), InputError);
  EXPECT_THROW(distanceOf(fieldOf({}, 0, {ball({0, 0, 0}, 4)}), alongZ(0, 0, 1)), InputError);
  EXPECT_THROW(distanceOf(fieldOf({KernelShape::power, 17}, 0.5, {ball({0, 0, 0}, 4)}), alongZ(0, 0, 1)),
               InputError);
}

}  // namespace
}  // namespace meniscus

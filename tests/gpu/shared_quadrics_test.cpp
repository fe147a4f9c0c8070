// shared/octahedral.glsl and shared/quadrics.glsl on the GPU against the same text as C++ in float32 and in
// double: directions as stored, rays against spheres and cylinders, tangent, end-on, parallel, not a number.
// The tolerances are derived in shared_math_cells.h.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "tests/gpu/shared_math_cells.h"
#include "tests/support/gl_fixture.h"

namespace meniscus {
namespace {

using namespace test;

class SharedQuadrics : public test::GlTest {};

TEST_F(SharedQuadrics, NormalsInOctahedra) {
  const Generator normal = [](Random& random, std::size_t i) {
    Inputs out;
    glm::vec3 n(random.direction());
    if (i % 5 == 0) n[static_cast<int>(i / 5 % 3)] = 0;
    if (i % 7 == 0) n = glm::vec3(i % 2 == 0 ? 1 : -1, 0, 0);
    if (i % 11 == 0) n = glm::vec3(0, 0, i % 2 == 0 ? 1 : -1);
    append(out, n);
    return out;
  };
  expectConditioned(MENISCUS_SHARED_CALL(callEncodeNormal), 20, normal, {.groups = {{0, 2}}});
  expectConditioned(MENISCUS_SHARED_CALL(callDecodeNormal), 21,
                    [](Random& random, std::size_t i) {
                      // all 16-bit values, as stored; the edges of the square, too
                      const auto stored = [&](std::size_t part) {
                        if (i % 9 == part) return static_cast<float>(random.index(2));
                        return static_cast<float>(random.index(65536)) / 65535.0f;
                      };
                      return Inputs{stored(0), stored(1)};
                    },
                    {.groups = {{0, 3}}});
  const Results signs =
      evaluate(MENISCUS_SHARED_CALL(callAwayFromZero), 22, [](Random& random, std::size_t i) {
        return Inputs{static_cast<float>(i < 2 ? (i == 0 ? 0.0 : -0.0) : random.signedLog(1e-30, 1e30))};
      });
  for (std::size_t i = 0; i < signs.gpu.size(); ++i) ASSERT_EQ(signs.gpu[i].out_[0], signs.single[i].out_[0]);
}

const std::vector<std::pair<std::size_t, std::size_t>> kChordGroups{{1, 3}, {4, 3}, {7, 3}, {10, 3}};

// A ray that passes the centre at `offset` radii, as rayPoint() gives it: in the plane of the centre, or the
// eye.
void appendRay(Inputs& out, Random& random, double radius, double offset) {
  const glm::dvec3 direction = random.direction();
  const glm::dvec3 aside = glm::normalize(glm::cross(direction, random.direction()));
  const double before =
      random.index(3) == 0 ? 2 * radius * random.uniform(-1, 1) : random.uniform(-0.1, 0.1) * radius;
  append(out, glm::vec3(aside * offset * radius - before * direction));
  append(out, glm::vec3(direction));
}

TEST_F(SharedQuadrics, ChordsOfSpheres) {
  expectConditioned(MENISCUS_SHARED_CALL(callSphereChord), 60,
                    [](Random& random, std::size_t i) {
                      Inputs out;
                      const double radius = random.logUniform(1e-3, 1e3);
                      const double graze = 1 + random.signedLog(1e-5, 1e-2);  // tangent, nearly
                      appendRay(out, random, radius, i % 4 == 0 ? graze : random.uniform(0, 1.3));
                      out.push_back(static_cast<float>(radius));
                      return out;
                    },
                    {.groups = kChordGroups, .flag = true});
  expectConditioned(
      MENISCUS_SHARED_CALL(callMissedChord), 61, [](Random&, std::size_t) { return Inputs{}; },
      {.groups = kChordGroups, .flag = true}, 10);
}

TEST_F(SharedQuadrics, ChordsOfCylinders) {
  expectConditioned(
      MENISCUS_SHARED_CALL(callCylinderChord), 62,
      [](Random& random, std::size_t i) {
        Inputs out;
        const double radius = random.logUniform(1e-3, 1e3), half = radius * random.logUniform(0.1, 20);
        appendRay(out, random, std::max(radius, i % 2 == 0 ? half : radius), random.uniform(0, 1.2));
        const glm::dvec3 direction(out[3], out[4], out[5]);
        glm::dvec3 axis = random.direction();
        if (i % 4 == 0) axis = glm::normalize(direction + random.direction() * random.logUniform(1e-4, 0.1));
        if (i % 9 == 0) axis = glm::normalize(glm::cross(direction, random.direction()));  // across
        append(out, glm::vec3(axis));
        out.push_back(static_cast<float>(half));
        out.push_back(static_cast<float>(radius));
        return out;
      },
      {.groups = kChordGroups, .flag = true});
}

TEST_F(SharedQuadrics, ChordsOfEllipsoids) {
  expectConditioned(MENISCUS_SHARED_CALL(callEllipsoidChord), 63,
                    [](Random& random, std::size_t i) {
                      Inputs out;
                      const double longest = random.logUniform(1e-3, 1e3), thinnest = i % 3 == 0 ? 1e-4 : 0.1;
                      const glm::dvec3 radii(longest, longest * random.logUniform(thinnest, 1),
                                             longest * random.logUniform(thinnest, 1));
                      // Half of the rays aim at the thickness, half at the length.
                      appendRay(out, random, i % 2 == 0 ? longest : std::min(radii.y, radii.z),
                                random.uniform(0, 1.2));
                      const glm::dmat3 turn = glm::mat3_cast(random.rotation());
                      for (int k = 0; k < 3; ++k) append(out, glm::vec3(turn[k]));
                      append(out, glm::vec3(radii));
                      return out;
                    },
                    {.groups = kChordGroups, .flag = true});
}

// Degenerate rays whose chords are exact numbers.
TEST_F(SharedQuadrics, NamedEdgesOfChords) {
  const std::vector<Inputs> spheres{{0, 0, 0, 0, 0, -1, 3},                   // through the centre
                                    {1, 0, 0, 0, 0, -1, 1},                   // tangent: hits
                                    {2, 0, 0, 0, 0, -1, 1},                   // beside
                                    {0, 0, 8, 0, 0, -1, 2},                   // from the front
                                    {0, 0, 0, 0, 0, -1, 1e-12f},              // tiny
                                    {0, 0, 0, 0, 0, -1, 1e15f}};              // huge
  const std::vector<Inputs> cylinders{{0.5f, 0, 0, 0, 0, -1, 0, 0, 1, 2, 1},  // end-on
                                      {1.5f, 0, 0, 0, 0, -1, 0, 0, 1, 2, 1},  // parallel, beside
                                      {1, 0, 0, 0, 0, -1, 0, 0, 1, 2, 1},     // parallel, on the side
                                      {0, 0, 1, 1, 0, 0, 0, 0, 1, 2, 1},      // across
                                      {0, 0, 2, 1, 0, 0, 0, 0, 1, 2, 1},      // along the cap
                                      {0, 0, 2.5f, 1, 0, 0, 0, 0, 1, 2, 1},   // above the cap
                                      {0, 1, 0, 1, 0, 0, 0, 0, 1, 2, 1},      // tangent to the side
                                      {0, 0, 0, 0, 0, -1, 0, 0, -1, 2, 1}};   // through the middle
  const std::vector<Inputs> ellipsoids{
      {0, 0, 0, 0, 0, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1, 3, 2, 1},        // through the centre
      {3, 0, 0, 0, 0, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1, 3, 2, 1},        // tangent: hits
      {0, 2.5f, 0, 0, 0, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1, 3, 2, 1},     // beside
      {0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 8192, 1, 0.5f}};  // a needle, end-on
  const auto expectSame = [](const SharedCall& call, const std::vector<Inputs>& cases) {
    const Results r = evaluate(
        call, 1, [&](Random&, std::size_t i) { return cases[i]; }, cases.size());
    for (std::size_t i = 0; i < cases.size(); ++i) {
      for (std::size_t k = 0; k < 13; ++k) {
        EXPECT_EQ(r.gpu[i].out_[k], r.single[i].out_[k]) << call.name << " case " << i << " output " << k;
        EXPECT_FLOAT_EQ(r.gpu[i].out_[k], static_cast<float>(r.twice[i].out_[k]))
            << call.name << " case " << i;
      }
    }
  };
  expectSame(MENISCUS_SHARED_CALL(callSphereChord), spheres);
  expectSame(MENISCUS_SHARED_CALL(callCylinderChord), cylinders);
  expectSame(MENISCUS_SHARED_CALL(callEllipsoidChord), ellipsoids);
}

// GLSL does not promise NaN, but the formulas are written so that a driver that has it misses. Directions and
// axes are of unit length by contract, half lengths are tested before (quadrics/cylinder.vert).
TEST_F(SharedQuadrics, WhatIsNotANumberIsMissed) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto expectMisses = [&](const SharedCall& call, const Inputs& hit,
                                const std::vector<std::size_t>& places) {
    const Results r = evaluate(
        call, 1,
        [&](Random&, std::size_t i) {
          Inputs inputs = hit;
          if (i > 0) inputs[places[i - 1]] = nan;
          return inputs;
        },
        places.size() + 1);
    for (std::size_t i = 0; i < r.gpu.size(); ++i) {
      const float expected = i == 0 ? 1.0f : 0.0f;
      EXPECT_EQ(r.single[i].out_[0], expected) << call.name << " as C++, case " << i;
      EXPECT_EQ(r.gpu[i].out_[0], expected) << call.name << " as GLSL, case " << i;
    }
  };
  expectMisses(MENISCUS_SHARED_CALL(callSphereChord), {0.1f, 0.2f, 0, 0, 0, -1, 2}, {0, 1, 2, 6});
  expectMisses(MENISCUS_SHARED_CALL(callCylinderChord), {0.1f, 0.2f, 0, 0.6f, 0, -0.8f, 0, 0.8f, 0.6f, 3, 2},
               {0, 1, 2, 10});
  expectMisses(MENISCUS_SHARED_CALL(callEllipsoidChord),
               {0.1f, 0.2f, 0, 0.6f, 0, -0.8f, 1, 0, 0, 0, 1, 0, 0, 0, 1, 3, 2, 1}, {0, 1, 2, 15, 16, 17});
}

}  // namespace
}  // namespace meniscus

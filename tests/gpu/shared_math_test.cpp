// shaders/shared/ on the GPU against the same text as C++ in float32 and in double, function by function:
// random inputs over many magnitudes, and the edges (zero, negative, huge, tiny, tangent, end-on, parallel).
// The tolerances are derived in shared_math_cells.h.

#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <string>

#include "render/view_block.h"
#include "shaders/embedded_shaders.h"
#include "tests/gpu/shared_math_cells.h"
#include "tests/support/gl_fixture.h"

namespace meniscus {
namespace {

using namespace test;

constexpr double kSplitBits = 0x1p-44;  // double_float.glsl
constexpr double kProjectedBits =
    0x1p-33;  // dotRow(): cross terms below 2^-12 of the whole, 8 roundings of 2^-24
constexpr std::size_t kViewFloats = 44;
const std::vector<float> kEdges{0.0f,   -0.0f,   1.0f,  -1.0f,  0.5f,    3.0f,
                                1e-30f, -1e-30f, 1e30f, -1e30f, 4097.0f, 0.1f};

// A number of any magnitude, or in the first rows each pair of edges.
float number(Random& random, std::size_t i, std::size_t which) {
  if (i < kEdges.size() * kEdges.size())
    return kEdges[which == 0 ? i % kEdges.size() : i / kEdges.size() % kEdges.size()];
  return static_cast<float>(random.signedLog(1e-6, 1e6));
}

void appendSplit(Inputs& out, double x) {
  const auto hi = static_cast<float>(x);
  out.push_back(hi);
  out.push_back(static_cast<float>(x - static_cast<double>(hi)));
}

// A split number whose lo is random, not the remainder of an edge.
void appendNumberSplit(Inputs& out, Random& random, std::size_t i, std::size_t which) {
  const float hi = number(random, i, which);
  appendSplit(out, static_cast<double>(hi) * (1 + random.uniform(-1, 1) * 0x1p-25));
}

class SharedMath : public test::GlTest {};

TEST_F(SharedMath, EveryFunctionIsTested) {
  const std::string calls = test::sharedCallsText();
  for (const EmbeddedShader& shader : embeddedShaders()) {
    if (!shader.path.starts_with("shared/") || !shader.path.ends_with(".glsl")) continue;
    for (std::size_t at = shader.text.find("\nFN "); at != std::string_view::npos;
         at = shader.text.find("\nFN ", at + 1)) {
      const std::size_t end = shader.text.find('(', at), begin = shader.text.rfind(' ', end) + 1;
      std::string name(shader.text.substr(begin, end - begin));
      name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
      EXPECT_NE(calls.find("call" + name + "("), std::string::npos)
          << shader.path << ": " << name << " has no test";
    }
  }
}

TEST_F(SharedMath, SumsOfTwoNumbersAreExact) {
  const Generator two = [](Random& random, std::size_t i) {
    return Inputs{number(random, i, 0), number(random, i, 1)};
  };
  // Exact: what is left is the rounding of the sum in double.
  const PairSize sum = [](const f64::Cell& c, std::size_t) {
    return std::abs(c.in_[0]) + std::abs(c.in_[1]);
  };
  expectPairs(MENISCUS_SHARED_CALL(callTwoSum), 1, two, 1, 0x1p-52, sum);
  expectPairs(MENISCUS_SHARED_CALL(callMakeSplit), 2, two, 1, 0x1p-52, sum);
  expectPairs(MENISCUS_SHARED_CALL(callNegateSplit), 3, two, 1, 0x1p-52, sum);
}

TEST_F(SharedMath, ProductsOfTwoNumbersAreExact) {
  const Generator two = [](Random& random, std::size_t i) {
    return Inputs{number(random, i, 0), number(random, i, 1)};
  };
  expectPairs(MENISCUS_SHARED_CALL(callTwoProduct), 4, two, 1, 0x1p-52,
              [](const f64::Cell& c, std::size_t) { return std::abs(c.in_[0] * c.in_[1]); });
}

TEST_F(SharedMath, UpperHalfKeepsTwelveBits) {
  const SharedCall call = MENISCUS_SHARED_CALL(callUpperHalf);
  const Results r =
      evaluate(call, 5, [](Random& random, std::size_t i) { return Inputs{number(random, i, 0)}; });
  for (std::size_t i = 0; i < r.gpu.size(); ++i) {
    const float a = r.gpu[i].in_[0], upper = r.gpu[i].out_[0];
    ASSERT_EQ(upper, r.single[i].out_[0]) << a;
    ASSERT_LE(std::abs(a - upper), 0x1p-12f * std::abs(a)) << a;
    int exponent = 0;
    const double bits = std::frexp(static_cast<double>(upper), &exponent) * 4096;
    ASSERT_EQ(bits, std::round(bits)) << a;
  }
}

TEST_F(SharedMath, SplitArithmeticKeepsFortyFourBits) {
  const Generator two = [](Random& random, std::size_t i) {
    Inputs out;
    appendNumberSplit(out, random, i, 0);
    appendNumberSplit(out, random, i, 1);
    return out;
  };
  const auto a = [](const f64::Cell& c) { return c.in_[0] + c.in_[1]; };
  const auto b = [](const f64::Cell& c) { return c.in_[2] + c.in_[3]; };
  expectPairs(MENISCUS_SHARED_CALL(callAddSplit), 6, two, 1, kSplitBits,
              [=](const f64::Cell& c, std::size_t) { return std::abs(a(c)) + std::abs(b(c)); });
  expectPairs(MENISCUS_SHARED_CALL(callMultiplySplit), 7, two, 1, kSplitBits,
              [=](const f64::Cell& c, std::size_t) { return std::abs(a(c) * b(c)); });
  expectPairs(
      MENISCUS_SHARED_CALL(callSqrtSplit), 8,
      [](Random& random, std::size_t i) {
        Inputs out;
        appendSplit(out, i < 12 ? std::abs(static_cast<double>(kEdges[i])) : random.logUniform(1e-12, 1e12));
        return out;
      },
      1, kSplitBits, [=](const f64::Cell& c, std::size_t) { return std::sqrt(std::abs(a(c))); });
  expectPairs(
      MENISCUS_SHARED_CALL(callQuotient), 9,
      [](Random& random, std::size_t) {
        Inputs out;
        appendSplit(out, random.signedLog(1e-6, 1e6));
        appendSplit(out, random.signedLog(1e-6, 1e6));
        return out;
      },
      1, kSplitBits, [=](const f64::Cell& c, std::size_t) { return std::abs(a(c) / b(c)); });
}

// A view of something of size `extent` at `distance`, as a uniform block; cameras within it included.
struct PlacedView {
  View view;
  f32::ViewBlock block;
  double extent = 1;
};

PlacedView randomView(Random& random) {
  PlacedView v;
  v.extent = random.logUniform(1, 1e3);
  Camera camera;
  camera.projection = random.index(2) == 0 ? Projection::orthographic : Projection::perspective;
  camera.orientation = random.rotation();
  camera.target = random.inBox(v.extent);
  camera.distance = random.logUniform(0.1 * v.extent, 1e4);
  camera.fovY = random.logUniform(0.01, 2);
  v.view = makeView(camera, {1920, 1080}, {{0, 0, 0}, 2 * v.extent});
  v.block = makeViewBlock(v.view, {0, 0, 0}, {0, 0, 1920, 1080}, {0.25f, -0.125f});
  return v;
}

Inputs viewInputs(const PlacedView& v) {
  static_assert(sizeof(f32::ViewBlock) == kViewFloats * sizeof(float));
  const auto* floats = reinterpret_cast<const float*>(&v.block);
  return {floats, floats + kViewFloats};
}

bool isPerspective(const f64::Cell& c) {
  return c.in_[26] > 0.5;
}

// |row| . |point| + |translation|: what the roundings of dotRow() are relative to.
double rowSize(const f64::Cell& c, std::size_t row) {
  double sum = std::abs(c.in_[4 * row + 3]);
  for (std::size_t k = 0; k < 3; ++k)
    sum += std::abs(c.in_[4 * row + k]) * (std::abs(c.in_[44 + k]) + std::abs(c.in_[47 + k]));
  return sum;
}

const Generator kViewAndPoint = [](Random& random, std::size_t i) {
  const PlacedView v = randomView(random);
  Inputs out = viewInputs(v);
  const glm::vec3 p = i % 50 == 0 ? glm::vec3(0) : glm::vec3(random.inBox(v.extent));
  append(out, p);
  append(out, glm::vec3(random.inBox(1)) * p * 0x1p-25f);
  return out;
};

TEST_F(SharedMath, ProjectionOfPointsKeepsThirtyThreeBits) {
  expectPairs(
      MENISCUS_SHARED_CALL(callDotRow), 10,
      [](Random& random, std::size_t i) {
        Inputs out = kViewAndPoint(random, i);
        for (std::size_t k = 44; k < 47; ++k) {
          const float upper = f32::upperHalf(out[k]);
          out[k + 3] += out[k] - upper;
          out[k] = upper;
        }
        return out;
      },
      1, kProjectedBits, [](const f64::Cell& c, std::size_t) { return rowSize(c, 0); });
  expectPairs(MENISCUS_SHARED_CALL(callTransformPoint), 11, kViewAndPoint, 3, kProjectedBits, rowSize);
  expectPairs(
      MENISCUS_SHARED_CALL(callDepthOf), 12,
      [](Random& random, std::size_t) {
        const PlacedView v = randomView(random);
        Inputs out = viewInputs(v);
        appendSplit(out, random.uniform(-v.extent, v.extent));
        return out;
      },
      1, kSplitBits,
      [](const f64::Cell& c, std::size_t) { return std::abs(c.in_[32]) + std::abs(c.in_[44]); });
}

TEST_F(SharedMath, ProjectedCentresAndRangesKeepThirtyTwoBits) {
  const auto depthSize = [](const f64::Cell& c) { return rowSize(c, 2) + std::abs(c.in_[32]); };
  // Outputs: pixel x, pixel y, then single numbers: view x, y, z, depth, each rounded to float32 about four
  // times.
  const PairSize size = [=](const f64::Cell& c, std::size_t p) {
    if (p >= 2) {
      const double roundings = 4 * 0x1p-24 / (2 * kProjectedBits) * std::abs(c.out_[2 * p]);
      return roundings + (p < 4 ? rowSize(c, p - 2) * c.in_[24] : depthSize(c));
    }
    const double depth = c.out_[10], center = std::abs(c.in_[28 + p]);
    if (!isPerspective(c)) return rowSize(c, p) + center;
    if (depth <= 0) return 1e30;  // projection.glsl: meaningless
    return rowSize(c, p) / depth * (1 + depthSize(c) / depth) + center;
  };
  expectPairs(MENISCUS_SHARED_CALL(callProjectCenter), 13, kViewAndPoint, 6, 2 * kProjectedBits, size);
  expectPairs(MENISCUS_SHARED_CALL(callCenterRange), 14, kViewAndPoint, 1, 4 * kProjectedBits,
              [=](const f64::Cell& c, std::size_t) {
                return (rowSize(c, 0) + rowSize(c, 1)) * c.in_[24] + depthSize(c) + std::abs(c.in_[34]);
              });
}

// Where a function cancels on purpose (pixel minus projected pixel) its inputs are taken as they are.
Shape vectorAt(std::size_t first) {
  return {.groups = {{first, 3}}};
}

Generator withView(const std::function<void(Random&, const PlacedView&, Inputs&)>& more) {
  return [more](Random& random, std::size_t) {
    const PlacedView v = randomView(random);
    Inputs out = viewInputs(v);
    more(random, v, out);
    return out;
  };
}

TEST_F(SharedMath, RaysOfAView) {
  const auto pixel = [](Random& random, const PlacedView&, Inputs& out) {
    out.push_back(static_cast<float>(random.index(1920)) + 0.75f);
    out.push_back(static_cast<float>(random.index(1080)) + 0.375f);
  };
  const auto view = [](std::size_t k) { return k < kViewFloats; };
  expectConditioned(MENISCUS_SHARED_CALL(callIsPerspective), 30, withView(pixel),
                    {.groups = {}, .flag = true});
  // The flag and the optical axis are exact numbers; pixels are, too.
  const auto exact = [=](std::size_t k) { return !view(k) || k == 28 || k == 29; };
  expectConditioned(MENISCUS_SHARED_CALL(callRayDirection), 31, withView(pixel),
                    {.groups = {{0, 3}}, .exact = exact});
  expectConditioned(MENISCUS_SHARED_CALL(callTurn), 32,
                    withView([](Random& random, const PlacedView&, Inputs& out) {
                      append(out, glm::vec3(random.direction() * random.logUniform(1e-3, 1e3)));
                    }),
                    vectorAt(0));
  expectConditioned(MENISCUS_SHARED_CALL(callNearEye), 33,
                    withView([](Random& random, const PlacedView&, Inputs& out) {
                      out.push_back(static_cast<float>(random.signedLog(1e-2, 1e4)));
                      out.push_back(static_cast<float>(random.logUniform(1e-2, 1e4)));
                    }),
                    {.groups = {}, .flag = true});
  expectConditioned(MENISCUS_SHARED_CALL(callRayPoint), 34,
                    withView([=](Random& random, const PlacedView& v, Inputs& out) {
                      pixel(random, v, out);
                      for (int k = 0; k < 2; ++k) {  // projected centre: up to some pixels beside, and its lo
                        out.push_back(out[kViewFloats + static_cast<std::size_t>(k)] +
                                      static_cast<float>(random.signedLog(1e-4, 100)));
                      }
                      for (int k = 0; k < 2; ++k)
                        out.push_back(static_cast<float>(random.uniform(-1, 1) * 0x1p-15));
                      append(out, glm::vec3(random.inBox(v.extent)));
                      out.push_back(static_cast<float>(random.logUniform(0.1, 1e4)));
                      out.push_back(static_cast<float>(random.index(2)));
                    }),
                    {.groups = {{0, 3}}, .exact = [](std::size_t k) { return k >= 44 && k < 50; }});
}

TEST_F(SharedMath, DepthsAndDistances) {
  expectConditioned(MENISCUS_SHARED_CALL(callViewPoint), 42,
                    withView([](Random& random, const PlacedView&, Inputs& out) {
                      out.push_back(static_cast<float>(random.index(1920)) + 0.5f);
                      out.push_back(static_cast<float>(random.index(1080)) + 0.5f);
                      out.push_back(static_cast<float>(random.uniform(0, 1)));
                    }),
                    {.groups = {{0, 3}},
                     .exact = [](std::size_t k) { return k >= 44 || k == 28 || k == 29; },
                     .size = [](const f64::Cell& c) { return std::abs(c.in_[32]) + std::abs(c.in_[35]); }});
  expectConditioned(MENISCUS_SHARED_CALL(callDepthValue), 40,
                    withView([](Random& random, const PlacedView& v, Inputs& out) {
                      out.push_back(static_cast<float>(random.uniform(v.view.farZ, v.view.nearZ)));
                    }),
                    {.groups = {{0, 1}}});
  expectConditioned(MENISCUS_SHARED_CALL(callRayDistance), 41,
                    withView([](Random& random, const PlacedView& v, Inputs& out) {
                      const glm::vec3 center(random.inBox(v.extent));
                      append(out, center);
                      const glm::dvec3 fromEye = glm::dvec3(center) - glm::dvec3(0, 0, v.view.distance);
                      appendSplit(out, v.view.projection == Projection::perspective
                                           ? glm::length(fromEye)
                                           : v.view.nearZ - static_cast<double>(center.z));
                      append(out, glm::vec3(random.direction() * random.logUniform(1e-3, 10)));
                    }),
                    {.groups = {{0, 1}}});
}

TEST_F(SharedMath, ExtentsOfProjectedDiscsAndSpheres) {
  expectConditioned(MENISCUS_SHARED_CALL(callProjectedExtent), 50,
                    withView([](Random& random, const PlacedView&, Inputs& out) {
                      const double depth = random.signedLog(0.1, 1e4);
                      // far away, close by, and round the eye
                      const double radius = std::abs(depth) * random.logUniform(1e-6, 3);
                      const glm::dvec3 axis = random.index(2) == 0 ? glm::dvec3(0.0) : random.direction();
                      out.push_back(static_cast<float>(random.signedLog(1e-4, 3)));
                      out.push_back(static_cast<float>(depth));
                      out.push_back(static_cast<float>(radius));
                      out.push_back(static_cast<float>(axis.x));
                      out.push_back(static_cast<float>(axis.z));
                    }),
                    {.groups = {{1, 2}}, .flag = true});
}

TEST_F(SharedMath, ExtentsOfProjectedEllipsoids) {
  // Balls, discs and needles: components along the screen direction and along z.
  const auto axes = [](Random& random, glm::dvec3& x, glm::dvec3& z) {
    const glm::dmat3 turn = glm::transpose(glm::mat3_cast(random.rotation()));
    const glm::dvec3 shares(1, random.logUniform(1e-4, 1), random.logUniform(1e-4, 1));
    x = turn[0] * shares;
    z = turn[2] * shares;
  };
  const auto place = [](Random& random, Inputs& out) {
    const double depth = random.signedLog(0.1, 1e4);
    out.push_back(static_cast<float>(depth));
    out.push_back(static_cast<float>(std::abs(depth) * random.logUniform(1e-6, 3)));
  };
  expectConditioned(MENISCUS_SHARED_CALL(callEllipsoidExtent), 51,
                    withView([=](Random& random, const PlacedView&, Inputs& out) {
                      glm::dvec3 x, z;
                      axes(random, x, z);
                      out.push_back(static_cast<float>(random.signedLog(1e-4, 3)));
                      place(random, out);
                      append(out, glm::vec3(x));
                      append(out, glm::vec3(z));
                    }),
                    {.groups = {{1, 2}}, .flag = true});
  expectConditioned(MENISCUS_SHARED_CALL(callTangentExtent), 52,
                    withView([=](Random& random, const PlacedView&, Inputs& out) {
                      glm::dvec3 x, z;
                      axes(random, x, z);
                      const glm::dvec3 n = x + random.signedLog(1e-4, 3) * z;
                      place(random, out);
                      out.push_back(static_cast<float>(glm::dot(n, n)));
                      out.push_back(static_cast<float>(glm::dot(n, z)));
                      out.push_back(static_cast<float>(glm::dot(z, z)));
                    }),
                    {.groups = {{1, 2}}, .flag = true});
}

}  // namespace
}  // namespace meniscus

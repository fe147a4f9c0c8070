// Shadows against what light does: rays in extended precision, and the area of a disc covered by another.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/constants.hpp>
#include <limits>

#include "core/light_view.h"
#include "render/renderer.h"
#include "render/shadow_scene.h"
#include "tests/support/exact_rays.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace meniscus {
namespace {

using test::Real;
using test::Vec3;

class ShadowTest : public test::GlTest {};

ShadowSettings soft(double penumbra, int samples = 64, int probes = ShadowSettings{}.probes) {
  return {ShadowMode::soft, penumbra, samples, probes};
}
constexpr ShadowSettings kHard{ShadowMode::hard, 0, 1, 0};

// Looks at the origin from `orientation`, from so far that `radius` [Å] around it is seen.
View viewAt(const Primitives& scene, ImageSize size, double radius, glm::dvec3 turnDeg = {-35, 20, 0}) {
  Camera camera;
  camera.orientation = rotatedBy({1, 0, 0, 0}, turnDeg);
  camera.distance = radius / std::tan(camera.fovY / 2);
  return makeView(camera, size, scene.bounds());
}

// A light that travels against `towards`, given in the scene's axes.
DirectionalLight lightFrom(const View& view, const glm::dvec3& towards) {
  return {view.rotation * -towards, 1};
}

// Point seen by a pixel, in the scene's axes.
glm::dvec3 seenPoint(const View& view, std::size_t pixel, double distance) {
  const auto width = static_cast<std::size_t>(view.size.width);
  const Ray ray = rayThrough(view, glm::dvec2(pixel % width, pixel / width) + 0.5);
  return view.pivot + glm::transpose(view.rotation) * (ray.origin + distance * ray.direction);
}

// Area of the intersection of two discs of radii a and b whose centres are d apart.
double lens(double d, double a, double b) {
  if (d >= a + b) return 0;
  const double small = std::min(a, b);
  if (d <= std::abs(a - b)) return M_PI * small * small;
  const double alpha = std::acos(std::clamp((d * d + a * a - b * b) / (2 * d * a), -1.0, 1.0));
  const double beta = std::acos(std::clamp((d * d + b * b - a * a) / (2 * d * b), -1.0, 1.0));
  return a * a * (alpha - std::sin(2 * alpha) / 2) + b * b * (beta - std::sin(2 * beta) / 2);
}

struct Error {
  double sum2 = 0, largest = 0;
  int count = 0;
  void add(double difference) {
    sum2 += difference * difference;
    largest = std::max(largest, std::abs(difference));
    ++count;
  }
  double rms() const { return std::sqrt(sum2 / std::max(count, 1)); }
};

// The filter averages over a disc in the plane across the light: the shadow of a sphere, a disc there, has a
// penumbra that is known.
TEST_F(ShadowTest, ASpheresPenumbraOnAPlaneIsTheShareOfADiscCovered) {
  constexpr double kRadius = 3;
  Primitives scene;
  scene.spheres = {{{0, 0, 12}, static_cast<float>(kRadius), 0xFFFFFF, 1}};
  scene.cylinders = {{{0, 0, -2}, 60, {0, 0, 0}, 0xFFFFFF, 0xFFFFFF, 2, 2}};
  const View view = viewAt(scene, {200, 160}, 20);
  for (const glm::dvec3 towards : {glm::dvec3(0, 0, 1), glm::dvec3(0.5, 0.3, 1), glm::dvec3(-1, 0.2, 0.8)}) {
    const glm::dvec3 toLight = glm::normalize(towards);
    ShadowScene fine(scene, view, lightFrom(view, toLight), 12);
    for (const auto& [penumbra, asDrawn] :
         {std::pair{1.0, false}, {3.0, false}, {12.0, false}, {3.0, true}}) {
      // As a picture's map is: wider shadows make do with larger texels.
      const double texel = shadowTexelSize(0, penumbra, kRadius);
      ShadowScene coarse(scene, view, lightFrom(view, toLight), penumbra, texel);
      ShadowScene& shadows = asDrawn ? coarse : fine;
      const double radius = penumbra / 2;
      const std::vector<float> many = shadows.visibility(soft(penumbra, 256, 0));
      const std::vector<float> standard = shadows.visibility(soft(penumbra));
      Error ofMany, ofStandard;
      int inPenumbra = 0;
      for (std::size_t i = 0; i < many.size(); ++i) {
        const auto distance = static_cast<double>(shadows.distance()[i]);
        if (std::isinf(distance)) continue;
        const glm::dvec3 p = seenPoint(view, i, distance);
        if (std::abs(p.z) > 1e-3 || glm::length(p) > 40) continue;  // on the plane, away from its rim
        const glm::dvec3 q = p - glm::dvec3(0, 0, 12);
        const double d = glm::length(q - glm::dot(q, toLight) * toLight);
        const double truth = 1 - lens(d, kRadius, radius) / (M_PI * radius * radius);
        inPenumbra += truth > 0 && truth < 1;
        ofMany.add(static_cast<double>(many[i]) - truth);
        ofStandard.add(static_cast<double>(standard[i]) - truth);
      }
      EXPECT_GT(inPenumbra, 150);
      EXPECT_LT(ofMany.rms(), 0.01) << penumbra;
      EXPECT_LT(ofMany.largest, 0.06) << penumbra;
      EXPECT_LT(ofStandard.rms(), 0.02) << penumbra;
      EXPECT_LT(ofStandard.largest, 0.12) << penumbra;
    }
  }
}

TEST(ShadowTexels, AreNoFinerThanThePenumbraShowsNorCoarserThanWhatCastsIt) {
  EXPECT_EQ(shadowTexelSize(0.05, 0, 1.5), 0.05) << "a hard shadow: a pixel's";
  EXPECT_EQ(shadowTexelSize(0.05, 2, 1.5), 0.2);
  EXPECT_EQ(shadowTexelSize(0.3, 2, 1.5), 0.3) << "pixels that are larger stay";
  EXPECT_EQ(shadowTexelSize(0.05, 100, 1.5), 0.25) << "a sixth of an atom";
  EXPECT_EQ(shadowTexelSize(0.05, 2, 0.25), 0.05) << "bonds";
  EXPECT_EQ(Primitives{}.thinnestRadius(), std::numeric_limits<double>::infinity());
  Primitives scene;
  scene.spheres = {{{0, 0, 0}, 1.5f, 0, 1}};
  EXPECT_EQ(scene.thinnestRadius(), 1.5);
  scene.cylinders = {{{0, 0, 0}, 0.25f, {1, 0, 0}, 0, 0, 1, 1}};
  EXPECT_EQ(scene.thinnestRadius(), 0.25);
  scene.mesh.vertices.emplace_back();
  scene.mesh.triangles.emplace_back();
  EXPECT_EQ(scene.thinnestRadius(), 0) << "of ribbons it is not known";
}

// Whether something is met between the tangent plane at a point and the light, `offset` [Å] aside across the
// light. The own object lies below its tangent plane.
bool blocked(const Primitives& scene, const glm::dvec3& point, const glm::dvec3& normal,
             const glm::dvec3& toLight, const glm::dvec3& offset) {
  const glm::dvec3 start = point + offset - toLight * (glm::dot(normal, offset) / glm::dot(normal, toLight));
  const test::ExactRay ray{Vec3(start), Vec3(toLight)};
  const auto above = [](const std::optional<test::ExactChord>& chord) {
    return chord && chord->out > Real(1e-3);
  };
  const auto placed = [&](const glm::vec3& p) { return Vec3(scene.origin) + Vec3(p); };
  for (const SpherePrimitive& s : scene.spheres)
    if (above(test::exactSphere(ray, placed(s.center), Real(s.radius)))) return true;
  for (const CylinderPrimitive& c : scene.cylinders)
    if (above(test::exactCylinder(ray, placed(c.a), placed(c.b), Real(c.radius)))) return true;
  return false;
}

// Two directions across the light, in the scene's axes.
std::pair<glm::dvec3, glm::dvec3> across(const glm::dvec3& toLight) {
  const glm::dvec3 hint = std::abs(toLight.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(hint, toLight));
  return {right, glm::cross(toLight, right)};
}

// Thin sticks throw whole shadows, and only they.
TEST_F(ShadowTest, HardShadowsAreThoseOfRaysButAtTheirEdges) {
  const auto scene = test::randomChain(30, 5);
  const View view = test::viewOf(*scene, {160, 120});
  for (const glm::dvec3 towards :
       {glm::dvec3(0.4, 0.6, 0.9), glm::dvec3(-1, 0.1, 0.2), glm::dvec3(0.1, -1, 0.05)}) {
    const glm::dvec3 toLight = glm::normalize(towards);
    ShadowScene shadows(*scene, view, {-toLight, 1});  // in the camera's axes
    const glm::dvec3 light = glm::transpose(view.rotation) * toLight;
    const auto [right, up] = across(light);
    const std::vector<float> visibility = shadows.visibility(kHard);
    const double texel = shadows.light().pixelSize;
    int lit = 0, dark = 0;
    for (std::size_t i = 0; i < visibility.size(); ++i) {
      if (shadows.depth()[i] == 0.0f) continue;
      const glm::dvec3 normal = glm::transpose(view.rotation) * glm::dvec3(shadows.normal()[i]);
      if (glm::dot(normal, light) < 0.1) continue;
      const glm::dvec3 p = seenPoint(view, i, static_cast<double>(shadows.distance()[i]));
      int blockedOnes = 0;
      for (int dx = -2; dx <= 2; ++dx)
        for (int dy = -2; dy <= 2; ++dy)
          blockedOnes +=
              blocked(*scene, p, normal, light,
                      0.8 * texel * (static_cast<double>(dx) * right + static_cast<double>(dy) * up));
      if (blockedOnes == 0) {
        ++lit;
        EXPECT_EQ(visibility[i], 1.0f) << "acne";
      } else if (blockedOnes == 25) {
        ++dark;
        EXPECT_EQ(visibility[i], 0.0f) << "a leak";
      }
    }
    EXPECT_GT(lit, 300);
    EXPECT_GT(dark, 20);
  }
}

TEST_F(ShadowTest, SoftShadowsAreTheMeanOfRaysOverTheDisc) {
  const auto scene = test::randomChain(30, 5);
  const View view = test::viewOf(*scene, {240, 180});
  const glm::dvec3 toLight = glm::normalize(glm::dvec3(0.4, 0.6, 0.9));
  ShadowScene shadows(*scene, view, {-toLight, 1});
  const glm::dvec3 light = glm::transpose(view.rotation) * toLight;
  const auto [right, up] = across(light);
  const std::vector<float> visibility = shadows.visibility(soft(2, 256, 0));
  Error error;
  for (std::size_t i = 0; i < visibility.size(); i += 13) {
    if (shadows.depth()[i] == 0.0f) continue;
    const glm::dvec3 normal = glm::transpose(view.rotation) * glm::dvec3(shadows.normal()[i]);
    if (glm::dot(normal, light) < 0.1) continue;
    const glm::dvec3 p = seenPoint(view, i, static_cast<double>(shadows.distance()[i]));
    int arrived = 0;
    constexpr int kRays = 200;
    for (int k = 0; k < kRays; ++k) {  // Vogel's spiral, not the pattern of the shader
      const double r = std::sqrt((k + 0.5) / kRays), angle = k * 2.399963229728653;
      arrived += !blocked(*scene, p, normal, light, r * (std::cos(angle) * right + std::sin(angle) * up));
    }
    error.add(static_cast<double>(visibility[i]) - static_cast<double>(arrived) / kRays);
  }
  EXPECT_GT(error.count, 300);
  EXPECT_LT(error.rms(), 0.03);
  EXPECT_LT(error.largest, 0.2);
}

// What is convex and alone shadows itself nowhere, however the light grazes it.
TEST_F(ShadowTest, ConvexObjectsHaveNoAcne) {
  Primitives ball, stick, disc;
  ball.spheres = {{{0, 0, 0}, 1.7f, 0xFFFFFF, 1}};
  stick.cylinders = {{{-2, 0, 0}, 0.25f, {2, 0.5f, 0.3f}, 0xFFFFFF, 0xFFFFFF, 1, 1}};
  disc.cylinders = {{{0, 0, -0.2f}, 3, {0, 0, 0.2f}, 0xFFFFFF, 0xFFFFFF, 1, 1}};
  test::Random random(11);
  for (const Primitives* scene : {&ball, &stick, &disc}) {
    const View view = viewAt(*scene, {120, 90}, 4);
    std::vector<glm::dvec3> lights{{0, 0, 1},     {0, 1, 0},      {1, 0, 0},
                                   {1, 0, 0.001}, {0.3, 1, 0.01}, {1, 0.1, -0.2}};
    for (int i = 0; i < 12; ++i) lights.push_back(random.direction());
    for (const glm::dvec3& towards : lights) {
      ShadowScene shadows(*scene, view, {-towards, 1}, 50);
      for (const ShadowSettings& settings : {kHard, soft(0), soft(0.3), soft(2), soft(50)}) {
        const std::vector<float> visibility = shadows.visibility(settings);
        int acne = 0, facing = 0, leaks = 0;
        for (std::size_t i = 0; i < visibility.size(); ++i) {
          if (shadows.depth()[i] == 0.0f) {
            EXPECT_EQ(visibility[i], 0.0f);
            continue;
          }
          const double cosine = glm::dot(glm::dvec3(shadows.normal()[i]), glm::normalize(towards));
          facing += cosine > 1e-5;
          acne += cosine > 1e-5 && visibility[i] != 1.0f;
          leaks += cosine < -1e-5 && visibility[i] != 0.0f;
        }
        EXPECT_EQ(acne, 0) << "of " << facing << ", light from " << towards.x << ' ' << towards.y << ' '
                           << towards.z << ", penumbra " << settings.penumbra;
        EXPECT_EQ(leaks, 0);
      }
    }
  }
}

std::vector<float> drawFloat(const std::shared_ptr<Primitives>& scene, const View& view,
                             const Lighting& lighting, const ShadowSettings& shadows,
                             RenderStats* stats = nullptr) {
  Renderer renderer;
  renderer.setPrimitives(scene);
  RenderSettings settings = test::withSamples(1);
  settings.shadows = shadows;
  test::MemorySink sink;
  renderer.renderPicture(view, lighting, Background{}, settings, PixelFormat::rgbaFloat, sink);
  std::vector<float> out(sink.bytes.size() / sizeof(float));
  std::memcpy(out.data(), sink.bytes.data(), sink.bytes.size());
  if (stats) *stats = renderer.stats();
  return out;
}

TEST_F(ShadowTest, ExtremesGiveNumbers) {
  const auto chain = test::randomChain(20, 9);
  const auto atom = test::randomSpheres(1, 9);
  const auto scaled = [&](float factor) {
    auto scene = std::make_shared<Primitives>(*chain);
    scene->origin = {0, 0, 0};
    for (SpherePrimitive& s : scene->spheres) {
      s.center *= factor;
      s.radius *= factor;
    }
    for (CylinderPrimitive& c : scene->cylinders) {
      c.a *= factor;
      c.b *= factor;
      c.radius *= factor;
    }
    return scene;
  };
  const std::vector<std::shared_ptr<Primitives>> scenes{chain, atom, scaled(0.05f), scaled(1e4f)};
  for (const auto& scene : scenes) {
    for (const ImageSize size : {ImageSize{40, 30}, ImageSize{1, 1}}) {
      const View view = test::viewOf(*scene, size);
      for (const glm::dvec3 direction : {glm::dvec3(0, 0, -1), glm::dvec3(0, -1, 0), glm::dvec3(0, 0, 1),
                                         glm::dvec3(0, 0, 0), glm::dvec3(1e-200, 0, 0)}) {
        Lighting lighting;
        lighting.key.direction = direction;
        for (const ShadowSettings& settings :
             {kHard, soft(0), soft(2), soft(1e6), soft(1, 1, 0), soft(1, 256, 256)}) {
          for (const float value : drawFloat(scene, view, lighting, settings))
            ASSERT_TRUE(std::isfinite(value));
        }
      }
    }
  }
}

// Seen and lit from the same side, scenes of any size look alike.
TEST_F(ShadowTest, ScaleDoesNotMatter) {
  const auto chain = test::randomChain(20, 9);
  std::vector<double> shares;
  for (const float factor : {0.05f, 1.0f, 1e4f}) {
    Primitives scene = *chain;
    scene.origin = {0, 0, 0};
    for (SpherePrimitive& s : scene.spheres) s = {s.center * factor, s.radius * factor, s.color, s.id};
    for (CylinderPrimitive& c : scene.cylinders) {
      c.a *= factor;
      c.b *= factor;
      c.radius *= factor;
    }
    const double penumbra = 0.5 * static_cast<double>(factor);
    ShadowScene shadows(scene, test::viewOf(scene, {120, 90}), {{0.5, -0.5, -0.7}, 1}, penumbra);
    double sum = 0;
    int count = 0;
    const std::vector<float> visibility = shadows.visibility(soft(penumbra));
    for (std::size_t i = 0; i < visibility.size(); ++i) {
      if (shadows.depth()[i] == 0.0f) continue;
      sum += static_cast<double>(visibility[i]);
      ++count;
    }
    shares.push_back(sum / count);
  }
  EXPECT_NEAR(shares[0], shares[1], 0.004);
  EXPECT_NEAR(shares[2], shares[1], 0.004);
}

TEST_F(ShadowTest, OffIsNoPassNoMapAndNoProgram) {
  const auto scene = test::randomChain(20, 9);
  RenderStats stats;
  drawFloat(scene, test::viewOf(*scene, {40, 30}), Lighting{}, {}, &stats);
  for (const PassStats& pass : stats.passes) EXPECT_EQ(pass.name.find("shadow"), std::string::npos);
  for (const std::string& program : stats.programs) EXPECT_EQ(program.find("shadow"), std::string::npos);
  for (const ResourceStats& texture : stats.textures) {
    EXPECT_NE(texture.name, "shadow map");
    EXPECT_NE(texture.name, "visibility");
  }
  EXPECT_TRUE(std::any_of(stats.omissions.begin(), stats.omissions.end(),
                          [](const OmissionStats& o) { return o.what == "pass shadow"; }));
}

// Turning the camera about what it looks at, with the light fixed to the scene, leaves a shadow where it is.
TEST_F(ShadowTest, ShadowsDoNotSwimWhenTheCameraTurns) {
  constexpr double kRadius = 3;
  Primitives scene;
  scene.spheres = {{{0, 0, 12}, static_cast<float>(kRadius), 0xFFFFFF, 1}};
  scene.cylinders = {{{0, 0, -2}, 60, {0, 0, 0}, 0xFFFFFF, 0xFFFFFF, 2, 2}};
  const glm::dvec3 toLight = glm::normalize(glm::dvec3(0.5, 0.3, 1));
  for (int turn = 0; turn < 6; ++turn) {
    const View view = viewAt(scene, {200, 160}, 20, {-35 + 0.7 * turn, 20 + 3.1 * turn, 1.3 * turn});
    ShadowScene shadows(scene, view, lightFrom(view, toLight));
    const std::vector<float> visibility = shadows.visibility(soft(2));
    double area = 0;  // of what is dark on the plane [Å^2]
    for (std::size_t i = 0; i < visibility.size(); ++i) {
      const auto distance = static_cast<double>(shadows.distance()[i]);
      if (std::isinf(distance)) continue;
      const glm::dvec3 p = seenPoint(view, i, distance);
      if (std::abs(p.z) > 1e-3 || glm::length(p) > 19) continue;
      const glm::dvec3 q = p - glm::dvec3(0, 0, 12);
      const double d = glm::length(q - glm::dot(q, toLight) * toLight);
      const double truth = 1 - lens(d, kRadius, 1) / M_PI;
      area += static_cast<double>(visibility[i]) - truth;
      ASSERT_NEAR(static_cast<double>(visibility[i]), truth, 0.15) << turn;
    }
    EXPECT_LT(std::abs(area), 40) << "mean error of the pixels, turn " << turn;
  }
}

}  // namespace
}  // namespace meniscus

// Effects that the processor computes against the shaders that stand for the same.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "core/tiles/instruction_sets.h"
#include "render/renderer.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/scenes.h"

namespace meniscus {
namespace {

class ProcessorEffects : public test::GlTest {
 protected:
  void TearDown() override {
    tiles::useInstructionSet("");
    test::GlTest::TearDown();
  }
  static std::vector<std::byte> picture(const Primitives& scene, const View& view,
                                        const RenderSettings& settings, bool processor, int maxTileSize = 0) {
    Renderer renderer(test::effectsBy(processor, maxTileSize));
    renderer.setPrimitives(std::make_shared<Primitives>(scene));
    test::MemorySink sink;
    renderer.renderPicture(view, Lighting{}, {}, settings, PixelFormat::rgba8, sink);
    return sink.bytes;
  }
  // Pixels of which a channel differs by more than `most`.
  static int differences(const std::vector<std::byte>& a, const std::vector<std::byte>& b, int most) {
    int different = 0;
    EXPECT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i + 3 < a.size(); i += 4) {
      int largest = 0;
      for (std::size_t c = 0; c < 4; ++c)
        largest = std::max(largest, std::abs(static_cast<int>(a[i + c]) - static_cast<int>(b[i + c])));
      different += largest > most;
    }
    return different;
  }
  // What the effect does to the picture, and where the two ways to compute it differ.
  static void expectSame(const Primitives& scene, const View& view, const RenderSettings& settings,
                         const char* what) {
    SCOPED_TRACE(what);
    const auto with = picture(scene, view, settings, true);
    RenderSettings none;
    none.samples = settings.samples;
    EXPECT_GT(differences(with, picture(scene, view, none, true), 8),
              view.size.width * view.size.height / 50);
    EXPECT_LE(differences(with, picture(scene, view, settings, false), 1),
              view.size.width * view.size.height / 5000);
  }
};

// Atoms and bonds; every residue of ten atoms.
Primitives chain() {
  Primitives scene = *test::randomChain(300, 8);
  scene.groups.push_back(0);
  for (std::uint32_t id = 1; id <= 300; ++id) scene.groups.push_back(id / 10 + 1);
  return scene;
}

constexpr Projection kBoth[] = {Projection::perspective, Projection::orthographic};

TEST_F(ProcessorEffects, ShadowsAreThoseOfTheShader) {
  const Primitives scene = chain();
  for (const Projection projection : kBoth) {
    // Neither is a multiple of any vector's length.
    const View view = test::viewOf(scene, {323, 201}, projection);
    RenderSettings settings;
    settings.samples = 1;
    settings.shadows.mode = ShadowMode::hard;
    expectSame(scene, view, settings, "hard");
    settings.shadows.mode = ShadowMode::soft;
    expectSame(scene, view, settings, "soft");
    settings.shadows.probes = 0;
    settings.shadows.samples = 7;
    expectSame(scene, view, settings, "soft without probes");
    settings.shadows = {ShadowMode::soft, 8.0, 256, 40};
    settings.samples = 3;
    expectSame(scene, view, settings, "very soft, several rays");
  }
}

TEST_F(ProcessorEffects, LinesAreThoseOfTheShader) {
  const Primitives scene = chain();
  for (const Projection projection : kBoth) {
    const View view = test::viewOf(scene, {323, 201}, projection);
    for (const double width : {0.5, 1.5, 3.0, 16.0}) {
      RenderSettings settings;
      settings.samples = 1;
      settings.lines.silhouettes = true;
      settings.lines.width = width;
      expectSame(scene, view, settings, "silhouettes");
      settings.lines.groups = LineGroups::residues;
      expectSame(scene, view, settings, "and residues");
      settings.lines.silhouettes = false;
      settings.lines.groups = LineGroups::atoms;
      expectSame(scene, view, settings, "atoms");
    }
  }
}

TEST_F(ProcessorEffects, OcclusionIsThatOfTheShader) {
  const Primitives scene = chain();
  for (const Projection projection : kBoth) {
    const View view = test::viewOf(scene, {323, 201}, projection);
    RenderSettings settings;
    settings.occlusion.on = true;
    settings.samples = 1;
    expectSame(scene, view, settings, "directions shared by 16 pixels");
    settings.samples = 4;
    expectSame(scene, view, settings, "by fewer");
    settings.samples = 9;
    expectSame(scene, view, settings, "each pixel by itself");
    settings.samples = 1;
    settings.occlusion.radius = 0;
    settings.occlusion.directions = 24;
    expectSame(scene, view, settings, "of everything, in few directions");
  }
}

TEST_F(ProcessorEffects, AreTheSameBytesByEveryInstructionSetAndInParts) {
  const Primitives scene = chain();
  const View view = test::viewOf(scene, {150, 97});
  RenderSettings settings;
  settings.shadows.mode = ShadowMode::soft;
  settings.lines.silhouettes = true;
  settings.lines.groups = LineGroups::atoms;
  settings.occlusion.on = true;
  for (const int samples : {2, 8}) {  // pixels share directions; each takes all
    settings.samples = samples;
    const auto whole = picture(scene, view, settings, true);
    EXPECT_EQ(picture(scene, view, settings, true, 41), whole);
    for (const std::string& set : tiles::instructionSets()) {
      tiles::useInstructionSet(set);
      EXPECT_EQ(picture(scene, view, settings, true), whole) << set;
    }
    tiles::useInstructionSet("");
  }
}

// Whatever is added to the light or laid over it, in every form in which a picture is stored.
struct Look {
  const char* name;
  RenderSettings settings;
  bool labels = false;
};
std::vector<Look> looks() {
  std::vector<Look> all{{"plain", {}},   {"fog", {}},     {"unsharp", {}},      {"occlusion", {}},
                        {"creases", {}}, {"mirrors", {}}, {"labels", {}, true}, {"everything", {}, true}};
  for (Look& look : all) {
    const std::string name = look.name;
    const bool everything = name == "everything";
    RenderSettings& s = look.settings;
    if (everything || name == "fog") s.fog = {0.7, 0.1, 0.9};
    if (everything || name == "unsharp") s.depthUnsharp.mode = UnsharpMode::halo;
    if (name == "unsharp") s.depthUnsharp = {UnsharpMode::both, 5, 0.05};
    if (everything || name == "occlusion") s.occlusion.on = true;
    if (everything || name == "creases") s.lines.silhouettes = s.lines.creases = true;
    if (name == "mirrors") s.trace.reflect = 2;
    if (everything) s.shadows.mode = ShadowMode::soft;
  }
  return all;
}

class ProcessorShading : public ProcessorEffects {
 protected:
  struct Form {
    PixelFormat format;
    Background background;
    int samples;
  };
  static std::vector<std::byte> picture(const Primitives& scene, const View& view, const Look& look,
                                        const Form& form, bool processor, int maxTileSize = 0) {
    Renderer renderer(test::effectsBy(processor, maxTileSize));
    renderer.setPrimitives(std::make_shared<Primitives>(scene));
    if (look.labels) {
      LabelSprite sprite;
      sprite.label = {"x", glm::dvec3(0.0), 3.0};
      sprite.width = 31;
      sprite.height = 9;
      for (int i = 0; i < 31 * 9; ++i)
        sprite.texels.push_back(
            {static_cast<std::uint8_t>(i % 7 * 40), static_cast<std::uint8_t>(i % 5 * 60)});
      renderer.setLabels({sprite}, {0x2040A0, 0xFFF0E0});
    }
    RenderSettings settings = look.settings;
    settings.samples = form.samples;
    test::MemorySink sink;
    renderer.renderPicture(view, Lighting{}, form.background, settings, form.format, sink);
    return sink.bytes;
  }
};

TEST_F(ProcessorShading, IsThatOfTheShaderInEveryForm) {
  const Primitives scene = chain();
  const View view = test::viewOf(scene, {203, 131});
  const Form forms[] = {{PixelFormat::rgba8, {0x305070, false}, 1},
                        {PixelFormat::rgba8, {0, true}, 3},
                        {PixelFormat::rgba16, {0xFFFFFF, false}, 2},
                        {PixelFormat::rgbaFloat, {0, true}, 1}};
  for (const Look& look : looks()) {
    for (const Form& form : forms) {
      SCOPED_TRACE(look.name + (": " + std::to_string(static_cast<int>(form.format))));
      const auto mine = picture(scene, view, look, form, true),
                 theirs = picture(scene, view, look, form, false);
      ASSERT_EQ(mine.size(), theirs.size());
      const std::size_t values = 4 * 203 * 131;
      std::size_t lit = 0, apart = 0;
      const auto compare = [&]<typename T>(T, double most) {
        for (std::size_t i = 0; i < values; ++i) {
          T a, b;
          std::memcpy(&a, mine.data() + sizeof(T) * i, sizeof(T));
          std::memcpy(&b, theirs.data() + sizeof(T) * i, sizeof(T));
          lit += i % 4 < 3 && a != T(0) && a != std::numeric_limits<T>::max();
          apart += !(std::abs(static_cast<double>(a) - static_cast<double>(b)) <= most);
        }
      };
      // Of 16 bits and floats, besides a step of effects that are stored in 16 bits.
      if (form.format == PixelFormat::rgba8) compare(std::uint8_t{}, 1);
      if (form.format == PixelFormat::rgba16) compare(std::uint16_t{}, 24);
      if (form.format == PixelFormat::rgbaFloat) compare(float{}, 3e-4);
      EXPECT_GT(lit, values / 20);
      EXPECT_LE(apart, values / 4000);
    }
  }
}

TEST_F(ProcessorShading, HasTheSameBytesByEveryInstructionSetAndInParts) {
  const Primitives scene = chain();
  const View view = test::viewOf(scene, {150, 97});
  for (const Look& look : looks()) {
    if (std::string(look.name) == "unsharp") continue;  // its blocks depend on the part
    SCOPED_TRACE(look.name);
    const Form form{PixelFormat::rgba16, {0, true}, 2};
    const auto whole = picture(scene, view, look, form, true);
    for (const std::string& set : tiles::instructionSets()) {
      tiles::useInstructionSet(set);
      EXPECT_EQ(picture(scene, view, look, form, true), whole) << set;
    }
    tiles::useInstructionSet("");
    EXPECT_EQ(picture(scene, view, look, form, true, 41), whole);
  }
}

TEST_F(ProcessorShading, SurfacesAndQuadricsHideEachOther) {
  Primitives scene = chain();
  Primitives both;
  both.spheres.assign(scene.spheres.begin(), scene.spheres.begin() + 150);
  MetaballField field;
  field.level = 0.3;
  std::uint32_t id = 151;
  for (std::size_t i = 100; i < 300; ++i) {
    const SpherePrimitive& s = scene.spheres[i];
    field.balls.push_back({s.center, 4 * s.radius, 1, 0x3070C0, id++});
  }
  both.surfaces = {field, field};
  for (Metaball& ball : both.surfaces[1].balls) ball.center += glm::vec3(6, 0, 0);
  const View view = test::viewOf(both, {203, 131});
  const Form form{PixelFormat::rgba8, {}, 2};
  const auto mine = picture(both, view, {"", {}}, form, true);
  EXPECT_LE(differences(mine, picture(both, view, {"", {}}, form, false), 1), 8);
  for (const bool surfaces : {false, true}) {
    Primitives one = both;
    if (surfaces)
      one.spheres.clear();
    else
      one.surfaces.clear();
    EXPECT_GT(differences(mine, picture(one, view, {"", {}}, form, true), 8), 203 * 131 / 100);
  }
}

TEST_F(ProcessorEffects, ASinglePixelWillDo) {
  const Primitives scene = chain();
  RenderSettings settings;
  settings.samples = 1;
  settings.shadows.mode = ShadowMode::soft;
  settings.lines.silhouettes = true;
  for (const ImageSize size : {ImageSize{1, 1}, ImageSize{1, 40}, ImageSize{40, 1}, ImageSize{17, 3}}) {
    const View view = test::viewOf(scene, size);
    EXPECT_LE(differences(picture(scene, view, settings, true), picture(scene, view, settings, false), 1), 1);
  }
}

}  // namespace
}  // namespace meniscus

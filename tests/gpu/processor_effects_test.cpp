// Effects that the processor computes against the shaders that stand for the same.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

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
    RendererOptions options;
    options.effectsOnProcessor = processor;
    options.maxTileSize = maxTileSize;
    Renderer renderer(options);
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

TEST_F(ProcessorEffects, AreTheSameBytesByEveryInstructionSetAndInParts) {
  const Primitives scene = chain();
  const View view = test::viewOf(scene, {150, 97});
  RenderSettings settings;
  settings.samples = 2;
  settings.shadows.mode = ShadowMode::soft;
  settings.lines.silhouettes = true;
  settings.lines.groups = LineGroups::atoms;
  const auto whole = picture(scene, view, settings, true);
  EXPECT_EQ(picture(scene, view, settings, true, 41), whole);
  for (const std::string& set : tiles::instructionSets()) {
    tiles::useInstructionSet(set);
    EXPECT_EQ(picture(scene, view, settings, true), whole) << set;
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

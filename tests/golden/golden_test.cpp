// Real molecules as pictures: against stored images, and EGL against OSMesa.

#include <gtest/gtest.h>

#include <filesystem>

#include "core/bonds.h"
#include "core/error.h"
#include "io/structure_reader.h"
#include "render/gl/context.h"
#include "render/renderer.h"
#include "tests/support/image_compare.h"
#include "tests/support/paths.h"
#include "tests/support/scenes.h"

namespace meniscus {
namespace {

struct Case {
  const char* name;
  const char* file;
  Representation representation;
  Coloring coloring;
  Projection projection;
  Background background;
};

constexpr ImageSize kSize{320, 240};

const Case kCases[] = {
    {"ubiquitin_spacefill", "1ubq.pdb", Representation::spacefill, {}, Projection::perspective, {}},
    {"dna_ball_and_stick", "133d.pdb", Representation::ballAndStick, {}, Projection::perspective, {}},
    {"c60_licorice_orthographic",
     "c60.pdb",
     Representation::licorice,
     {ColorScheme::uniform, 0x4C78A8, false},
     Projection::orthographic,
     {0x102030, false}},
    {"hemoglobin_chains_transparent",
     "2hhb.pdb.gz",
     Representation::spacefill,
     {ColorScheme::chain, 0, false},
     Projection::perspective,
     {0xFFFFFF, true}},
    {"alpha1_ellipsoids",
     "3al1.pdb.gz",
     Representation::ellipsoids,
     {ColorScheme::element, 0, true},
     Projection::perspective,
     {}},
};

// Draws a case with the current context.
std::vector<std::byte> draw(const Case& c) {
  Logger logger;
  StructureOptions options;
  options.altlocs = Altlocs::first;
  options.waters = Waters::off;
  StructureFile file = readStructure(test::projectFile(std::string("molecules/") + c.file), options, logger);
  auto molecule = std::make_shared<Molecule>(std::move(file.models.front()));
  if (needsBonds(c.representation)) addMissingBonds(*molecule, logger);
  Scene scene;
  SceneObject object;
  object.molecule = molecule;
  object.placements = placeOnce(*molecule);
  object.representation = c.representation;
  object.coloring = c.coloring;
  scene.objects = {object};
  const std::vector<FitSphere> fit = fitSpheres(object);
  scene.camera.projection = c.projection;
  scene.camera.orientation = principalAxes(fit, false);
  scene.camera = fitted(scene.camera, kSize, fit);
  const auto primitives = std::make_shared<Primitives>(buildPrimitives(scene));
  Renderer renderer;
  renderer.setPrimitives(primitives);
  test::MemorySink sink;
  renderer.renderPicture(makeView(scene.camera, kSize, primitives->bounds()), scene.lighting, c.background,
                         test::withSamples(4), PixelFormat::rgba8, sink);
  return sink.bytes;
}

class Golden : public testing::TestWithParam<Case> {};

TEST_P(Golden, MatchesTheStoredImage) {
  const auto context = Context::create(Backend::automatic);
  test::expectMatchesStored(
      draw(GetParam()), kSize,
      test::projectFile("tests/golden/images/" + std::string(GetParam().name) + ".png"));
}

TEST_P(Golden, IsTheSameOnEglAndOsmesa) {
  std::vector<std::byte> egl, osmesa;
  {
    const auto context = Context::create(Backend::egl);
    egl = draw(GetParam());
  }
  {
    const auto context = Context::create(Backend::osmesa);
    osmesa = draw(GetParam());
  }
  test::expectSimilar(egl, osmesa, kSize, std::string(GetParam().name) + "-osmesa");
}

INSTANTIATE_TEST_SUITE_P(Pictures, Golden, testing::ValuesIn(kCases),
                         [](const auto& picture) { return std::string(picture.param.name); });

}  // namespace
}  // namespace meniscus

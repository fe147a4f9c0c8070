// The truth for metaballs against an outside opinion: POV-Ray's blob, whose density is the quartic kernel.
// Its picture holds no light but where each ray met the surface, in two channels of 16 bits.

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "core/hit_errors.h"
#include "core/primitives.h"
#include "core/reference_tracer.h"
#include "io/structure_reader.h"
#include "tests/support/exact_field.h"
#include "tests/support/paths.h"
#include "tests/support/process.h"

namespace meniscus {
namespace {

constexpr ImageSize kSize{160, 120};
// The coarse channel holds a depth as a share of the range, the fine one what exceeds multiples of 1/kSteps.
constexpr double kSteps = 512;

/// POV-Ray looks along +z, x to the right and y up: view space with z turned round.
struct PovScene {
  std::string text;
  double least, range;  ///< of POV-Ray's z
};

PovScene povScene(const MetaballField& field, const glm::dvec3& origin, const View& view) {
  PovScene scene;
  scene.least = -view.nearZ;
  scene.range = view.nearZ - view.farZ;
  const bool perspective = view.projection == Projection::perspective;
  scene.text = fmt::format(
      "#version 3.7;\nglobal_settings {{ assumed_gamma 1.0 }}\nbackground {{ color rgb 0 }}\n"
      "camera {{ {} location <0,0,{:.17g}> direction <0,0,1> right <{:.17g},0,0> up <0,{:.17g},0> }}\n"
      "#declare Share = function {{ (z - {:.17g}) / {:.17g} }};\n"
      "blob {{ threshold {:.17g}\n",
      perspective ? "perspective" : "orthographic", perspective ? -view.distance : -view.nearZ,
      view.size.width * view.pixelSize, view.size.height * view.pixelSize, scene.least, scene.range,
      field.level);
  for (const Metaball& ball : field.balls) {
    const glm::dvec3 p(test::exactViewPoint(view, origin, ball.center));
    scene.text += fmt::format("sphere {{ <{:.17g},{:.17g},{:.17g}>, {:.17g}, {:.17g} }}\n", p.x, p.y, -p.z,
                              ball.support, ball.coefficient);
  }
  // `average` divides by three.
  scene.text += fmt::format(
      "texture {{ pigment {{ average pigment_map {{\n"
      "[1 function {{ Share(x,y,z) }} color_map {{ [0 rgb 0] [1 rgb <3,0,0>] }} ]\n"
      "[1 function {{ {} * Share(x,y,z) }} color_map {{ [0 rgb 0] [1 rgb <0,3,0>] }} ]\n"
      "[1 color rgb <0,0,3>] }} }} finish {{ ambient 1 diffuse 0 }} }} }}\n",
      kSteps);
  return scene;
}

/// What POV-Ray meets. Fails the test if there is no POV-Ray.
HitImage povHits(const MetaballField& field, const glm::dvec3& origin, const View& view) {
  const PovScene scene = povScene(field, origin, view);
  const test::TemporaryFolder folder;
  test::writeFile(folder / "scene.pov", scene.text);
  test::ProcessOptions options;
  options.folder = folder.path();
  options.environment = {{"HOME", folder.path().string()}};
  const test::ProcessResult run = test::runProcess(
      {"/usr/bin/env", "povray", "+Iscene.pov", "+Oscene.png", fmt::format("+W{}", view.size.width),
       fmt::format("+H{}", view.size.height), "+FN16", "-A", "-D", "-P", "+WT2", "File_Gamma=1.0"},
      options);
  EXPECT_EQ(run.exitCode, 0) << "scripts/install-dependencies --test installs povray\n" << run.err;
  HitImage image{view.size, {}, {}, {}};
  const auto width = static_cast<std::size_t>(view.size.width),
             height = static_cast<std::size_t>(view.size.height);
  image.distance.assign(width * height, std::numeric_limits<float>::infinity());
  const auto input = OIIO::ImageInput::open((folder / "scene.png").string());
  if (run.exitCode != 0 || !input) {
    ADD_FAILURE() << "no picture of POV-Ray";
    return image;
  }
  std::vector<std::uint16_t> pixels(width * height * 3);
  EXPECT_EQ(input->spec().nchannels, 3);
  EXPECT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT16, pixels.data()));
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const std::uint16_t* rgb = &pixels[3 * ((height - 1 - y) * width + x)];
      if (rgb[2] == 0) continue;
      const double coarse = rgb[0] / 65535.0, fine = rgb[1] / 65535.0;
      const double z = scene.least + scene.range * (std::round(coarse * kSteps - fine) + fine) / kSteps;
      const Ray ray = rayThrough(view, {static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5});
      image.distance[y * width + x] = static_cast<float>((ray.origin.z + z) / -ray.direction.z);
    }
  }
  return image;
}

void expectSame(const MetaballField& field, const glm::dvec3& origin, const View& view, const char* name) {
  const ReferenceImage truth = traceReference(field, origin, view);
  const HitErrors errors = compareHits(povHits(field, origin, view), truth);
  testing::Test::RecordProperty(fmt::format("{}_p99", name), fmt::format("{}", errors.distanceP99));
  testing::Test::RecordProperty(fmt::format("{}_largest", name), fmt::format("{}", errors.largestDistance));
  EXPECT_EQ(errors.missed, 0u) << name;
  EXPECT_EQ(errors.falseHits, 0u) << name;
  EXPECT_GT(errors.compared, 2000u) << name;
  // The fine channel's step, a float32, and little more. POV-Ray's own roots are worse where a ray almost
  // grazes; measured: 5.3e-5 A.
  const double step = (view.nearZ - view.farZ) / kSteps / 65535, single = 0x1p-23 * view.nearZ;
  EXPECT_LT(errors.distanceP99, 2 * step + 3 * single) << name;
  EXPECT_LT(errors.largestDistance, 1e-3) << name;
}

class PovrayBlob : public testing::TestWithParam<Projection> {};

TEST_P(PovrayBlob, OfRandomBalls) {
  for (const int hollow : {0, 3}) {
    const MetaballField field = test::randomField({KernelShape::quartic}, 0.4, 30, 5, hollow, 21);
    const glm::dvec3 origin(12, -3, 8);
    expectSame(field, origin, test::viewOfBall(GetParam(), kSize, origin, 9),
               hollow == 0 ? "positive" : "hollow");
  }
}

TEST_P(PovrayBlob, OfUbiquitin) {
  Logger logger;
  StructureOptions options;
  options.altlocs = Altlocs::first;
  options.waters = Waters::off;
  StructureFile file = readStructure(test::projectFile("molecules/1ubq.pdb"), options, logger);
  const auto molecule = std::make_shared<Molecule>(std::move(file.models.front()));
  Scene scene;
  SceneObject object;
  object.molecule = molecule;
  object.placements = placeOnce(*molecule);
  scene.objects = {object};
  const Primitives primitives = buildPrimitives(scene);
  MetaballField field;
  field.kernel.shape = KernelShape::quartic;
  field.level = levelOfBlend(field.kernel, 1.75);
  for (const SpherePrimitive& s : primitives.spheres)
    field.balls.push_back({s.center, 1.75f * s.radius, 1, s.color, s.id});
  const BoundingSphere bounds = primitives.bounds();
  expectSame(field, primitives.origin,
             test::viewOfBall(GetParam(), kSize, bounds.center, bounds.radius * 1.1), "ubiquitin");
}

INSTANTIATE_TEST_SUITE_P(Views, PovrayBlob,
                         testing::Values(Projection::perspective, Projection::orthographic),
                         [](const auto& view) {
                           return view.param == Projection::perspective ? "Perspective" : "Orthographic";
                         });

}  // namespace
}  // namespace meniscus

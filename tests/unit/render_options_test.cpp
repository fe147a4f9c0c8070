#include "app/render_options.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace meniscus {
namespace {

RenderOptions parse(std::vector<std::string> more) {
  std::vector<std::string> arguments{"in.pdb", "-o", "out.png"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return parseRenderOptions(arguments).value();
}

std::string errorOf(const std::vector<std::string>& arguments) {
  try {
    parseRenderOptions(arguments);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no error";
}

TEST(RenderOptions, haveTheDefaultsOfTheHelp) {
  const RenderOptions options = parse({});
  EXPECT_EQ(options.files, std::vector<std::string>{"in.pdb"});
  EXPECT_EQ(options.output, "out.png");
  EXPECT_EQ(options.size, (ImageSize{1024, 768}));
  EXPECT_EQ(options.samples, 16);
  EXPECT_EQ(options.representation, Representation::spacefill);
  EXPECT_EQ(options.probability, 0.5);
  EXPECT_EQ(options.coloring.scheme, ColorScheme::element);
  EXPECT_EQ(options.radii, RadiusSet::bondi);
  EXPECT_EQ(options.fovYDeg, 30);
  EXPECT_FALSE(options.orthographic);
  EXPECT_EQ(options.orientation.kind, Orientation::Kind::principal);
  EXPECT_EQ(options.structure.altlocs, Altlocs::first);
  EXPECT_EQ(options.structure.waters, Waters::automatic);
  EXPECT_TRUE(options.structure.hydrogens);
  EXPECT_FALSE(options.structure.model);
  EXPECT_EQ(options.backend, Backend::automatic);
  EXPECT_EQ(options.pictureOptions, "");
}

TEST(RenderOptions, takeEveryOption) {
  const RenderOptions options = parse({"--representation",
                                       "licorice",
                                       "--color",
                                       "#f00",
                                       "--carbons",
                                       "chain",
                                       "--radii",
                                       "alvarez",
                                       "--ball-scale",
                                       "0.3",
                                       "--fov",
                                       "40",
                                       "--orthographic",
                                       "--orient",
                                       "x",
                                       "--rotate",
                                       "-10,20,-.5",
                                       "--zoom",
                                       "2",
                                       "--focus",
                                       "//A",
                                       "--select",
                                       "//B",
                                       "--size=64",
                                       "--background",
                                       "black",
                                       "--samples",
                                       "4",
                                       "--dpi",
                                       "300",
                                       "--depth",
                                       "16",
                                       "--model",
                                       "all",
                                       "--altloc",
                                       "B",
                                       "--assembly",
                                       "2",
                                       "--hydrogens",
                                       "off",
                                       "--waters",
                                       "on",
                                       "--replicate",
                                       "2x1x1",
                                       "--backend",
                                       "osmesa",
                                       "--explain",
                                       "--stats",
                                       "s.json",
                                       "-q",
                                       "--stick-radius",
                                       "0.4"});
  EXPECT_EQ(options.representation, Representation::licorice);
  EXPECT_EQ(options.coloring.scheme, ColorScheme::uniform);
  EXPECT_TRUE(options.coloring.carbonsByChain);
  EXPECT_EQ(options.radii, RadiusSet::alvarez);
  EXPECT_EQ(options.ballScale, 0.3);
  EXPECT_EQ(options.stickRadius, 0.4);
  EXPECT_EQ(options.fovYDeg, 40);
  EXPECT_TRUE(options.orthographic);
  EXPECT_EQ(options.orientation.axis, 0);
  EXPECT_EQ(options.rotationDeg, glm::dvec3(-10, 20, -0.5));
  EXPECT_EQ(options.zoom, 2);
  EXPECT_EQ(options.focus, "//A");
  EXPECT_EQ(options.structure.select, "//B");
  EXPECT_EQ(options.size, (ImageSize{64, 64}));
  EXPECT_EQ(options.background.color, Rgb{0});
  EXPECT_EQ(options.samples, 4);
  EXPECT_EQ(options.dpi, 300);
  EXPECT_EQ(options.bitDepth, 16);
  EXPECT_TRUE(options.structure.allModels);
  EXPECT_EQ(options.structure.altloc, 'B');
  EXPECT_EQ(options.assembly, "2");
  EXPECT_FALSE(options.structure.hydrogens);
  EXPECT_EQ(options.structure.waters, Waters::on);
  EXPECT_EQ(options.replicate, glm::ivec3(2, 1, 1));
  EXPECT_EQ(options.backend, Backend::osmesa);
  EXPECT_TRUE(options.explain);
  EXPECT_EQ(options.statsFile, "s.json");
  EXPECT_TRUE(options.quiet);
}

TEST(RenderOptions, takeWhatASurfaceCanBeTold) {
  EXPECT_EQ(parse({}).surface, SurfaceSettings{});
  EXPECT_EQ(parse({}).surfaceShape.blend, 2);
  EXPECT_FALSE(parse({}).surfaceShape.level);
  const RenderOptions options =
      parse({"--representation", "surface", "--blend", "1.5", "--kernel", "power:4", "--level", "0.3",
             "--show", "(HEM)=licorice", "--show", "//A/1=spacefill"});
  EXPECT_EQ(options.representation, Representation::surface);
  EXPECT_EQ(options.surfaceShape.blend, 1.5);
  EXPECT_EQ(options.surfaceShape.kernel, (Kernel{KernelShape::power, 4}));
  EXPECT_EQ(options.surfaceShape.level, 0.3);
  ASSERT_EQ(options.shown.size(), 2u);
  EXPECT_EQ(options.shown[1].cid, "//A/1");
  EXPECT_EQ(options.pictureOptions,
            " --representation surface --show '(HEM)=licorice' --show //A/1=spacefill --blend 1.5 --kernel "
            "power:4 --level 0.3");
}

TEST(RenderOptions, theLastOfTwoCounts) {
  EXPECT_EQ(parse({"--zoom", "2", "--zoom", "3"}).zoom, 3);
}

TEST(RenderOptions, rememberWhatDecidesThePicture) {
  EXPECT_EQ(parse({"--color", "#f00", "--quiet", "--stats", "s.json", "--orthographic", "--focus", "it's"})
                .pictureOptions,
            " --color '#f00' --focus 'it'\\''s' --orthographic");
}

TEST(RenderOptions, sayWhatIsWrong) {
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {{}, "no input"},
      {{"in.pdb"}, "no output"},
      {{"in.pdb", "-o", "out.gif"}, "'out.gif': pictures are written as .png or .exr"},
      {{"in.pdb", "-o"}, "--output: needs a value"},
      {{"in.pdb", "-o", "out.png", "--color"}, "--color: needs a value: element"},
      {{"in.pdb", "-o", "out.png", "--colr", "chain"}, "there is no option '--colr'; did you mean --color?"},
      {{"in.pdb", "-o", "out.png", "--frobnicate"},
       "there is no option '--frobnicate'; see meniscus render --help"},
      {{"in.pdb", "-o", "out.exr", "--depth", "16"}, "--depth: is for PNG"},
      {{"in.pdb", "-o", "out.png", "--channels", "color,id"}, "--channels: is for OpenEXR"},
      {{"in.pdb", "-o", "out.exr", "--channels", "color,ids"}, "--channels:"},
      {{"in.pdb", "-o", "out.png", "--shader-dir", "/nonexistent"},
       "--shader-dir: '/nonexistent' is not a folder"},
  };
  for (const auto& [arguments, message] : cases)
    EXPECT_EQ(errorOf(arguments).substr(0, std::string(message).size()), message);
}

}  // namespace
}  // namespace meniscus

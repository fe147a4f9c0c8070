// `meniscus render --representation surface` and `--show`: what is drawn, what shapes it, what is refused.

#include "tests/cli/cli_test.h"

namespace meniscus::test {
namespace {

std::vector<std::string> surface(std::vector<std::string> more = {}) {
  more.insert(more.begin(), {"--representation", "surface"});
  return more;
}

class RenderSurface : public CliTest {};

TEST_F(RenderSurface, drawsAMetaballPerAtomAndNothingElse) {
  const nlohmann::json json = stats("c60.pdb", surface());
  const nlohmann::json& picture = json.at("pictures").at(0);
  EXPECT_EQ(picture.at("metaballs"), 60);
  EXPECT_EQ(picture.at("spheres"), 0);
  EXPECT_EQ(picture.at("cylinders"), 0);
  ASSERT_EQ(json.at("surfaces").size(), 1u);
  const nlohmann::json& counted = json.at("surfaces").at(0);
  EXPECT_GT(counted.at("pixels"), 500);
  EXPECT_GT(counted.at("pieces"), 500);
  EXPECT_EQ(counted.at("notConverged"), 0);
  EXPECT_TRUE(stats("c60.pdb").at("surfaces").empty()) << "nothing of it unless it is asked for";
  const std::string text = run({"render", molecule("c60.pdb"), "-o", "a.png", "--size", "40", "--samples",
                                "1", "--explain", "--representation", "surface"})
                               .out;
  EXPECT_NE(text.find("60 metaballs"), std::string::npos) << text;
  EXPECT_NE(text.find("Surface by "), std::string::npos) << text;
}

TEST_F(RenderSurface, isThickerAtALowerLevel) {
  const auto covered = [this](const std::vector<std::string>& more) {
    return render("c60.pdb", more).covered();
  };
  const double skin = covered(surface({"--zoom", "0.7"}));
  EXPECT_GT(skin, 0.1);
  EXPECT_GT(covered(surface({"--zoom", "0.7", "--level", "0.2"})), skin);
  EXPECT_LT(covered(surface({"--zoom", "0.7", "--level", "1.5"})), skin);
  EXPECT_EQ(covered(surface({"--level", "1000"})), 0) << "no field is as strong as that";
}

TEST_F(RenderSurface, isShapedByKernelAndBlend) {
  const Picture plain = render("c60.pdb", surface());
  EXPECT_EQ(render("c60.pdb", surface({"--blend", "2", "--kernel", "sextic"})).pixels, plain.pixels);
  EXPECT_EQ(render("c60.pdb", surface({"--surface-method", "auto"})).pixels, plain.pixels);
  for (const std::vector<std::string>& other :
       {surface({"--blend", "1.2"}), surface({"--kernel", "quartic"})})
    EXPECT_NE(render("c60.pdb", other).pixels, plain.pixels) << other.back();
}

TEST_F(RenderSurface, takesPartInTheEffects) {
  const Picture plain = render("c60.pdb", surface());
  for (const std::vector<std::string>& effect :
       {surface({"--outlines", "silhouettes"}), surface({"--depth-unsharp", "halo"}),
        surface({"--fog", "0.8"}), surface({"--occlusion", "on"})})
    EXPECT_NE(render("c60.pdb", effect).pixels, plain.pixels) << effect[2];
  const std::vector<std::string> two{"--replicate", "2x1x1", "--orient", "z"};
  std::vector<std::string> shadows = two;
  shadows.insert(shadows.end(), {"--shadows", "hard"});
  EXPECT_NE(render("c60.pdb", surface(two)).pixels, render("c60.pdb", surface(shadows)).pixels);
}

TEST_F(RenderSurface, canBeSeenThrough) {
  const std::vector<std::string> shown{"--show", "(REA)=spacefill", "--focus", "(REA)"};
  std::vector<std::string> seen = surface({"--opacity", "0.3"}), hidden = surface();
  for (std::vector<std::string>* options : {&seen, &hidden})
    options->insert(options->end(), shown.begin(), shown.end());
  EXPECT_NE(render("1cbs.cif.gz", seen).pixels, render("1cbs.cif.gz", hidden).pixels);
  const nlohmann::json json = stats("1cbs.cif.gz", seen);
  EXPECT_EQ(json.at("surfaces").at(0).at("method"), "lists") << "whatever auto takes else";
  EXPECT_GT(json.at("surfaces").at(0).at("details").at("most bytes per pixel"), 20);
  EXPECT_NE(json.at("omissions").dump().find("only lists draws layers"), std::string::npos);
}

TEST_F(RenderSurface, isWritten) {
  const Picture layers = render("c60.pdb", surface({"--channels", "distance,id,normal,depth"}), "out.exr");
  EXPECT_EQ(layers.channels, 6);
  EXPECT_EQ(render("c60.pdb", surface({"--background", "transparent"})).at(0, 0)[3], 0.0f);
}

TEST_F(RenderSurface, hidesAndIsHiddenByWhatIsShownOtherwise) {
  const nlohmann::json picture =
      stats("1cbs.cif.gz", surface({"--show", "(REA)=ball_and_stick"})).at("pictures").at(0);
  EXPECT_EQ(picture.at("spheres"), 22);
  EXPECT_EQ(picture.at("cylinders"), 22);
  EXPECT_EQ(picture.at("atoms").get<int>(), picture.at("metaballs").get<int>() + 22);
  const Picture both = render(
      "1cbs.cif.gz", {"--show", "(REA)=spacefill", "--representation", "licorice", "--focus", "(REA)"});
  EXPECT_NE(both.pixels, render("1cbs.cif.gz", {"--representation", "licorice", "--focus", "(REA)"}).pixels);
  EXPECT_NE(render("1cbs.cif.gz",
                   {"--show", "(REA)=spacefill:#0000ff", "--representation", "licorice", "--focus", "(REA)"})
                .pixels,
            both.pixels)
      << "in another colour";
  EXPECT_EQ(render("1cbs.cif.gz", {"--show", "*=spacefill", "--representation", "licorice"}).pixels,
            render("1cbs.cif.gz").pixels)
      << "all atoms shown otherwise";
}

TEST_F(RenderSurface, saysWhatIsWrong) {
  const auto expectUsage = [this](const std::vector<std::string>& options,
                                  const std::vector<std::string>& parts) {
    std::vector<std::string> arguments{"render", molecule("c60.pdb"), "-o", "a.png"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    expectError(run(arguments), ExitCode::badUsage, parts);
  };
  expectUsage({"--kernel", "cubic"}, {"--kernel", "cubic", "power:N"});
  expectUsage({"--blend", "1"}, {"--blend", "1.05"});
  expectUsage({"--level", "0"}, {"--level"});
  expectUsage({"--surface-method", "magic"}, {"--surface-method", "magic", "auto"});
  expectUsage({"--surface-method", "bezier", "--surface-option", "speed=9"},
              {"--surface-option", "speed", "tolerance"});
  expectUsage({"--surface-method", "bezier", "--surface-option", "tolerance=2"},
              {"--surface-option", "tolerance=2", "from"});
  expectUsage({"--opacity", "1.5"}, {"--opacity", "1.5"});
  expectUsage({"--opacity", "0.5", "--surface-method", "tiles"}, {"--opacity", "tiles", "lists"});
  expectUsage({"--surface-option", "speed"}, {"--surface-option", "NAME=NUMBER"});
  expectUsage({"--show", "(HEM)"}, {"--show", "CID=REPRESENTATION"});
  expectUsage({"--show", "//A/x/y/z/w=licorice"}, {"--show"});
  expectError(run({"render", molecule("1ubq.pdb"), "-o", "a.png", "--show", "(HEM)=licorice"}),
              ExitCode::badInput, {"1ubq.pdb", "--show", "(HEM)", "none of the atoms"});
}

TEST_F(RenderSurface, isExplainedInTheHelp) {
  const std::string help = run({"render", "--help"}).out;
  for (const char* part :
       {"--blend", "--kernel", "--level", "--opacity", "--surface-method", "--surface-option", "--show"})
    EXPECT_NE(help.find(part), std::string::npos) << part;
}

}  // namespace
}  // namespace meniscus::test

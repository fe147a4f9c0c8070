// Every option of `meniscus render` does what its help says.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "tests/cli/cli_test.h"
#include "tests/support/paths.h"

namespace meniscus::test {
namespace {

class RenderOption : public CliTest {};

TEST_F(RenderOption, sizeIsWidthTimesHeightOrASquare) {
  const Picture wide = render(kProtein, {"--size", "50x31"});
  EXPECT_EQ(wide.width, 50);
  EXPECT_EQ(wide.height, 31);
  const Picture square = render(kProtein, {"--size", "40"});
  EXPECT_EQ(square.width, 40);
  EXPECT_EQ(square.height, 40);
  const Picture pixel = render(kProtein, {"--size", "1x1"});
  EXPECT_EQ(pixel.width, 1);
}

TEST_F(RenderOption, backgroundIsAColorOrTransparent) {
  const auto corner = [this](const std::vector<std::string>& more) {
    const auto [r, g, b, a] = render(kProtein, more).at(0, 0);
    EXPECT_EQ(a, 1);
    return std::array{std::lround(r * 255), std::lround(g * 255), std::lround(b * 255)};
  };
  EXPECT_EQ(corner({}), (std::array{255L, 255L, 255L}));
  EXPECT_EQ(corner({"--background", "white"}), (std::array{255L, 255L, 255L}));
  EXPECT_EQ(corner({"--background", "black"}), (std::array{0L, 0L, 0L}));
  EXPECT_EQ(corner({"--background", "#f00"}), (std::array{255L, 0L, 0L}));
  EXPECT_EQ(corner({"--background", "#336699"}), (std::array{0x33L, 0x66L, 0x99L}));
  const Picture transparent = render(kProtein, {"--background", "transparent"});
  EXPECT_EQ(transparent.channels, 4);
  EXPECT_EQ(transparent.at(0, 0)[3], 0);
  EXPECT_EQ(transparent.at(32, 24)[3], 1);
}

TEST_F(RenderOption, samplesSmoothEdges) {
  const auto levels = [this](const std::string& samples) {
    const Picture picture = render("c60.pdb", {"--background", "transparent", "--samples", samples});
    int between = 0;
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x) between += picture.at(x, y)[3] > 0 && picture.at(x, y)[3] < 1;
    return between;
  };
  EXPECT_EQ(levels("1"), 0);
  EXPECT_GT(levels("4"), 20);
}

TEST_F(RenderOption, depthIsBitsPerChannel) {
  EXPECT_EQ(usual().bits, 8);
  EXPECT_EQ(render(kProtein, {"--depth", "8"}).bits, 8);
  const Picture deep = render(kProtein, {"--depth", "16"});
  EXPECT_EQ(deep.bits, 16);
  EXPECT_NEAR(deep.covered(), usual().covered(), 1e-9);
}

TEST_F(RenderOption, dpiIsRecorded) {
  EXPECT_EQ(usual().text.count("XResolution"), 0u);
  const Picture picture = render(kProtein, {"--dpi", "300"});
  const double perUnit = std::stod(picture.text.at("XResolution"));
  EXPECT_NEAR(picture.text.at("ResolutionUnit") == "m" ? perUnit * 0.0254 : perUnit, 300, 0.01);
}

TEST_F(RenderOption, outputMayBeExr) {
  const Picture picture = render(kProtein, {"--background", "transparent"}, "out.exr");
  EXPECT_EQ(picture.bits, 16);
  EXPECT_EQ(picture.channels, 4);
  EXPECT_EQ(picture.at(0, 0)[3], 0);
  EXPECT_EQ(picture.at(32, 24)[3], 1);
}

TEST_F(RenderOption, channelsAreTheLayersOfAnExr) {
  const Picture layers = render(kProtein, {"--channels", "color,albedo,normal,depth,distance,id"}, "out.exr");
  EXPECT_EQ(layers.channels, 12);
  EXPECT_EQ(layers.bits, 32);
  EXPECT_EQ(render(kProtein, {"--channels", "depth"}, "z.exr").channels, 1);
  EXPECT_EQ(render(kProtein, {"--channels", "color"}).channels, 3) << "a PNG holds the colour";
  EXPECT_EQ(render(kProtein, {"--channels", "color"}, "c.exr").pixels, render(kProtein, {}, "d.exr").pixels);
  expectError(run({"render", molecule(kProtein), "-o", "a.png", "--channels", "color,depth"}),
              ExitCode::badUsage, {"--channels", ".exr"});
  expectError(run({"render", molecule(kProtein), "-o", "a.exr", "--channels", "ids"}), ExitCode::badUsage,
              {"--channels", "ids", "albedo"});
}

TEST_F(RenderOption, representationChangesWhatIsDrawn) {
  const nlohmann::json spacefill = stats(kProtein);
  EXPECT_GT(spacefill["pictures"][0]["spheres"], 600);
  EXPECT_EQ(spacefill["pictures"][0]["cylinders"], 0);
  const double covered = readPicture(folder_ / "out.png").covered();
  for (const char* name : {"ball_and_stick", "licorice"}) {
    const nlohmann::json json = stats(kProtein, {"--representation", name});
    EXPECT_EQ(json["pictures"][0]["spheres"], spacefill["pictures"][0]["spheres"]);
    EXPECT_GT(json["pictures"][0]["cylinders"], 600);
    EXPECT_GT(json["pictures"][0]["bonds"], 600);
    EXPECT_LT(readPicture(folder_ / "out.png").covered(), covered);
  }
}

TEST_F(RenderOption, colorSchemesDiffer) {
  std::map<std::vector<float>, std::string> seen;
  for (const char* scheme : {"element", "chain", "residue", "bfactor", "plddt", "rainbow"}) {
    const auto [entry, added] = seen.emplace(render(kProtein, {"--color", scheme}).pixels, scheme);
    EXPECT_TRUE(added) << scheme << " looks like " << entry->second;
  }
  EXPECT_EQ(usual().pixels, render(kProtein, {"--colour", "element"}).pixels);
}

TEST_F(RenderOption, colorMayBeOneForAll) {
  const Picture picture = render(kProtein, {"--color", "#00f", "--background", "black"});
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const auto [r, g, b, a] = picture.at(x, y);
      EXPECT_EQ(r, g);
      EXPECT_GE(b, r);
    }
  EXPECT_GT(picture.at(32, 24)[2], 0.3);
}

TEST_F(RenderOption, carbonsMayTakeTheirChainsColor) {
  const Picture picture = render(kProtein, {"--carbons", "chain"});
  EXPECT_NE(picture.pixels, usual().pixels);
  EXPECT_NE(picture.pixels, render(kProtein, {"--color", "chain"}).pixels);
  EXPECT_EQ(render(kProtein, {"--carbons", "element"}).pixels, usual().pixels);
}

TEST_F(RenderOption, radiiAndScalesChangeSizes) {
  EXPECT_EQ(render(kProtein, {"--radii", "bondi"}).pixels, usual().pixels);
  EXPECT_NE(render(kProtein, {"--radii", "alvarez"}).pixels, usual().pixels);
  const auto covered = [this](std::vector<std::string> more) {
    more.insert(more.end(), {"--representation", "ball_and_stick", "--size", "160x120"});
    return render("adrenaline.pdb", more).covered();
  };
  EXPECT_GT(covered({"--ball-scale", "0.4"}), covered({}));
  EXPECT_GT(covered({"--stick-radius", "0.25"}), covered({}));
}

TEST_F(RenderOption, orientAndRotateTurn) {
  const auto pixels = [this](std::vector<std::string> more) {
    more.push_back("--orthographic");
    return render(kProtein, more).pixels;
  };
  EXPECT_EQ(pixels({"--orient", "principal"}), pixels({}));
  const std::vector<float> alongX = pixels({"--orient", "x"}), alongZ = pixels({"--orient", "z"});
  EXPECT_EQ(alongZ, pixels({"--orient", "1,0,0,0"}));
  EXPECT_EQ(alongZ, pixels({"--orient", "-2,0,0,0"}));
  EXPECT_NE(alongX, pixels({"--orient", "y"}));
  EXPECT_NE(alongX, alongZ);
  EXPECT_NE(pixels({"--orient", "z", "--rotate", "0,0,90"}), alongZ);
  EXPECT_NE(pixels({"--orient", "z", "--rotate", "-30,0,0"}),
            pixels({"--orient", "z", "--rotate", "30,0,0"}));
}

TEST_F(RenderOption, zoomAndFocusMagnify) {
  EXPECT_GT(render(kProtein, {"--zoom", "2"}).covered(), usual().covered());
  EXPECT_LT(render(kProtein, {"--zoom", "0.5"}).covered(), usual().covered());
  EXPECT_GT(render(kProtein, {"--focus", "//A/20-25"}).covered(), usual().covered());
}

TEST_F(RenderOption, fovAndOrthographicChangeThePerspective) {
  EXPECT_EQ(render(kProtein, {"--fov", "30"}).pixels, usual().pixels);
  EXPECT_NE(render(kProtein, {"--fov", "90"}).pixels, usual().pixels);
  EXPECT_NE(render(kProtein, {"--orthographic"}).pixels, usual().pixels);
}

TEST_F(RenderOption, selectDrawsAPart) {
  const nlohmann::json all = stats(kProtein), part = stats(kProtein, {"--select", "//A/1-10"}),
                       alphas = stats(kProtein, {"--select", "//A/1-10/CA[C]"});
  EXPECT_LT(part["pictures"][0]["atoms"], all["pictures"][0]["atoms"]);
  EXPECT_EQ(alphas["pictures"][0]["atoms"], 10);
}

TEST_F(RenderOption, hideLeavesAPartOut) {
  const auto spheres = [&](const std::vector<std::string>& more) {
    return stats(kProtein, more)["pictures"][0]["spheres"].get<int>();
  };
  const int all = spheres({}), part = spheres({"--select", "//A/1-10"});
  EXPECT_EQ(spheres({"--hide", "//A/1-10"}), all - part);
  EXPECT_EQ(spheres({"--hide", "//A/1-10", "--show", "//A/1-10=licorice", "--hide", "//A/5"}), all - part);
  expectError(run({"render", molecule(kProtein), "-o", "x.png", "--hide", "//Q"}), ExitCode::badInput,
              {"--hide '//Q'", "matches none"});
  expectError(run({"render", molecule(kProtein), "-o", "x.png", "--hide", "/*"}), ExitCode::badInput,
              {"--hide leaves nothing"});
}

TEST_F(RenderOption, targetDistanceAndNearMakeACamera) {
  const std::vector<std::string> given{"--orient", "1,0,0,0", "--target", "30,30,15", "--distance", "80"};
  const Picture picture = render(kProtein, given);
  EXPECT_GT(picture.covered(), 0.05);
  std::vector<std::string> farther = given, cut = given;
  farther.back() = "160";
  cut.insert(cut.end(), {"--near", "200"});
  EXPECT_LT(render(kProtein, farther).covered(), 0.5 * picture.covered());
  EXPECT_EQ(render(kProtein, cut).covered(), 0);
}

// Of the pixels' own rays: what they meet and how far along the axis of sight.
TEST_F(RenderOption, farCutsOffWhatIsFartherAndNothingElse) {
  constexpr float kPlane = 80;
  const std::vector<std::vector<std::string>> ways{
      {"--quadrics", "tiles"},
      {"--representation", "ball_and_stick", "--quadrics", "splat", "--orthographic"},
      {"--representation", "cartoon"},
      {"--representation", "surface", "--surface-method", "lists"},
      {"--representation", "surface", "--surface-method", "tiles"},
      {"--representation", "surface", "--surface-method", "newton"},
      {"--representation", "surface", "--surface-method", "bezier"},
      {"--representation", "surface", "--surface-method", "bvh", "--orthographic"},
      {"--representation", "surface", "--surface-method", "mesh"}};
  for (std::vector<std::string> way : ways) {
    way.insert(way.end(),
               {"--orient", "1,0,0,0", "--target", "30,30,15", "--distance", "80", "--channels", "depth,id"});
    // Depth is that of the eye's plane, and without perspective that of the near plane.
    const bool flat = std::find(way.begin(), way.end(), "--orthographic") != way.end();
    if (flat) way.insert(way.end(), {"--near", "70"});
    const float plane = flat ? kPlane - 70 : kPlane;
    const Picture whole = render(kProtein, way, "whole.exr");
    way.insert(way.end(), {"--far", std::to_string(kPlane)});
    const Picture cut = render(kProtein, way, "cut.exr");
    ASSERT_EQ(whole.channels, 2);
    int gone = 0, left = 0;
    for (std::size_t i = 0; i < whole.pixels.size(); i += 2) {
      const float depth = whole.pixels[i], id = whole.pixels[i + 1];
      if (id == 0 || std::abs(depth - plane) < 1e-3f) continue;
      ++(depth < plane ? left : gone);
      EXPECT_EQ(cut.pixels[i + 1], depth < plane ? id : 0) << way[1] << " " << way[3] << " " << depth;
      if (depth < plane) {
        EXPECT_NEAR(cut.pixels[i], depth, 1e-3f);
      }
    }
    EXPECT_GT(gone, 20) << way[3];
    EXPECT_GT(left, 20) << way[3];
  }
}

TEST_F(RenderOption, farLeavesNothingOfLayersLabelsAndWhatLiesBehindIt) {
  const std::vector<std::string> skin{"--representation", "surface",           "--opacity", "0.4",
                                      "--label",          "//A/1=far and near"};
  const auto with = [&](const std::string& far) {
    std::vector<std::string> words = skin;
    words.insert(words.end(),
                 {"--orient", "1,0,0,0", "--target", "30,30,15", "--distance", "80", "--far", far});
    return render(kProtein, words);
  };
  const Picture all = with("1000"), half = with("80");
  EXPECT_EQ(with("1").covered(), 0);
  EXPECT_GT(half.covered(), 0.05);
  EXPECT_NE(half.pixels, all.pixels);
  expectError(run({"render", molecule(kProtein), "-o", "x.png", "--near", "5", "--far", "5"}),
              ExitCode::badUsage, {"--far", "nothing is seen"});
}

TEST_F(RenderOption, lightDirectionTurnsTheLight) {
  const auto brightness = [&](const char* direction) {
    double left = 0, right = 0;
    const Picture picture = render("c60.pdb", {"--light-direction", direction});
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x)
        (x < picture.width / 2 ? left : right) += static_cast<double>(picture.at(x, y)[0]);
    return left - right;
  };
  EXPECT_GT(brightness("1,0,-0.2"), 10);
  EXPECT_LT(brightness("-1,0,-0.2"), -10);
}

TEST_F(RenderOption, panelsAreThoseOptionsSeenByOneCamera) {
  const std::vector<std::string> camera{"--size", "64x48",      "--orient", "1,0,0,0",      "--target",
                                        "0,0,0",  "--distance", "30",       "--label-size", "0.1"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), camera.begin(), camera.end());
    return render("c60.pdb", more);
  };
  const Picture balls = with({"--representation", "ball_and_stick"}),
                skin = with({"--representation", "surface"});
  const Picture both = with({"--panel", "--representation ball_and_stick", "--panel",
                             "--representation surface", "--divider", "0.5"});
  for (int y = 0; y < both.height; ++y) {
    for (int x = 0; x < 32; ++x) EXPECT_EQ(both.at(x, y), balls.at(x, y)) << x << " " << y;
    for (int x = 34; x < 64; ++x) EXPECT_EQ(both.at(x, y), skin.at(x, y)) << x << " " << y;
  }
}

TEST_F(RenderOption, anErrorPanelComparesTheFirstTwo) {
  const auto colors = [&](const std::string& method) {
    const Picture picture =
        render("c60.pdb", {"--size", "288x96", "--label-size", "0.1", "--background", "black",
                           "--representation", "surface", "--panel", "--surface-method tiles", "--panel",
                           "--surface-method " + method, "--panel", "error"});
    std::map<std::array<int, 3>, int> counts;  // in a part without labels and scale
    for (int y = 20; y < 80; ++y) {
      for (int x = 220; x < 270; ++x) {
        const auto pixel = picture.at(x, y);
        ++counts[{static_cast<int>(std::lround(255 * pixel[0])),
                  static_cast<int>(std::lround(255 * pixel[1])),
                  static_cast<int>(std::lround(255 * pixel[2]))}];
      }
    }
    return counts;
  };
  const std::array<int, 3> none{0x44, 0x01, 0x54};
  const auto same = colors("tiles");
  EXPECT_GT(same.at(none), 400);
  EXPECT_LE(same.size(), 2u) << "no error, or the background";
  const auto mesh = colors("mesh");
  EXPECT_GT(mesh.size(), 50u) << "an error of its own nearly everywhere";
}

TEST_F(RenderOption, watersAreLeftOutUnlessAlone) {
  const auto atoms = [this](std::vector<std::string> more) -> int {
    return stats(kProtein, more)["pictures"][0]["atoms"];
  };
  EXPECT_EQ(atoms({"--waters", "on"}), 660);
  EXPECT_EQ(atoms({"--waters", "off"}), 602);
  EXPECT_EQ(atoms({"--waters", "auto"}), 602);
  EXPECT_EQ(atoms({}), 602);
}

TEST_F(RenderOption, hydrogensMayBeLeftOut) {
  const auto atoms = [this](std::vector<std::string> more) -> int {
    return stats("1d3z.pdb.gz", more)["pictures"][0]["atoms"];
  };
  EXPECT_EQ(atoms({"--hydrogens", "on"}), atoms({}));
  EXPECT_LT(atoms({"--hydrogens", "off"}), atoms({}) * 2 / 3);
}

TEST_F(RenderOption, altlocChoosesAlternateLocations) {
  const std::string head = "ATOM      1  N   ALA A   1       0.000   0.000   0.000  1.00  1.00           N\n";
  writeFile(folder_ / "alt.pdb",
            head +
                "ATOM      2  CA AALA A   1       1.500   0.000   0.000  0.60  1.00           C\n"
                "ATOM      3  CA BALA A   1       1.200   0.900   0.000  0.40  1.00           C\nEND\n");
  const auto atoms = [this](const std::vector<std::string>& more) -> int {
    std::vector<std::string> arguments{"render", "alt.pdb", "-o",      "out.png", "-q",
                                       "--size", "8",       "--stats", "s.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    expectSuccess(run(arguments));
    return nlohmann::json::parse(readFile(folder_ / "s.json"))["pictures"][0]["atoms"];
  };
  EXPECT_EQ(atoms({}), 2);
  EXPECT_EQ(atoms({"--altloc", "first"}), 2);
  EXPECT_EQ(atoms({"--altloc", "B"}), 2);
  EXPECT_EQ(atoms({"--altloc", "all"}), 3);
}

TEST_F(RenderOption, modelChoosesAModelOrAll) {
  const nlohmann::json first = stats("1d3z.pdb.gz");
  const std::vector<float> firstPixels = readPicture(folder_ / "out.png").pixels;
  EXPECT_EQ(render("1d3z.pdb.gz", {"--model", "1"}).pixels, firstPixels);
  EXPECT_NE(render("1d3z.pdb.gz", {"--model", "2"}).pixels, firstPixels);
  const nlohmann::json all = stats("1d3z.pdb.gz", {"--model", "all"});
  EXPECT_EQ(all["pictures"][0]["atoms"], 10 * first["pictures"][0]["atoms"].get<int>());
}

TEST_F(RenderOption, assemblyAndReplicatePlaceCopies) {
  const auto spheres = [this](const std::string& file, const std::vector<std::string>& more) -> int {
    return stats(file, more)["pictures"][0]["spheres"];
  };
  EXPECT_EQ(spheres("c60.pdb", {"--replicate", "2x3x1"}), 360);
  const int once = spheres("1a8o.cif.gz", {});
  EXPECT_EQ(spheres("1a8o.cif.gz", {"--assembly", "1"}), 2 * once);
  EXPECT_EQ(spheres("1a8o.cif.gz", {"--assembly", "1", "--replicate", "1x1x2"}), 4 * once);
}

// 67,000 atoms in a picture of 30 pixels.
TEST_F(RenderOption, levelOfDetailKeepsWhatIsCovered) {
  struct Drawn {
    Picture picture;
    std::string omissions;
    double covered = 0;
  };
  const auto drawn = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"--assembly", "1", "--replicate", "5x4x3", "--size", "36x30", "--samples", "64",
                             "--background", "transparent", "--quadrics", "tiles", "--stats", "stats.json"});
    Drawn made{render("1a8o.cif.gz", more), {}};
    made.omissions =
        nlohmann::json::parse(readFile(folder_ / "stats.json"), nullptr, false)["omissions"].dump();
    for (int y = 0; y < made.picture.height; ++y)
      for (int x = 0; x < made.picture.width; ++x)
        made.covered += static_cast<double>(made.picture.at(x, y)[3]);
    return made;
  };
  const Drawn usual = drawn({}), all = drawn({"--level-of-detail", "off"}),
              on = drawn({"--level-of-detail", "on"});
  EXPECT_EQ(usual.picture.pixels, on.picture.pixels);
  EXPECT_NE(usual.picture.pixels, all.picture.pixels);
  EXPECT_NE(usual.omissions.find("balls stand for"), std::string::npos);
  EXPECT_EQ(all.omissions.find("balls stand for"), std::string::npos);
  EXPECT_GT(all.covered, 100);
  EXPECT_NEAR(usual.covered / all.covered, 1, 0.02);
}

TEST_F(RenderOption, copiesShareMemoryAndLookAsEachByItself) {
  const std::vector<std::string> many{"--assembly", "1",       "--replicate", "5x4x3",
                                      "--size",     "400x300", "--channels",  "id,distance"};
  const auto drawn = [&](const char* quadrics) {
    std::vector<std::string> more = many;
    more.insert(more.end(), {"--quadrics", quadrics, "--stats", "stats.json"});
    return render("1a8o.cif.gz", more, "out.exr");
  };
  const Picture tiles = drawn("tiles");
  const nlohmann::json picture =
      nlohmann::json::parse(readFile(folder_ / "stats.json"), nullptr, false)["pictures"][0];
  EXPECT_EQ(picture["copies"], 120);
  EXPECT_EQ(picture["spheres"], 120 * picture["atoms"].get<int>());
  EXPECT_LT(picture["quadricBytes"], 100'000);
  const Picture splatted = drawn("splat");  // draws every copy by itself
  ASSERT_EQ(tiles.channels, 2);
  ASSERT_EQ(tiles.pixels.size(), splatted.pixels.size());
  int different = 0, covered = 0;
  for (std::size_t i = 0; i < tiles.pixels.size(); i += 2) {
    bool same = true;
    for (std::size_t c = i; c < i + 2; ++c)
      same = same && (tiles.pixels[c] == splatted.pixels[c] ||
                      std::abs(tiles.pixels[c] / splatted.pixels[c] - 1) < 4e-6f);
    different += !same;
    covered += std::isfinite(tiles.pixels[i]) && std::isfinite(tiles.pixels[i + 1]);
  }
  EXPECT_LE(different, 400 * 300 / 100000);
  EXPECT_GT(covered, 30000);
}

TEST_F(RenderOption, backendChoosesTheWayToOpenGl) {
  EXPECT_TRUE(stats(kProtein, {"--backend", "egl"})["backend"].get<std::string>().starts_with("EGL"));
  EXPECT_EQ(stats(kProtein, {"--backend", "osmesa"})["backend"], "OSMesa");
}

TEST_F(RenderOption, shaderDirReplacesTheShaders) {
  EXPECT_EQ(render(kProtein, {"--shader-dir", projectFile("shaders")}).pixels, usual().pixels);
}

TEST_F(RenderOption, statsHoldWhatWasDoneAndTheCost) {
  const nlohmann::json json = stats(kProtein);
  for (const char* key :
       {"version", "backend", "renderer", "width", "height", "samples", "pictures", "failures", "seconds",
        "cpuSeconds", "peakMemoryBytes", "tiles", "passes", "omissions", "programs", "buffers", "textures"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["width"], 64);
  EXPECT_EQ(json["pictures"][0]["output"], "out.png");
  EXPECT_FALSE(json["passes"].empty());
  EXPECT_FALSE(json["omissions"].empty());
  double sum = 0;
  for (const char* key :
       {"parse", "bonds", "primitives", "context", "upload", "compile", "draw", "readback", "encode"}) {
    ASSERT_TRUE(json["seconds"].contains(key)) << key;
    EXPECT_GE(json["seconds"][key], 0);
    sum += json["seconds"][key].get<double>();
  }
  EXPECT_LE(sum, json["seconds"]["total"].get<double>());
  EXPECT_EQ(json["seconds"]["bonds"], 0) << "bonds are not looked for where none are drawn";
  double passes = 0;
  for (const auto& pass : json["passes"]) passes += pass["milliseconds"].get<double>();
  EXPECT_GT(passes, 0) << "as --explain times them";
}

TEST_F(RenderOption, explainSaysWhatRanAndWhatDidNot) {
  const ProcessResult result =
      run({"render", molecule(kProtein), "-o", "out.png", "-q", "--size", "64x48", "--explain"});
  expectSuccess(result);
  for (const char* part : {"602 atoms", "What ran", "What was left out", "cylinders", "Programs", "Buffers",
                           "Textures", "encode", "total"})
    EXPECT_NE(result.out.find(part), std::string::npos) << part << " is not in:\n" << result.out;
}

TEST_F(RenderOption, quietLeavesOutNotes) {
  writeFile(folder_ / "odd.pdb", "HETATM    1  XX  LIG A   1       0.000   0.000   0.000\n");
  const ProcessResult noted = run({"render", "odd.pdb", "-o", "out.png", "--size", "8"});
  EXPECT_EQ(noted.exitCode, 0);
  EXPECT_TRUE(noted.err.starts_with("meniscus: odd.pdb: note: ")) << noted.err;
  expectSuccess(run({"render", "odd.pdb", "-o", "out.png", "--size", "8", "--quiet"}));
}

TEST_F(RenderOption, metadataHoldCommandAndVersion) {
  const Picture picture = render(kProtein, {"--color", "#f00"});
  EXPECT_EQ(picture.text.at("Software"), "Meniscus " MENISCUS_VERSION);
  EXPECT_EQ(picture.text.at("Comment"), "meniscus render 1ubq.pdb --size 64x48 --samples 1 --color '#f00'");
}

TEST_F(RenderOption, helpShowsEveryOption) {
  const ProcessResult result = run({"render", "--help"});
  expectSuccess(result);
  for (const char* option : {"--output",
                             "--size",
                             "--background",
                             "--samples",
                             "--depth",
                             "--channels",
                             "--dpi",
                             "--representation",
                             "--color",
                             "--carbons",
                             "--radii",
                             "10.1021/j100785a001",
                             "10.1039/c3dt50599e",
                             "--ball-scale",
                             "--stick-radius",
                             "--shadows",
                             "--penumbra",
                             "--shadow-samples",
                             "--outlines",
                             "--line-width",
                             "--line-color",
                             "--line-strength",
                             "--line-gap",
                             "--crease-angle",
                             "--depth-unsharp",
                             "--unsharp-strength",
                             "--unsharp-radius",
                             "--fog",
                             "--fog-start",
                             "--fog-end",
                             "--orient",
                             "--rotate",
                             "--zoom",
                             "--focus",
                             "--fov",
                             "--orthographic",
                             "--select",
                             "--model",
                             "--assembly",
                             "--altloc",
                             "--hydrogens",
                             "--waters",
                             "--replicate",
                             "--backend",
                             "--explain",
                             "--stats",
                             "--shader-dir",
                             "--quiet",
                             "{stem}",
                             "{model}",
                             "Examples:"})
    EXPECT_NE(result.out.find(option), std::string::npos) << option;
  EXPECT_EQ(run({"help", "render"}).out, result.out);
}

}  // namespace
}  // namespace meniscus::test

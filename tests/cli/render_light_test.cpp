// Options of light and the effects that need it.

#include <filesystem>
#include <fstream>
#include <numeric>

#include "tests/cli/cli_test.h"

namespace meniscus::test {
namespace {

class RenderLight : public CliTest {
 protected:
  // Mean of all channels but alpha.
  static double brightness(const Picture& picture) {
    return std::accumulate(picture.pixels.begin(), picture.pixels.end(), 0.0) /
           static_cast<double>(picture.pixels.size());
  }
  static std::vector<std::string> passes(const nlohmann::json& stats) {
    std::vector<std::string> names;
    for (const auto& pass : stats.at("passes")) names.push_back(pass.at("name"));
    return names;
  }
};

TEST_F(RenderLight, shadowsDarkenAndCostNothingWhenOff) {
  const Picture& off = usual();
  const Picture hard = render(kProtein, {"--shadows", "hard"});
  const Picture soft = render(kProtein, {"--shadows", "soft"});
  EXPECT_EQ(render(kProtein, {"--shadows", "off"}).pixels, off.pixels);
  EXPECT_LT(brightness(hard), brightness(off));
  EXPECT_LT(brightness(soft), brightness(off));
  EXPECT_NE(hard.pixels, soft.pixels);
  EXPECT_EQ(render(kProtein, {"--shadows", "soft"}).pixels, soft.pixels)
      << "the same command, the same picture";

  EXPECT_EQ(passes(stats(kProtein, {"--quadrics", "splat"})), (Names{"spheres", "shade"}));
  EXPECT_EQ(passes(stats(kProtein, {"--shadows", "hard", "--quadrics", "splat"})),
            (Names{"shadow map: spheres", "spheres", "shadow", "shade"}));
}

TEST_F(RenderLight, penumbraAndShadowSamplesChangeSoftShadowsOnly) {
  const auto pixels = [this](const char* mode, const char* option, const char* value) {
    return render(kProtein, {"--shadows", mode, option, value}).pixels;
  };
  EXPECT_NE(pixels("soft", "--penumbra", "1"), pixels("soft", "--penumbra", "6"));
  EXPECT_NE(pixels("soft", "--shadow-samples", "1"), pixels("soft", "--shadow-samples", "256"));
  EXPECT_EQ(pixels("hard", "--penumbra", "1"), pixels("hard", "--penumbra", "6"));
  for (const char* extreme : {"0", "1000"}) render(kProtein, {"--shadows", "soft", "--penumbra", extreme});
}

TEST_F(RenderLight, occlusionDarkensByRadiusAndStrength) {
  const auto light = [this](const std::vector<std::string>& more) {
    std::vector<std::string> options{"--occlusion", "on"};
    options.insert(options.end(), more.begin(), more.end());
    return brightness(render(kProtein, options));
  };
  EXPECT_EQ(render(kProtein, {"--occlusion", "off", "--occlusion-radius", "4"}).pixels, usual().pixels);
  const double full = light({}), half = light({"--occlusion-strength", "0.5"});
  EXPECT_LT(full, half);
  EXPECT_LT(half, light({"--occlusion-strength", "0"}));
  EXPECT_LT(light({"--occlusion-radius", "0"}), full);
  EXPECT_LT(full, light({"--occlusion-radius", "4"}));
  EXPECT_NEAR(light({"--occlusion-directions", "128"}), light({"--occlusion-directions", "32"}), 0.01);
  EXPECT_EQ(passes(stats(kProtein, {"--occlusion", "on", "--quadrics", "splat"})),
            (std::vector<std::string>{"occlusion maps", "spheres", "occlusion", "shade"}));
}

TEST_F(RenderLight, tracedRaysTakeThePlaceOfMaps) {
  const std::vector<std::string> maps{"--occlusion", "on", "--occlusion-radius", "0", "--shadows", "hard"};
  std::vector<std::string> rays = maps;
  for (const char* more : {"--trace-ao", "64", "--trace-shadows", "1"}) rays.push_back(more);
  EXPECT_NEAR(brightness(render(kProtein, rays)), brightness(render(kProtein, maps)), 0.02);
  EXPECT_EQ(render(kProtein, {"--trace-ao", "8"}).pixels,
            render(kProtein, {"--trace-ao", "8", "--occlusion", "on"}).pixels)
      << "what is traced is on";
  const std::vector<std::string> mirror{"--representation",   "surface", "--reflect", "1",
                                        "--refractive-index", "4"};
  std::vector<std::string> grey = mirror;
  for (const char* more : {"--environment", "background"}) grey.push_back(more);
  EXPECT_NE(render(kProtein, mirror).pixels, render(kProtein, grey).pixels);
  EXPECT_EQ(passes(stats(kProtein, grey)), (std::vector<std::string>{"surface", "trace", "shade"}));
  std::ofstream(folder_.path() / "white.hdr", std::ios::binary)
      << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80\x80\x80\x81\x80\x80\x80\x81";
  std::vector<std::string> white = mirror;
  for (const char* more : {"--environment", "white.hdr"}) white.push_back(more);
  EXPECT_EQ(render(kProtein, white).pixels, render(kProtein, grey).pixels) << "as the background is";
  std::vector<std::string> glass{"--representation", "surface", "--refract", "4"}, red = glass;
  for (const char* more : {"--attenuation-colour", "#ff4040", "--attenuation-distance", "5"})
    red.push_back(more);
  EXPECT_LT(brightness(render(kProtein, red)), brightness(render(kProtein, glass)));
  white.back() = "none.hdr";
  white.insert(white.begin(), {"render", molecule(kProtein), "-o", "a.png"});
  expectError(run(white), ExitCode::badInput, {"none.hdr"});
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "a.png"));
  expectError(run({"render", molecule(kProtein), "-o", "a.png", "--representation", "surface", "--refract",
                   "2", "--opacity", "0.5"}),
              ExitCode::badUsage, {"--opacity", "--refract"});
}

TEST_F(RenderLight, wrongValuesNameWhatIsAllowed) {
  const auto refused = [this](const char* option, const char* value, const char* allowed) {
    expectError(run({"render", molecule(kProtein), "-o", "a.png", option, value}), ExitCode::badUsage,
                {option, value, allowed});
  };
  refused("--shadows", "on", "soft");
  refused("--penumbra", "-1", "0");
  refused("--shadow-samples", "0", "256");
  refused("--occlusion", "maybe", "off");
  refused("--occlusion-radius", "-1", "0");
  refused("--occlusion-strength", "2", "1");
  refused("--occlusion-directions", "9", "128");
  refused("--trace-ao", "5000", "4096");
  refused("--trace-shadows", "-1", "0");
  refused("--reflect", "17", "16");
  refused("--refract", "some", "16");
  refused("--refractive-index", "0.5", "10");
  refused("--attenuation-color", "green", "#RRGGBB");
  refused("--attenuation-distance", "0", "0.01");
  refused("--environment", "moon", "sky");
  refused("--environment", "moon.gif", ".hdr");
}

}  // namespace
}  // namespace meniscus::test

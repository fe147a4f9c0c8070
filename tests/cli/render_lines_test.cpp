// Options of outlines, depth unsharp masking and fog.

#include <numeric>

#include "tests/cli/cli_test.h"

namespace meniscus::test {
namespace {

using Options = std::vector<std::string>;

class RenderLines : public CliTest {
 protected:
  static double brightness(const Picture& picture) {
    return std::accumulate(picture.pixels.begin(), picture.pixels.end(), 0.0) /
           static_cast<double>(picture.pixels.size());
  }
  double brightness(const Options& options) const { return brightness(render(kProtein, options)); }
  std::vector<float> pixels(const Options& options) const { return render(kProtein, options).pixels; }
};

TEST_F(RenderLines, outlinesDarkenAndCostNothingWhenOff) {
  const double off = brightness(usual());
  EXPECT_EQ(pixels({"--outlines", "off"}), usual().pixels);
  const double silhouettes = brightness({"--outlines", "silhouettes"});
  const double both = brightness({"--outlines", "silhouettes,creases"});
  const double atoms = brightness({"--outlines", "silhouettes,atoms"});
  EXPECT_LT(silhouettes, off);
  EXPECT_LT(both, silhouettes);
  EXPECT_LT(atoms, silhouettes);
  const double residues = brightness({"--outlines", "residues"});
  EXPECT_LT(residues, brightness({"--outlines", "chains"}));
  EXPECT_EQ(pixels({"--outlines", "chains,residues"}), pixels({"--outlines", "residues"}));
  EXPECT_LT(brightness({"--outlines", "chains"}), off);

  const auto names = [this](Options options) {
    options.insert(options.end(), {"--quadrics", "splat"});
    std::vector<std::string> out;
    const nlohmann::json report = stats(kProtein, options);
    for (const auto& pass : report.at("passes")) out.push_back(pass.at("name"));
    return out;
  };
  EXPECT_EQ(names({}), (Options{"spheres", "shade"}));
  EXPECT_EQ(names({"--outlines", "creases"}), (Options{"spheres", "silhouette", "shade"}));
}

TEST_F(RenderLines, lineOptionsChangeLines) {
  const auto lined = [this](Options more) {
    more.insert(more.end(), {"--outlines", "silhouettes,creases"});
    return brightness(more);
  };
  const double unchanged = lined({});
  EXPECT_EQ(lined({"--line-width", "1.5", "--line-gap", "1", "--crease-angle", "30"}), unchanged);
  EXPECT_LT(lined({"--line-width", "3"}), unchanged);
  EXPECT_GT(lined({"--line-color", "#f80"}), unchanged);
  EXPECT_EQ(lined({"--line-colour", "#ff8800"}), lined({"--line-color", "#f80"}));
  EXPECT_GT(lined({"--line-strength", "0.5"}), unchanged);
  EXPECT_GT(lined({"--line-gap", "20"}), unchanged);
  EXPECT_GT(lined({"--crease-angle", "60"}), unchanged);
  EXPECT_EQ(pixels({"--outlines", "silhouettes", "--line-strength", "0"}), usual().pixels);
}

TEST_F(RenderLines, depthUnsharpMasksBothWaysOrDarkens) {
  EXPECT_EQ(pixels({"--depth-unsharp", "off", "--unsharp-strength", "5"}), usual().pixels);
  const double halo = brightness({"--depth-unsharp", "halo"});
  EXPECT_LT(halo, brightness(usual()));
  EXPECT_GT(brightness({"--depth-unsharp", "both"}), halo);
  EXPECT_LT(brightness({"--depth-unsharp", "halo", "--unsharp-strength", "8"}), halo);
  EXPECT_NE(pixels({"--depth-unsharp", "both", "--unsharp-radius", "10%"}),
            pixels({"--depth-unsharp", "both"}));
  EXPECT_NE(pixels({"--depth-unsharp", "both", "--unsharp-radius", "3"}),
            pixels({"--depth-unsharp", "both", "--unsharp-radius", "6"}));
  for (const char* extreme : {"0.001", "100000", "0.01%", "50%"})
    render(kProtein, {"--depth-unsharp", "both", "--unsharp-radius", extreme});
}

TEST_F(RenderLines, fogFadesIntoTheBackground) {
  EXPECT_GT(brightness({"--fog", "0.8"}), brightness(usual())) << "white";
  EXPECT_LT(brightness({"--fog", "0.8", "--background", "black"}), brightness({"--background", "black"}));
  const Picture all = render(kProtein, {"--fog", "1", "--fog-start", "-2", "--fog-end", "-1"});
  EXPECT_EQ(all.covered(), 0) << "everything is in it";
  EXPECT_EQ(pixels({"--fog", "1", "--fog-start", "2", "--fog-end", "3"}), usual().pixels) << "nothing is";
  const Picture layer = render(kProtein, {"--fog", "1", "--background", "transparent"});
  EXPECT_GT(layer.at(32, 24)[3], 0.0f);
  EXPECT_LT(layer.at(32, 24)[3], 1.0f);
}

TEST_F(RenderLines, wrongValuesNameWhatIsAllowed) {
  const auto refused = [this](const char* option, const char* value, const char* allowed) {
    expectError(run({"render", molecule(kProtein), "-o", "a.png", option, value}), ExitCode::badUsage,
                {option, value, allowed});
  };
  refused("--outlines", "edges", "silhouettes");
  refused("--outlines", "off,creases", "off alone");
  refused("--line-width", "0", "0.5");
  refused("--line-color", "dark", "#RRGGBB");
  refused("--line-strength", "2", "1");
  refused("--depth-unsharp", "on", "halo");
  refused("--unsharp-radius", "wide", "Angstrom");
  refused("--fog", "-1", "0");
  expectError(run({"render", molecule(kProtein), "-o", "a.png", "--unsharp-radius", "60%"}),
              ExitCode::badUsage, {"--unsharp-radius", "60", "percent"});
  expectError(run({"render", molecule(kProtein), "-o", "a.png", "--fog-start", "0.5", "--fog-end", "0.4"}),
              ExitCode::badUsage, {"--fog-start", "--fog-end"});
}

}  // namespace
}  // namespace meniscus::test

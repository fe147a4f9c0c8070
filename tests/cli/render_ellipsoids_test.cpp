// `meniscus render --representation ellipsoids`: what is drawn, the probability, what is said about tensors
// that are none.

#include <fstream>

#include "tests/cli/cli_test.h"

namespace meniscus::test {
namespace {

const std::vector<std::string> kEllipsoids{"--representation", "ellipsoids"};

std::vector<std::string> with(std::vector<std::string> more) {
  more.insert(more.end(), kEllipsoids.begin(), kEllipsoids.end());
  return more;
}

class RenderEllipsoids : public CliTest {};

TEST_F(RenderEllipsoids, drawTensorsAsEllipsoidsAndTheRestAsSpheres) {
  const nlohmann::json picture = stats("3al1.pdb.gz", kEllipsoids).at("pictures").at(0);
  EXPECT_EQ(picture.at("ellipsoids"), 220);
  EXPECT_EQ(picture.at("spheres"), 250);
  EXPECT_GT(picture.at("cylinders"), 400);
  const nlohmann::json isotropic = stats("1ubq.pdb", kEllipsoids);
  EXPECT_EQ(isotropic.at("pictures").at(0).at("ellipsoids"), 0);
  for (const auto& buffer : isotropic.at("buffers")) EXPECT_NE(buffer.at("name"), "ellipsoids");
  EXPECT_EQ(stats("1ubq.pdb").at("pictures").at(0).at("ellipsoids"), 0) << "not unless asked for";
}

TEST_F(RenderEllipsoids, growWithTheProbability) {
  const auto covered = [this](const char* probability) {
    return render("4cup.cif.gz",
                  with({"--probability", probability, "--orient", "z", "--focus", "//A/1900-1920"}))
        .covered();
  };
  EXPECT_LT(covered("0.1"), covered("0.5"));
  EXPECT_LT(covered("0.5"), covered("0.9"));
  EXPECT_EQ(render("3al1.pdb.gz", with({"--probability", "0.5"})).pixels,
            render("3al1.pdb.gz", kEllipsoids).pixels);
  EXPECT_NE(render("3al1.pdb.gz", with({"--stick-radius", "0.2"})).pixels,
            render("3al1.pdb.gz", kEllipsoids).pixels);
  for (const char* wrong : {"0", "1", "1.5", "-0.5", "nan", "half"}) {
    expectError(run({"render", molecule("3al1.pdb.gz"), "-o", "a.png", "--probability", wrong}),
                ExitCode::badUsage, {"--probability", wrong, "between 0 and 1"});
  }
  const std::string help = run({"render", "--help"}).out;
  EXPECT_NE(help.find("--probability"), std::string::npos);
  EXPECT_NE(help.find("ellipsoids"), std::string::npos);
}

TEST_F(RenderEllipsoids, sayWhichTensorIsNotPositiveDefinite) {
  std::ofstream(folder_ / "odd.pdb")
      << "ATOM      1  N   GLY A   1       0.000   0.000   0.000  1.00 10.00           N  \n"
         "ANISOU    1  N   GLY A   1      100    200    300     10     20     30       N  \n"
         "ATOM      2  CA  GLY A   1       1.200   0.800   0.000  1.00 10.00           C  \n"
         "ANISOU    2  CA  GLY A   1      100    200    300    900     20     30       C  \n"
         "ATOM      3  C   GLY A   1       2.400   0.000   0.000  1.00  0.00           C  \n";
  const std::vector<std::string> command{"render", "odd.pdb",   "-o", "odd.png",          "--size",
                                         "32",     "--samples", "1",  "--representation", "ellipsoids"};
  const ProcessResult result = run(command);
  EXPECT_EQ(result.exitCode, 0);
  EXPECT_NE(result.err.find("1 displacement tensor is not positive definite, first CA of GLY 1 A"),
            std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find("1 atom has no displacement, first C of GLY 1 A"), std::string::npos)
      << result.err;
  EXPECT_GT(readPicture(folder_ / "odd.png").covered(), 0.05);
  std::vector<std::string> spacefill = command;
  spacefill.back() = "spacefill";
  EXPECT_EQ(run(spacefill).err, "") << "of interest to nobody else";
}

}  // namespace
}  // namespace meniscus::test

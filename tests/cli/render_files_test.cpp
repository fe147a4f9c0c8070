// Which files `meniscus render` writes: names, many inputs, repeated runs, interruptions.

#include <csignal>

#include "tests/cli/cli_test.h"
#include "tests/support/paths.h"

namespace meniscus::test {
namespace {

class RenderFiles : public CliTest {
 protected:
  ProcessResult renderSmall(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"render", "-q", "--size", "32x24", "--samples", "1"});
    return run(arguments);
  }
};

TEST_F(RenderFiles, theSameCommandGivesTheSameBytes) {
  for (const char* name : {"a.png", "b.png"})
    expectSuccess(run({"render", molecule("1ubq.pdb"), "-q", "-o", name, "--representation", "ball_and_stick",
                       "--size", "160x120"}));
  EXPECT_EQ(readFile(folder_ / "a.png"), readFile(folder_ / "b.png"));
}

TEST_F(RenderFiles, stemNamesEachInputsPicture) {
  expectSuccess(renderSmall({molecule("1ubq.pdb"), molecule("1a8o.cif.gz"), "-o", "pic-{stem}.png"}));
  EXPECT_EQ(folder_.names(), (Names{"pic-1a8o.png", "pic-1ubq.png"}));
}

TEST_F(RenderFiles, modelNamesEachModelsPictureSeenByOneCamera) {
  expectSuccess(renderSmall({molecule("1d3z.pdb.gz"), "-o", "{stem}-{model}.png", "--model", "all"}));
  EXPECT_EQ(folder_.names().size(), 10u);
  EXPECT_EQ(folder_.names().front(), "1d3z-1.png");
  EXPECT_NE(readFile(folder_ / "1d3z-1.png"), readFile(folder_ / "1d3z-2.png"));
}

TEST_F(RenderFiles, modelOfOneModelIsItsNumber) {
  expectSuccess(renderSmall({molecule("1d3z.pdb.gz"), "-o", "{model}.png", "--model", "3"}));
  EXPECT_EQ(folder_.names(), Names{"3.png"});
}

TEST_F(RenderFiles, severalInputsNeedDistinctNames) {
  expectError(renderSmall({molecule("1ubq.pdb"), molecule("c60.pdb"), "-o", "x.png"}), ExitCode::badUsage,
              {"--output", "x.png", "{stem}"});
  expectError(renderSmall({molecule("1a8o.pdb.gz"), molecule("1a8o.cif.gz"), "-o", "{stem}.png"}),
              ExitCode::badUsage, {"1a8o.pdb.gz", "1a8o.cif.gz", "1a8o.png"});
  EXPECT_EQ(folder_.names(), Names{});
}

TEST_F(RenderFiles, oneBadInputDoesNotStopTheOthers) {
  writeFile(folder_ / "bad.pdb", "nothing of interest\n");
  const ProcessResult result = renderSmall(
      {molecule("1ubq.pdb"), "bad.pdb", molecule("c60.pdb"), "-o", "{stem}.png", "--stats", "s.json"});
  expectError(result, ExitCode::badInput, {"bad.pdb"});
  EXPECT_EQ(folder_.names(), (Names{"1ubq.png", "bad.pdb", "c60.png", "s.json"}));
  const nlohmann::json json = nlohmann::json::parse(readFile(folder_ / "s.json"));
  EXPECT_EQ(json["pictures"].size(), 2u);
  EXPECT_EQ(json["failures"].size(), 1u);
}

TEST_F(RenderFiles, severalBadInputsAreCounted) {
  const ProcessResult result = renderSmall({"a.pdb", molecule("c60.pdb"), "b.pdb", "-o", "{stem}.png"});
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_NE(result.err.find("a.pdb"), std::string::npos);
  EXPECT_NE(result.err.find("b.pdb"), std::string::npos);
  EXPECT_TRUE(result.err.ends_with("meniscus: 2 of 3 files failed\n")) << result.err;
  EXPECT_EQ(folder_.names(), Names{"c60.png"});
}

TEST_F(RenderFiles, anOldPictureIsReplacedOrLeftWhole) {
  writeFile(folder_ / "out.png", "old");
  expectError(renderSmall({"missing.pdb", "-o", "out.png"}), ExitCode::badInput, {"missing.pdb"});
  EXPECT_EQ(readFile(folder_ / "out.png"), "old");
  expectSuccess(renderSmall({molecule("c60.pdb"), "-o", "out.png"}));
  EXPECT_EQ(readPicture(folder_ / "out.png").width, 32);
}

TEST_F(RenderFiles, aSignalLeavesNothingBehind) {
  for (const int signal : {SIGINT, SIGTERM}) {
    ProcessOptions options;
    options.folder = folder_.path();
    options.signal = signal;
    options.signalAfter = std::chrono::milliseconds(1500);
    const ProcessResult result = runProcess({program(), "render", molecule("2hhb.pdb.gz"), "-q", "-o",
                                             "out.png", "--size", "8000x8000", "--samples", "256"},
                                            options);
    EXPECT_EQ(result.exitCode, -signal);
    EXPECT_EQ(folder_.names(), Names{});
  }
}

}  // namespace
}  // namespace meniscus::test

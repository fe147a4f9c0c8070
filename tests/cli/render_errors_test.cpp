// What `meniscus` says, and how it ends, when something is wrong: one line on stderr, the exit code of
// core/error.h, and no file left behind.

#include <sys/stat.h>

#include "tests/cli/cli_test.h"

namespace meniscus::test {
namespace {

class BadCommand : public CliTest {
 protected:
  void refused(const std::vector<std::string>& arguments, const std::vector<std::string>& parts) const {
    expectError(run(arguments, kNoGraphics), ExitCode::badUsage, parts);
    EXPECT_EQ(folder_.names(), Names{});
  }
};

TEST_F(BadCommand, isNamedWithTheCommandsThereAre) {
  refused({}, {"render", "info", "doctor", "--help"});
  refused({"rendr"}, {"'rendr'", "render, view, info, measure and doctor"});
  refused({"--frobnicate"}, {"--frobnicate"});
}

TEST_F(BadCommand, lacksAnInputOrOutput) {
  refused({"render"}, {"no input", "FILE"});
  refused({"render", molecule("c60.pdb")}, {"no output", "-o"});
  refused({"info"}, {"no input", "FILE"});
  refused({"info", "a.pdb", "b.pdb"}, {"b.pdb"});
}

TEST_F(BadCommand, namesAnUnknownOption) {
  refused({"render", "a.pdb", "-o", "a.png", "--sise", "64"}, {"--sise", "did you mean --size?"});
  refused({"info", "a.pdb", "--frobnicate"}, {"--frobnicate", "meniscus info --help"});
  refused({"doctor", "--frobnicate"}, {"--frobnicate", "meniscus doctor --help"});
  refused({"render", "a.pdb", "-o", "a.jpg"}, {"a.jpg", ".png", ".exr"});
  refused({"render", "a.pdb", "-o", "{name}.png"}, {"{name}", "{stem}", "{model}"});
}

TEST_F(BadCommand, givesAnOptionAnUnknownValue) {
  const std::array<std::array<const char*, 3>, 32> cases{{{"--target", "1,2", "three coordinates"},
                                                          {"--distance", "0", "Angstrom"},
                                                          {"--light-direction", "0,0,0", "not all zero"},
                                                          {"--measure", "//A/1", "two, three or four"},
                                                          {"--panel", "marbles", "licorice"},
                                                          {"--representation", "ribbons", "licorice"},
                                                          {"--color", "mauve", "rainbow"},
                                                          {"--carbons", "green", "chain"},
                                                          {"--radii", "tsai", "alvarez"},
                                                          {"--ball-scale", "0", "0.01"},
                                                          {"--stick-radius", "-1", "Angstrom"},
                                                          {"--size", "10x", "WIDTHxHEIGHT"},
                                                          {"--size", "100000x100000", "65535"},
                                                          {"--fov", "171", "1 to 170"},
                                                          {"--orient", "sideways", "principal"},
                                                          {"--rotate", "1,2", "three angles"},
                                                          {"--zoom", "0", "0.001"},
                                                          {"--background", "clear", "transparent"},
                                                          {"--samples", "257", "1 to 256"},
                                                          {"--samples", "0", "1 to 256"},
                                                          {"--dpi", "none", "pixels per inch"},
                                                          {"--depth", "12", "8 or 16"},
                                                          {"--model", "first", "all"},
                                                          {"--altloc", "AB", "first"},
                                                          {"--hydrogens", "no", "on or off"},
                                                          {"--waters", "no", "auto"},
                                                          {"--replicate", "2x2", "NxMxK"},
                                                          {"--backend", "vulkan", "osmesa"},
                                                          {"--shader-dir", "/nonexistent", "not a folder"},
                                                          {"--select", "///(", "--select"},
                                                          {"--focus", "///(", "--focus"},
                                                          {"--zoom", "nan", "0.001"}}};
  for (const auto& [option, value, allowed] : cases)
    refused({"render", molecule("c60.pdb"), "-o", "a.png", option, value}, {option, value, allowed});
}

TEST_F(BadCommand, givesAnOptionNoValue) {
  refused({"render", "a.pdb", "-o", "a.png", "--color"}, {"--color", "needs a value", "rainbow"});
}

TEST_F(BadCommand, asksForWhatTheFileDoesNotHave) {
  refused({"render", molecule("1ubq.pdb"), "-q", "-o", "a.png", "--model", "2"}, {"2"});
  refused({"render", molecule("1ubq.pdb"), "-q", "-o", "a.png", "--assembly", "77"}, {"77"});
}

class BadInput : public CliTest {
 protected:
  /// Neither `render` nor `info` takes the file; the graphics are not asked.
  void refused(const std::string& file, const std::vector<std::string>& parts = {}) const {
    std::vector<std::string> all{file};
    all.insert(all.end(), parts.begin(), parts.end());
    const Names before = folder_.names();
    expectError(run({"render", "-q", file, "-o", "out.png"}, kNoGraphics), ExitCode::badInput, all);
    expectError(run({"info", file}), ExitCode::badInput, all);
    expectError(run({"info", file, "--json"}), ExitCode::badInput, all);
    EXPECT_EQ(folder_.names(), before);
  }
  void refusedText(const std::string& name, const std::string& text) const {
    writeFile(folder_ / name, text);
    refused(name);
  }
};

TEST_F(BadInput, hasNoChainToDrawAsACartoon) {
  expectError(
      run({"render", "-q", molecule("c60.pdb"), "-o", "out.png", "--representation", "cartoon"}, kNoGraphics),
      ExitCode::badInput, {"c60.pdb", "cartoon", "chains"});
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.png"));
}

TEST_F(BadInput, isMissing) {
  refused("missing.pdb");
}

TEST_F(BadInput, isAFolder) {
  std::filesystem::create_directory(folder_ / "folder.pdb");
  refused("folder.pdb");
}

TEST_F(BadInput, isEmptyOrHoldsNoAtoms) {
  for (const char* name : {"empty.pdb", "empty.cif", "empty.pdb.gz", "empty.cif.gz", "empty"})
    refusedText(name, "");
  refusedText("header.pdb", "HEADER    NOTHING\nEND\n");
  refusedText("header.cif", "data_nothing\n_entry.id nothing\n");
}

TEST_F(BadInput, isTruncated) {
  const std::string whole = readFile(molecule("1a8o.cif.gz"));
  ASSERT_GT(whole.size(), 10000u);
  refusedText("half.cif.gz", whole.substr(0, whole.size() / 2));
  refusedText("stub.cif.gz", whole.substr(0, 10));
  refusedText("stub.pdb", "ATOM      1  N   ALA A   1       0.0");
}

TEST_F(BadInput, isBinary) {
  std::string bytes;
  for (int i = 0; i < 5000; ++i) bytes += static_cast<char>(i * 7919 >> 3);
  for (const char* name : {"binary.pdb", "binary.cif", "binary.pdb.gz", "binary.cif.gz"})
    refusedText(name, bytes);
  refusedText("zeros.pdb", std::string(5000, '\0'));
  refusedText("picture.pdb", std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16) + bytes);
}

TEST_F(BadInput, isAbsurd) {
  refusedText("prose.pdb", "It was a dark and stormy night.\nThe rain fell in torrents.\n");
  refusedText("page.cif", "<!DOCTYPE html><html><body>404 Not Found</body></html>\n");
  refusedText("line.pdb", std::string(200'000, 'A'));
}

TEST_F(BadInput, hasNothingLeftAfterTheSelection) {
  expectError(run({"render", "-q", molecule("1ubq.pdb"), "-o", "out.png", "--select", "//Z"}, kNoGraphics),
              ExitCode::badInput, {"1ubq.pdb"});
  expectError(run({"render", "-q", molecule("1ubq.pdb"), "-o", "out.png", "--focus", "//Z"}, kNoGraphics),
              ExitCode::badInput, {"1ubq.pdb", "--focus", "//Z"});
  EXPECT_EQ(folder_.names(), Names{});
}

TEST_F(BadInput, wouldTakeMoreMemoryThanThereIs) {
  // Copies of a surface share nothing.
  expectError(run({"render", "-q", molecule("2hhb.pdb.gz"), "-o", "out.png", "--replicate", "100x100x100",
                   "--representation", "surface"},
                  kNoGraphics),
              ExitCode::badInput, {"2hhb.pdb.gz", "1000000 copies", "GB of memory", "fewer copies"});
}

class BadOutput : public CliTest {
 protected:
  void refused(const std::string& output, const std::vector<std::string>& parts) const {
    const Names before = folder_.names();
    // The graphics are not asked where the name alone is wrong.
    expectError(run({"render", "-q", molecule("c60.pdb"), "-o", output, "--size", "32"}, kNoGraphics),
                ExitCode::badInput, parts);
    expectError(run({"render", "-q", molecule("c60.pdb"), "-o", "a.png", "--stats", output, "--size", "32"},
                    kNoGraphics),
                ExitCode::badInput, parts);
    EXPECT_EQ(folder_.names(), before);
  }
};

TEST_F(BadOutput, isInAMissingFolder) {
  refused("no/such/a.png", {"no/such/a.png", "no/such", "mkdir -p"});
}

TEST_F(BadOutput, isAFolder) {
  std::filesystem::create_directory(folder_ / "folder.png");
  refused("folder.png", {"folder.png", "is a folder"});
}

TEST_F(BadOutput, isUnderAFile) {
  writeFile(folder_ / "file", "");
  refused("file/a.png", {"file/a.png", "not a folder"});
}

TEST_F(BadOutput, isOnAFullDisk) {
  for (const char* name : {"full.png", "full.exr"}) {
    std::filesystem::create_symlink("/dev/full", folder_ / name);
    expectError(run({"render", "-q", molecule("c60.pdb"), "-o", name, "--size", "200"}), ExitCode::badInput,
                {name, "free some space"});
    EXPECT_TRUE(std::filesystem::is_symlink(folder_ / name));
  }
  EXPECT_EQ(folder_.names(), (Names{"full.exr", "full.png"}));
}

class NoGraphics : public CliTest {};

TEST_F(NoGraphics, isSaidWithTheRemedyAndExitCode3) {
  for (const char* backend : {"auto", "egl", "osmesa"})
    expectError(run({"render", "-q", molecule("c60.pdb"), "-o", "a.png", "--backend", backend}, kNoGraphics),
                ExitCode::noGraphics, {"OpenGL 4.5", "install", "meniscus doctor"});
  EXPECT_EQ(folder_.names(), Names{});
}

TEST_F(NoGraphics, stopsARunOfManyFiles) {
  expectError(
      run({"render", "-q", molecule("c60.pdb"), molecule("1ubq.pdb"), "-o", "{stem}.png"}, kNoGraphics),
      ExitCode::noGraphics, {"OpenGL 4.5"});
  EXPECT_EQ(folder_.names(), Names{});
}

}  // namespace
}  // namespace meniscus::test

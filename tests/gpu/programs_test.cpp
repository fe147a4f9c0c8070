// Every program with every set of its flags on the driver at hand, and shaders from a folder: errors and
// reload.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "render/shader_library.h"
#include "shaders/embedded_shaders.h"
#include "tests/support/gl_fixture.h"

namespace meniscus {
namespace {

namespace fs = std::filesystem;

struct ProgramName {
  std::string vertex, fragment;
};

// Fragment shaders that share a vertex shader with others.
constexpr std::pair<std::string_view, std::string_view> kShared[] = {
    {"quadrics/tiles.frag", "surface/near_plane.vert"},
    {"surface/bezier_surface.frag", "surface/near_plane.vert"},
    {"surface/bezier_walk.frag", "surface/bezier_step.vert"},
    {"surface/bvh_surface.frag", "surface/near_plane.vert"},
    {"surface/lists_surface.frag", "surface/near_plane.vert"},
    {"surface/newton_finish.frag", "surface/near_plane.vert"},
    {"surface/newton_hull.frag", "surface/newton.vert"},
    {"surface/newton_prepare.frag", "surface/newton.vert"}};

// Every fragment shader with its vertex shader: the one of its stem, else the shared one, else that of
// full-screen passes.
std::vector<ProgramName> allPrograms() {
  const auto exists = [](const std::string& path) {
    return std::any_of(embeddedShaders().begin(), embeddedShaders().end(),
                       [&](const EmbeddedShader& shader) { return shader.path == path; });
  };
  std::vector<ProgramName> out;
  for (const EmbeddedShader& shader : embeddedShaders()) {
    if (!shader.path.ends_with(".frag")) continue;
    const std::string vertex = std::string(shader.path.substr(0, shader.path.rfind('.'))) + ".vert";
    const auto* const shared = std::find_if(std::begin(kShared), std::end(kShared),
                                            [&](const auto& pair) { return pair.first == shader.path; });
    const std::string other(shared != std::end(kShared) ? shared->second : "post/fullscreen.vert");
    out.push_back({exists(vertex) ? vertex : other, std::string(shader.path)});
  }
  return out;
}

ShaderFlags flagsOf(const ShaderLibrary& library, const ProgramName& program) {
  ShaderFlags flags = library.source(program.vertex).understood;
  flags.merge(library.source(program.fragment).understood);
  return flags;
}

class Programs : public test::GlTest {};

// Nearly all of it is the driver's work, at which sanitizers do not look: with them each flag of a program is
// set once and left out once at least, without them in every combination with the others.
#ifdef __SANITIZE_ADDRESS__
constexpr bool kEverySet = false;
#else
constexpr bool kEverySet = true;
#endif

TEST_F(Programs, EveryProgramLinksWithEverySetOfItsFlags) {
  ShaderLibrary library{{}};
  std::size_t expected = 0;
  const std::vector<ProgramName> programs = allPrograms();
  EXPECT_GE(programs.size(), 4u);
  for (const ProgramName& program : programs) {
    const ShaderFlags flags = flagsOf(library, program);
    const std::vector<std::string> names(flags.begin(), flags.end());
    const unsigned all = (1u << names.size()) - 1;
    for (unsigned set = 0; set <= all; ++set) {
      if (!kEverySet && set != 0 && set != all) continue;
      ShaderFlags chosen;
      for (std::size_t i = 0; i < names.size(); ++i) {
        if ((set >> i & 1u) != 0) chosen.insert(names[i]);
      }
      EXPECT_NO_THROW(EXPECT_NE(library.program(program.vertex, program.fragment, chosen), 0u))
          << program.fragment;
      ++expected;
    }
  }
  EXPECT_EQ(library.compiled().size(), expected);
  EXPECT_GT(library.compileMs(), 0.0);
}

TEST_F(Programs, TheFirstOnesDeclareTheirFlags) {
  const ShaderLibrary library{{}};
  const ShaderFlags channels{"ALBEDO", "DISTANCE", "ID", "NORMAL"};
  EXPECT_EQ(flagsOf(library, {"quadrics/sphere.vert", "quadrics/sphere.frag"}), channels);
  EXPECT_EQ(flagsOf(library, {"quadrics/cylinder.vert", "quadrics/cylinder.frag"}), channels);
  EXPECT_TRUE(library.source("post/shade.frag").understood.contains("FINAL"));
  EXPECT_TRUE(library.source("post/resolve.frag").understood.contains("ENCODE_SRGB"));
}

TEST_F(Programs, FlagsThatAProgramDoesNotUnderstandCompileNothing) {
  ShaderLibrary library{{}};
  const auto sphere = [&](const ShaderFlags& flags) {
    return library.program("quadrics/sphere.vert", "quadrics/sphere.frag", flags);
  };
  const unsigned plain = sphere({});
  EXPECT_EQ(sphere({"SHADOW", "FINAL", "albedo"}), plain);
  const unsigned colored = sphere({"ALBEDO"});
  EXPECT_NE(colored, plain);
  EXPECT_EQ(sphere({"ALBEDO", "ENCODE_SRGB"}), colored);
  EXPECT_EQ(library.compiled(), (std::vector<std::string>{"quadrics/sphere", "quadrics/sphere ALBEDO"}));
}

TEST_F(Programs, SourcesHoldEveryFileOnceAndNoInclude) {
  const ShaderLibrary library{{}};
  const ShaderSource source = library.source("quadrics/cylinder.frag");
  EXPECT_TRUE(source.text.starts_with("#version 450 core\n")) << "nothing may come before it";
  EXPECT_EQ(source.text.find("#include"), std::string::npos);
  EXPECT_EQ(source.files.at(0), "quadrics/cylinder.frag");
  for (std::size_t i = 0; i < source.files.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(source.files[i], source.files[j]);
  }
  EXPECT_EQ(source.understood, (ShaderFlags{"ALBEDO", "DISTANCE", "ID", "NORMAL"}));
}

TEST_F(Programs, UnknownShadersAreNamed) {
  ShaderLibrary library{{}};
  try {
    library.program("quadrics/torus.vert", "quadrics/sphere.frag", {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("quadrics/torus.vert"), std::string::npos);
  }
}

// A folder with a copy of the embedded shaders.
class ShaderFolder : public test::GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    std::string pattern = (fs::temp_directory_path() / "meniscus-shaders-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    for (const EmbeddedShader& shader : embeddedShaders()) write(shader.path, std::string(shader.text));
  }
  void TearDown() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
    GlTest::TearDown();
  }

  void write(std::string_view path, const std::string& text) {
    const fs::path file = folder_ / path;
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    // Every version has its own time, however coarse the file system's clock is.
    fs::last_write_time(
        file, fs::file_time_type::clock::now() - std::chrono::hours(1) + std::chrono::seconds(++edits_));
  }
  static std::string embedded(std::string_view path) {
    for (const EmbeddedShader& shader : embeddedShaders()) {
      if (shader.path == path) return std::string(shader.text);
    }
    ADD_FAILURE() << path;
    return {};
  }
  // The text with one more line after its first `lines` lines.
  static std::string withLine(const std::string& text, int lines, const std::string& line) {
    std::size_t at = 0;
    for (int i = 0; i < lines; ++i) at = text.find('\n', at) + 1;
    return text.substr(0, at) + line + "\n" + text.substr(at);
  }
  static unsigned sphere(ShaderLibrary& library) {
    return library.program("quadrics/sphere.vert", "quadrics/sphere.frag", {"ALBEDO"});
  }
  // What the library says against the program; the driver's own messages about it are expected, too.
  static std::string errorOf(ShaderLibrary& library) {
    try {
      sphere(library);
    } catch (const InputError& error) {
      gl::takeDebugMessages();
      EXPECT_EQ(error.code(), ExitCode::badInput);
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << "one line";
      return error.what();
    }
    return {};
  }

  fs::path folder_;
  int edits_ = 0;
};

TEST_F(ShaderFolder, ACopyOfTheEmbeddedShadersWorks) {
  ShaderLibrary library(folder_);
  EXPECT_NE(sphere(library), 0u);
  library.reloadIfChanged();
  sphere(library);
  EXPECT_EQ(library.compiled().size(), 1u) << "nothing changed, nothing is compiled again";
}

TEST_F(ShaderFolder, AnErrorNamesItsFileAndLineAndMendingItWorks) {
  const std::string whole = embedded("quadrics/sphere.frag");
  write("quadrics/sphere.frag", withLine(whole, 2, "no GLSL at all;"));  // becomes line 3
  ShaderLibrary library(folder_);
  const std::string error = errorOf(library);
  EXPECT_NE(error.find((folder_ / "quadrics/sphere.frag").string()), std::string::npos) << error;
  EXPECT_TRUE(error.find("sphere.frag:3(") != std::string::npos ||  // Mesa
              error.find("sphere.frag(3)") != std::string::npos ||  // NVIDIA
              error.find("sphere.frag:3:") != std::string::npos)    // others
      << error;
  EXPECT_FALSE(errorOf(library).empty()) << "still broken";

  write("quadrics/sphere.frag", whole);
  library.reloadIfChanged();
  EXPECT_NE(sphere(library), 0u);
}

TEST_F(ShaderFolder, AnErrorInAnIncludedFileNamesThatFile) {
  write("include/gbuffer.glsl", withLine(embedded("include/gbuffer.glsl"), 4, "nor is this;"));  // line 5
  ShaderLibrary library(folder_);
  const std::string error = errorOf(library);
  EXPECT_TRUE(error.find("include/gbuffer.glsl:5") != std::string::npos ||
              error.find("include/gbuffer.glsl(5)") != std::string::npos)
      << error;
}

// The line after an include still has its own number.
TEST_F(ShaderFolder, LinesAfterAnIncludeKeepTheirNumbers) {
  const std::string text = embedded("quadrics/sphere.frag");
  const int lines = static_cast<int>(std::count(text.begin(), text.end(), '\n'));
  write("quadrics/sphere.frag", withLine(text, lines, "at the very end;"));
  ShaderLibrary library(folder_);
  const std::string error = errorOf(library);
  EXPECT_NE(error.find("sphere.frag:" + std::to_string(lines + 1)), std::string::npos) << error;
}

TEST_F(ShaderFolder, WindowsLineEndsAreRead) {
  for (const EmbeddedShader& shader : embeddedShaders()) {
    std::string text;
    for (const char c : shader.text) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
    write(shader.path, text);
  }
  ShaderLibrary library(folder_);
  EXPECT_NO_THROW(sphere(library));
}

TEST_F(ShaderFolder, ReloadSeesAChangedIncludeAndForgetsThePrograms) {
  ShaderLibrary library(folder_);
  sphere(library);
  write("include/view.glsl", embedded("include/view.glsl") + "// changed\n");
  library.reloadIfChanged();
  sphere(library);
  EXPECT_EQ(library.compiled().size(), 2u);
}

TEST_F(ShaderFolder, AMissingFileIsNamedAndFoundWhenItIsThere) {
  fs::remove(folder_ / "include/gbuffer.glsl");
  ShaderLibrary library(folder_);
  const std::string error = errorOf(library);
  EXPECT_NE(error.find((folder_ / "include/gbuffer.glsl").string()), std::string::npos) << error;
  write("include/gbuffer.glsl", embedded("include/gbuffer.glsl"));
  EXPECT_NO_THROW(sphere(library));
}

TEST_F(ShaderFolder, AnEmptyFolderIsAnInputError) {
  ShaderLibrary library(folder_ / "nothing");
  EXPECT_NE(errorOf(library).find("sphere.vert"), std::string::npos);
}

TEST_F(ShaderFolder, CircularIncludesAreRefused) {
  write("include/view.glsl", embedded("include/view.glsl") + "#include \"include/round.glsl\"\n");
  write("include/round.glsl", "#include \"include/view.glsl\"\n");
  ShaderLibrary library(folder_);
  const std::string error = errorOf(library);
  EXPECT_NE(error.find("include/view.glsl"), std::string::npos) << error;
  EXPECT_NE(error.find("includes itself"), std::string::npos) << error;
  write("include/round.glsl", "#include \"include/round.glsl\"\n");
  EXPECT_NE(errorOf(library).find("include/round.glsl"), std::string::npos);
}

}  // namespace
}  // namespace meniscus

#pragma once
// What the command-line tests share: the real executable, run in a folder of the test's own.

#include <gtest/gtest.h>

#include <array>
#include <initializer_list>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "tests/support/process.h"

namespace meniscus::test {

using Environment = std::vector<std::pair<std::string, std::string>>;
using Names = std::vector<std::string>;

inline constexpr const char* kProtein = "1ubq.pdb";

/// What makes every way to OpenGL fail.
inline const Environment kNoGraphics = {{"MENISCUS_EGL_LIBRARY", "/nonexistent/libEGL.so"},
                                        {"MENISCUS_OSMESA_LIBRARY", "/nonexistent/libOSMesa.so"},
                                        {"DISPLAY", ""},
                                        {"WAYLAND_DISPLAY", ""}};

struct Picture {
  int width = 0, height = 0, channels = 0, bits = 0;
  std::vector<float> pixels;  ///< as stored: straight alpha in PNG
  std::map<std::string, std::string> text;

  std::array<float, 4> at(int x, int y) const;
  /// Share of the pixels that differ from the upper left one.
  double covered() const;
};

Picture readPicture(const std::filesystem::path& path);

class CliTest : public testing::Test {
 protected:
  /// Runs `meniscus` with the test's folder as working directory.
  ProcessResult run(const std::vector<std::string>& arguments, const Environment& environment = {}) const;

  /// Runs `meniscus render INPUT -o OUTPUT` with a small picture of one sample, unless `more` says otherwise,
  /// and expects that nothing is said.
  Picture render(const std::string& input, const std::vector<std::string>& more = {},
                 const std::string& output = "out.png") const;

  /// The protein drawn so without options; once, however many tests of a process compare with it.
  const Picture& usual() const;

  /// As render(); what --stats wrote.
  nlohmann::json stats(const std::string& input, std::vector<std::string> more = {}) const;

  TemporaryFolder folder_;
};

/// A file of molecules/.
std::string molecule(const std::string& name);

/// The run ended with `code`, nothing on stdout, and one line on stderr that starts with "meniscus: " and
/// contains all `parts`.
void expectError(const ProcessResult& result, ExitCode code, const std::vector<std::string>& parts);

/// Exit code 0 and nothing on stderr.
void expectSuccess(const ProcessResult& result);

}  // namespace meniscus::test

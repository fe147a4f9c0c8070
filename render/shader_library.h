#pragma once
// Programs from the shader sources: includes, permutations by flags, compiled on first use.

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "render/gl/objects.h"

namespace meniscus {

using ShaderFlags = std::set<std::string, std::less<>>;

/// A shader's text with its includes resolved; #line numbers refer to `files`.
struct ShaderSource {
  std::string text;
  std::vector<std::string> files;  ///< source string number -> path under shaders/
  ShaderFlags understood;          ///< from its "// flags:" line
};

class ShaderLibrary {
 public:
  /// Sources from `directory`, or those in the binary if it is empty.
  explicit ShaderLibrary(std::filesystem::path directory) : directory_(std::move(directory)) {}

  /// GL name of the program of two stages, such as "quadrics/sphere.vert" and "quadrics/sphere.frag". Flags
  /// that neither of them understands make no difference. Throws InputError (a file of `directory`) or
  /// GraphicsError (built in), with path and line, if the driver refuses it.
  unsigned program(std::string_view vertex, std::string_view fragment, const ShaderFlags& flags);

  /// The text that is compiled for one stage. Throws InputError on a missing or circular include.
  ShaderSource source(std::string_view path) const;

  /// With a directory: forgets all programs if any of their files has changed since it was read.
  void reloadIfChanged();

  /// "quadrics/sphere ALBEDO NORMAL", in order of compilation.
  const std::vector<std::string>& compiled() const { return compiled_; }
  double compileMs() const { return compileMs_; }

 private:
  std::string read(std::string_view path) const;
  void append(std::string_view path, std::vector<std::string>& open, ShaderSource& out) const;
  unsigned compileStage(unsigned kind, std::string_view path, const ShaderSource& source,
                        const ShaderFlags& flags);
  [[noreturn]] void refuse(std::string_view path, const ShaderSource& source, std::string log) const;

  std::filesystem::path directory_;
  std::map<std::string, gl::Object> programs_;
  std::map<std::string, ShaderSource> sources_;
  mutable std::map<std::string, std::filesystem::file_time_type> times_;
  std::vector<std::string> compiled_;
  double compileMs_ = 0;
};

}  // namespace meniscus

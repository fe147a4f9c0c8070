#pragma once
// Names of pictures from the pattern given as -o OUT: {stem} is the input's name without folder and
// extensions, {model} the model's number; {{ and }} are braces.

#include <filesystem>
#include <string>
#include <vector>

namespace meniscus {

class OutputPattern {
 public:
  /// Throws UsageError if `pattern` has an unknown or unfinished {placeholder}.
  explicit OutputPattern(std::string pattern);

  bool namesStem() const { return namesStem_; }
  bool namesModel() const { return namesModel_; }
  std::string nameFor(const std::filesystem::path& input, int model) const;

 private:
  std::string pattern_;
  bool namesStem_ = false, namesModel_ = false;
};

/// "1crn" of "folder/1crn.cif.gz".
std::string stemOf(const std::filesystem::path& input);

/// Throws UsageError if two inputs would be written to the same name.
void requireDistinctOutputs(const OutputPattern& pattern, const std::vector<std::string>& inputs);

}  // namespace meniscus

#pragma once
// Names of pictures from the pattern given as -o OUT: {stem} is the input's name without folder and
// extensions, {model} the model's number, {state} the key of a scene's state, {frame} the number of a film's
// picture in five digits; {{ and }} are braces.

#include <filesystem>
#include <string>
#include <vector>

namespace meniscus {

struct OutputPlace {
  int model = 1;
  std::string state;
  int frame = 0;
};

class OutputPattern {
 public:
  /// Throws UsageError if `pattern` has an unknown or unfinished {placeholder}.
  explicit OutputPattern(std::string pattern);

  bool namesStem() const { return namesStem_; }
  bool namesModel() const { return namesModel_; }
  bool namesState() const { return namesState_; }
  bool namesFrame() const { return namesFrame_; }
  /// Slashes in a state's key become "_": a key names no folder.
  std::string nameFor(const std::filesystem::path& input, const OutputPlace& place) const;

 private:
  std::string pattern_;
  bool namesStem_ = false, namesModel_ = false, namesState_ = false, namesFrame_ = false;
};

/// "1crn" of "folder/1crn.cif.gz".
std::string stemOf(const std::filesystem::path& input);

/// Throws UsageError if two inputs would be written to the same name.
void requireDistinctOutputs(const OutputPattern& pattern, const std::vector<std::string>& inputs);

}  // namespace meniscus

#pragma once
// What a command line means, as a MolViewSpec file. What the format has no words for stands under
// custom.meniscus, so that other programs show the same molecules from the same side, and `meniscus render
// --scene` the same picture.

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/picture.h"

namespace meniscus {

class SceneWriter {
 public:
  explicit SceneWriter(std::filesystem::path path) : path_(std::move(path)) {}

  /// Adds a picture of a structure file; several become states of one file.
  void add(const Picture& picture);
  /// Throws InputError if the file cannot be written.
  void write() const;

 private:
  std::filesystem::path path_;
  std::vector<std::pair<std::string, nlohmann::ordered_json>> roots_;  ///< by key
};

}  // namespace meniscus

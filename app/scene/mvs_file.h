#pragma once
// A MolViewSpec file: one scene, or several states.

#include <filesystem>
#include <string>
#include <vector>

#include "app/scene/mvs_nodes.h"
#include "app/scene/resources.h"

namespace meniscus {

struct MvsState {
  std::string key;  ///< of a file with several states: as it says, or "1", "2", ...; otherwise empty
  MvsNode root;
};

class MvsFile {
 public:
  /// Reads and checks a file, but not what it refers to. Throws InputError naming file and place.
  MvsFile(const std::filesystem::path& path, const ResourceOptions& options);

  const std::vector<MvsState>& states() const { return states_; }  ///< never empty
  SceneResources& resources() { return resources_; }
  /// What was odd about the file as a whole, a line each.
  const std::vector<std::string>& notes() const { return notes_; }
  /// A name for all that the scene is made of: its text and the files that it refers to, which are read.
  std::string contentName();

 private:
  SceneResources resources_;
  nlohmann::json json_;
  std::vector<MvsState> states_;
  std::vector<std::string> notes_;
};

}  // namespace meniscus

#pragma once
// The files a scene refers to: beside it, inside its archive (.mvsx), anywhere on this machine, or on the
// web.

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "app/scene/json_place.h"

namespace meniscus {

struct ResourceOptions {
  bool offline = false;         ///< nothing is fetched; what is in the cache is used
  std::filesystem::path cache;  ///< folder of fetched files; empty = $XDG_CACHE_HOME/meniscus
};

class SceneArchive;

class SceneResources {
 public:
  /// Opens a scene file: JSON (.mvsj), or a zip archive with an index.mvsj (.mvsx), told apart by content.
  /// Throws InputError.
  SceneResources(std::filesystem::path scene, const ResourceOptions& options);
  ~SceneResources();
  SceneResources(const SceneResources&) = delete;
  SceneResources& operator=(const SceneResources&) = delete;

  /// The scene's own text.
  const std::string& sceneText() const { return sceneText_; }

  /// Bytes of what `url` names: a path (relative to the scene file, or inside its archive), file:, http: or
  /// https:. Read once. Throws InputError naming the place and the address.
  const std::string& bytes(const JsonPlace& url);

 private:
  std::string read(const JsonPlace& url) const;

  std::filesystem::path scene_;
  ResourceOptions options_;
  std::string sceneText_;
  std::unique_ptr<SceneArchive> archive_;  ///< only of an .mvsx
  std::map<std::string, std::string> bytes_;
};

}  // namespace meniscus

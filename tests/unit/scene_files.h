#pragma once
// Scenes for tests: written as JSON, read as the program does.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/scene/mvs_file.h"
#include "app/scene/mvs_scene.h"
#include "core/error.h"
#include "tests/support/paths.h"
#include "tests/support/process.h"

namespace meniscus::test {

using Json = nlohmann::ordered_json;

inline Json node(const char* kind, Json params = Json::object(), std::vector<Json> children = {}) {
  Json json{{"kind", kind}};
  if (!params.empty()) json["params"] = std::move(params);
  if (!children.empty()) json["children"] = std::move(children);
  return json;
}

inline Json withCustom(Json json, Json meniscus) {
  json["custom"]["meniscus"] = std::move(meniscus);
  return json;
}

inline Json sceneFile(Json root) {
  return {{"root", std::move(root)}, {"metadata", {{"version", "1"}, {"timestamp", "2026-01-01T00:00:00Z"}}}};
}

inline std::string moleculePath(const std::string& name) {
  return projectFile("molecules/" + name);
}

/// root > download > parse > structure, with what stands under the structure, and what beside the download.
inline Json structureScene(const std::string& molecule, std::vector<Json> inStructure,
                           std::vector<Json> inRoot = {}, Json structureParams = {{"type", "model"}}) {
  const bool pdb = molecule.find(".pdb") != std::string::npos;
  Json structure = node("structure", std::move(structureParams), std::move(inStructure));
  Json parse = node("parse", {{"format", pdb ? "pdb" : "mmcif"}}, {std::move(structure)});
  inRoot.insert(inRoot.begin(), node("download", {{"url", moleculePath(molecule)}}, {std::move(parse)}));
  return sceneFile(node("root", Json::object(), std::move(inRoot)));
}

/// A component in a representation, with the representation's children.
inline Json shown(Json selector, const char* type = "spacefill", std::vector<Json> children = {}) {
  return node("component", {{"selector", std::move(selector)}},
              {node("representation", {{"type", type}}, std::move(children))});
}

class SceneFileTest : public testing::Test {
 protected:
  static RenderOptions options(const std::string& output = "out.png") {
    return parseRenderOptions({"--scene", "fig.mvsj", "-o", output}).value();
  }
  Preparation read(const std::string& text, const RenderOptions& given = options()) {
    writeFile(folder_ / "fig.mvsj", text);
    MvsFile file(folder_ / "fig.mvsj", {true, folder_ / "cache"});
    return scenePictures("fig.mvsj", file, given);
  }
  Preparation read(const Json& scene, const RenderOptions& given = options()) {
    return read(scene.dump(), given);
  }
  /// The only picture's scene.
  Scene sceneOf(const Json& scene) { return read(scene).pictures.at(0).scene; }
  std::string errorOf(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
  std::string errorOf(const Json& scene) { return errorOf(scene.dump()); }

  TemporaryFolder folder_;
};

}  // namespace meniscus::test

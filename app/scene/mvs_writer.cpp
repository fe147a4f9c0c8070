#include "app/scene/mvs_writer.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <glm/gtc/quaternion.hpp>
#include <set>

#include "app/commands.h"
#include "app/output_name.h"
#include "app/scene/settings.h"
#include "io/output_file.h"

namespace meniscus {
namespace {

using Json = nlohmann::ordered_json;

Json node(const char* kind, Json params, Json custom = Json::object()) {
  Json json{{"kind", kind}};
  if (!params.empty()) json["params"] = std::move(params);
  if (!custom.empty()) json["custom"] = {{"meniscus", std::move(custom)}};
  return json;
}

Json listOf(const glm::dvec3& v) {
  return Json::array({v.x, v.y, v.z});
}

Json cameraNode(const Picture& picture) {
  const Camera& camera = picture.scene.camera;
  const glm::dmat3 axes = glm::transpose(glm::mat3_cast(glm::normalize(camera.orientation)));
  const double half = 0.5 * camera.fovY;
  const bool perspective = camera.projection == Projection::perspective;
  // The camera of 60 degrees that sees as much; zoom brings it nearer.
  const double reference =
      camera.distance * 2 * (perspective ? std::sin(half) : std::tan(half)) / camera.zoom;
  Json params{{"target", listOf(camera.target)},
              {"position", listOf(camera.target + axes[2] * reference)},
              {"up", listOf(axes[1])}};
  const glm::dquat& q = camera.orientation;
  Json exact{{"orientation", {q.w, q.x, q.y, q.z}},
             {"target", listOf(camera.target)},
             {"distance", camera.distance}};
  if (camera.nearest) exact["near"] = *camera.nearest;
  if (camera.farthest) exact["far"] = *camera.farthest;
  return node("camera", std::move(params), std::move(exact));
}

const char* formatName(StructureFormat format) {
  return format == StructureFormat::pdb ? "pdb" : format == StructureFormat::mmcif ? "mmcif" : "bcif";
}

/// The type that comes nearest, for programs that do not know ours.
const char* typeOf(Representation representation) {
  switch (representation) {
    case Representation::spacefill:
      return "spacefill";
    case Representation::surface:
      return "surface";
    case Representation::cartoon:
      return "cartoon";
    case Representation::backbone:
      return "backbone";
    case Representation::putty:
      return "putty";
    default:
      return "ball_and_stick";
  }
}

Json representationNode(Representation representation, const Coloring& coloring, GivenOptions given) {
  std::erase_if(
      given, [](const auto& option) { return option.first == "representation" || option.first == "color"; });
  given.insert(given.begin(), {"color", coloringName(coloring)});
  given.insert(given.begin(), {"representation", std::string(representationName(representation))});
  Json json =
      node("representation", {{"type", typeOf(representation)}}, settingsAsJson(given, SettingPlace::look));
  if (coloring.scheme == ColorScheme::uniform)
    json["children"] = {node("color", {{"color", coloringName(coloring)}})};
  return json;
}

Json componentNodes(const Picture& picture) {
  const RenderOptions& o = picture.options;
  Json components = Json::array();
  const auto add = [&](Json custom, Json representation) {
    Json component = node("component", {{"selector", "all"}}, std::move(custom));
    component["children"] = {std::move(representation)};
    components.push_back(std::move(component));
  };
  Json except = Json::array();
  for (const ShownApart& shown : o.shown) except.push_back(shown.cid);
  for (const std::string& cid : o.hidden) except.push_back(cid);
  add(except.empty() ? Json::object() : Json{{"except", except}},
      representationNode(o.representation, o.coloring, o.given));
  for (const ShownApart& shown : o.shown) {
    except.erase(except.begin());  // of several that name an atom the last has it
    Json custom{{"select", shown.cid}};
    if (!except.empty()) custom["except"] = except;
    add(std::move(custom),
        representationNode(shown.representation, shown.coloring.value_or(o.coloring), o.given));
  }
  for (const auto& [cid, text] : o.labels) {
    Json component = node("component", {{"selector", "all"}}, {{"select", cid}});
    component["children"] = {node("label", {{"text", text}})};
    components.push_back(std::move(component));
  }
  return components;
}

Json structureNodes(const Picture& picture) {
  const RenderOptions& o = picture.options;
  Json structures = Json::array();
  std::set<const Molecule*> written;
  for (const SceneObject& object : picture.scene.objects) {
    if (!written.insert(object.molecule.get()).second) continue;
    Json params{{"type", o.assembly.empty() ? "model" : "assembly"}};
    if (object.molecule->modelIndex != 0) params["model_index"] = object.molecule->modelIndex;
    if (!o.assembly.empty()) params["assembly_id"] = o.assembly;
    Json custom = settingsAsJson(o.given, SettingPlace::structure);
    if (!custom.contains("waters")) custom["waters"] = "auto";
    Json structure = node("structure", std::move(params), std::move(custom));
    structure["children"] = componentNodes(picture);
    structures.push_back(std::move(structure));
  }
  return structures;
}

Json rootNode(const Picture& picture, const std::filesystem::path& sceneFile) {
  GivenOptions given = picture.options.given;
  std::erase_if(given,
                [](const auto& option) { return option.first == "style"; });  // its options stand there, too
  // A scene has no other name for the spacing of the mesh that is drawn.
  for (auto& [name, value] : given)
    if (name == "mesh-spacing" && picture.options.surface.method == "mesh") {
      name = "surface-option";
      value = "spacing=" + value;
    }
  Json custom = settingsAsJson(given, SettingPlace::picture);
  custom["made_from"] = {{"source", picture.source}, {"command", picture.command}};

  const std::filesystem::path folder = std::filesystem::absolute(sceneFile).parent_path();
  const std::filesystem::path input = std::filesystem::absolute(picture.input);
  Json parse = node("parse", {{"format", formatName(picture.format)}});
  parse["children"] = structureNodes(picture);
  Json download = node("download", {{"url", input.lexically_proximate(folder).string()}});
  download["children"] = {std::move(parse)};

  Json root = node("root", {}, std::move(custom));
  root["children"] = {std::move(download), cameraNode(picture)};
  if (!picture.scene.background.transparent)
    root["children"].push_back(
        node("canvas", {{"background_color", fmt::format("#{:06X}", picture.scene.background.color)}}));
  return root;
}

}  // namespace

void SceneWriter::add(const Picture& picture) {
  const std::string stem = stemOf(picture.result());
  std::string key = stem;
  const auto taken = [&](const auto& root) { return root.first == key; };
  for (std::size_t n = roots_.size() + 1; std::any_of(roots_.begin(), roots_.end(), taken); ++n)
    key = fmt::format("{}-{}", stem, n);
  roots_.emplace_back(key, rootNode(picture, path_));
}

void SceneWriter::write() const {
  const std::string now = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  Json metadata{{"version", "1"}, {"timestamp", now}};
  Json file;
  if (roots_.size() == 1) {
    metadata["title"] = roots_.front().first;
    file = {{"kind", "single"}, {"root", roots_.front().second}, {"metadata", std::move(metadata)}};
  } else {
    Json snapshots = Json::array();
    for (const auto& [key, root] : roots_)
      snapshots.push_back(
          {{"root", root}, {"metadata", {{"key", key}, {"title", key}, {"linger_duration_ms", 1000}}}});
    file = {{"kind", "multiple"}, {"metadata", std::move(metadata)}, {"snapshots", std::move(snapshots)}};
  }
  writeTextFile(path_, file.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace meniscus

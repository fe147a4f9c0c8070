#include "app/scene/mvs_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

namespace meniscus {
namespace {

struct Kind {
  std::string_view name, parents;  // separated by blanks
};

constexpr std::string_view kComponents = "component component_from_uri component_from_source";

constexpr std::array kKinds = std::to_array<Kind>({
    {"root", ""},
    {"download", "root"},
    {"parse", "download"},
    {"coordinates", "parse"},
    {"structure", "parse"},
    {"transform", "structure component component_from_uri component_from_source volume"},
    {"instance", "structure component component_from_uri component_from_source volume"},
    {"component", "structure"},
    {"component_from_uri", "structure"},
    {"component_from_source", "structure"},
    {"representation", kComponents},
    {"volume", "parse"},
    {"volume_representation", "volume"},
    {"shape", "root parse download"},
    {"color", "representation volume_representation"},
    {"color_from_uri", "representation"},
    {"color_from_source", "representation"},
    {"clip", "representation volume_representation primitives primitives_from_uri"},
    {"opacity", "representation volume_representation"},
    {"label", kComponents},
    {"label_from_uri", "structure"},
    {"label_from_source", "structure"},
    {"tooltip", kComponents},
    {"tooltip_from_uri", "structure"},
    {"tooltip_from_source", "structure"},
    {"focus",
     "root component component_from_uri component_from_source primitives primitives_from_uri volume "
     "volume_representation"},
    {"primitives", "root structure"},
    {"primitives_from_uri", "root structure"},
    {"primitive", "primitives"},
    {"camera", "root"},
    {"canvas", "root"},
    {"transition", "root"},
    {"animation", "root"},
    {"interpolate", "animation"},
});

const Kind* findKind(std::string_view name) {
  const auto found =
      std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& k) { return k.name == name; });
  return found == kKinds.end() ? nullptr : &*found;
}

bool isListed(std::string_view list, std::string_view word) {
  while (!list.empty()) {
    const std::size_t end = std::min(list.find(' '), list.size());
    if (list.substr(0, end) == word) return true;
    list.remove_prefix(std::min(end + 1, list.size()));
  }
  return false;
}

void checkNode(const MvsNode& node, std::string_view parent, bool lenient,
               std::map<std::string, std::string>& refs) {
  const Kind* kind = findKind(node.kind());
  const std::string place = node.place().path();
  if (!kind && !lenient)
    node.place().at("kind").fail(fmt::format("there is no kind of node called '{}'", node.kind()));
  if (kind && !(parent.empty() ? kind->parents.empty() : isListed(kind->parents, parent)))
    node.place().fail(parent.empty() ? fmt::format("is of kind '{}' instead of 'root'", node.kind())
                                     : fmt::format("a node of kind '{}' cannot stand under one of kind '{}'",
                                                   node.kind(), parent));
  if (const std::optional<JsonPlace> ref = node.place().find("ref")) {
    const auto [known, isNew] = refs.try_emplace(ref->string(), ref->path());
    if (!isNew)
      ref->fail(fmt::format("'{}' is the ref of another node, too ({})", ref->string(), known->second));
  }
  for (const MvsNode& child : node.children()) checkNode(child, node.kind(), lenient, refs);
}

/// A node that refers to another one: it must be there, and of the right kind, so that nothing can go round.
void checkReferences(const MvsNode& node, const std::map<std::string, std::string>& kindOfRef) {
  for (const auto& [parameter, kind] :
       {std::pair{"coordinates_ref", "coordinates"}, std::pair{"structure_ref", "structure"}}) {
    const std::optional<JsonPlace> ref = node.find(parameter);
    if (!ref) continue;
    const auto target = kindOfRef.find(ref->string());
    if (target == kindOfRef.end()) ref->fail(fmt::format("no node has the ref '{}'", ref->string()));
    if (target->second != kind)
      ref->fail(fmt::format("'{}' is of kind '{}', not '{}'", ref->string(), target->second, kind));
  }
  for (const MvsNode& child : node.children()) checkReferences(child, kindOfRef);
}

void collectRefs(const MvsNode& node, std::map<std::string, std::string>& kindOfRef) {
  if (const std::optional<JsonPlace> ref = node.place().find("ref")) kindOfRef[ref->string()] = node.kind();
  for (const MvsNode& child : node.children()) collectRefs(child, kindOfRef);
}

}  // namespace

MvsNode::MvsNode(JsonPlace place) : place_(std::move(place)) {
  kind_ = place_.at("kind").string();
  if (const auto params = place_.find("params")) params->keys();
  if (const auto custom = place_.find("custom")) custom->keys();
  if (const auto children = place_.find("children"))
    for (const JsonPlace& child : children->items()) children_.emplace_back(child);
}

std::optional<JsonPlace> MvsNode::find(std::string_view parameter) const {
  const std::optional<JsonPlace> params = place_.find("params");
  return params ? params->find(parameter) : std::nullopt;
}

JsonPlace MvsNode::at(std::string_view parameter) const {
  return place_.at("params").at(parameter);
}

std::optional<JsonPlace> MvsNode::meniscus() const {
  const std::optional<JsonPlace> custom = place_.find("custom");
  return custom ? custom->find("meniscus") : std::nullopt;
}

void MvsNode::listOtherParameters(std::initializer_list<std::string_view> known,
                                  std::vector<std::string>& unsupported) const {
  const std::optional<JsonPlace> params = place_.find("params");
  if (!params) return;
  for (const std::string& key : params->keys())
    if (std::find(known.begin(), known.end(), key) == known.end())
      unsupported.push_back(fmt::format("{}.{}: this parameter is not supported", params->path(), key));
}

void checkTree(const MvsNode& root, bool lenient) {
  std::map<std::string, std::string> refs, kindOfRef;
  checkNode(root, "", lenient, refs);
  collectRefs(root, kindOfRef);
  checkReferences(root, kindOfRef);
}

bool isReadFormat(std::string_view format) {
  return format == "mmcif" || format == "pdb" || format == "bcif";
}

}  // namespace meniscus

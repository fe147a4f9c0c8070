#include "app/scene/mvs_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "app/content_hash.h"

namespace meniscus {
namespace {

/// The major version, 1 if none is given.
int majorVersion(const JsonPlace& file, std::vector<std::string>& notes) {
  const std::optional<JsonPlace> metadata = file.find("metadata");
  const std::optional<JsonPlace> version = metadata ? metadata->find("version") : std::nullopt;
  if (!version) {
    notes.push_back(fmt::format("{}.metadata.version: is missing: read as version 1", file.path()));
    return 1;
  }
  const std::string& text = version->string();
  if (text.empty() || text[0] < '0' || text[0] > '9') version->fail("is no version; write \"1\"");
  const int major = std::atoi(text.c_str());
  if (major > 1)
    notes.push_back(
        fmt::format("{}: '{}' is newer than 1: what is new in it is not drawn", version->path(), text));
  return major;
}

/// Whether a download is read for a picture.
bool isRead(const MvsNode& download) {
  return std::ranges::any_of(download.children(), [](const MvsNode& parse) {
    return parse.kind() == "parse" && isReadFormat(parse.at("format").string()) &&
           std::ranges::any_of(parse.children(),
                               [](const MvsNode& child) { return child.kind() == "structure"; });
  });
}

}  // namespace

MvsFile::MvsFile(const std::filesystem::path& path, const ResourceOptions& options)
    : resources_(path, options), json_(parseJson(resources_.sceneText(), path.string())) {
  const JsonPlace file(json_, path.string());
  const bool lenient = majorVersion(file, notes_) > 1;
  const std::optional<JsonPlace> kind = file.find("kind");
  const std::string kindName = kind ? kind->string() : "single";
  // The path of what follows reads "fig.mvsj: root.children[0]".
  const auto inside = [&](const JsonPlace& place, const std::string& name) {
    return JsonPlace(place.json(), path.string() + ": " + name);
  };
  if (kindName == "single") {
    states_.push_back({"", MvsNode(inside(file.at("root"), "root"))});
  } else if (kindName == "multiple") {
    std::set<std::string> keys;
    for (const JsonPlace& snapshot : file.at("snapshots").items()) {
      const std::size_t number = states_.size() + 1;
      const std::string where = fmt::format("snapshots[{}]", number - 1);
      std::string key = std::to_string(number);
      if (const auto metadata = snapshot.find("metadata"))
        if (const auto given = metadata->find("key"))
          if (!given->string().empty()) key = given->string();
      for (const char c : key)
        if (static_cast<unsigned char>(c) < 32)
          inside(snapshot, where + ".metadata.key").fail("has a control character");
      if (!keys.insert(key).second)
        inside(snapshot, where + ".metadata.key")
            .fail(fmt::format("'{}' is the key of another state, too", key));
      for (const std::string& member : snapshot.keys())
        if (member != "root" && member != "metadata")
          notes_.push_back(
              fmt::format("{}: {}.{}: has no meaning in a still picture", path.string(), where, member));
      states_.push_back({key, MvsNode(inside(snapshot.at("root"), where + ".root"))});
    }
    if (states_.empty()) file.at("snapshots").fail("is empty");
  } else {
    kind->fail(fmt::format("'{}' is neither single nor multiple", kindName));
  }
  for (const MvsState& state : states_) checkTree(state.root, lenient);
}

std::string MvsFile::contentName() {
  std::string all = contentHash(resources_.sceneText());
  for (const MvsState& state : states_)
    for (const MvsNode& node : state.root.children())
      if (node.kind() == "download" && isRead(node)) all += contentHash(resources_.bytes(node.at("url")));
  return contentHash(all);
}

}  // namespace meniscus

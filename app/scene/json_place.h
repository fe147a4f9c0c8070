#pragma once
// A value of a scene file together with where it stands, so that whatever is wrong with it can be named:
// "fig.mvsj: root.children[0].params.url: ...". Every function throws InputError of that form.

#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meniscus {

class JsonPlace {
 public:
  /// `json` must outlive it. `path` ends up in front of errors.
  JsonPlace(const nlohmann::json& json, std::string path) : json_(&json), path_(std::move(path)) {}

  const nlohmann::json& json() const { return *json_; }
  const std::string& path() const { return path_; }
  [[noreturn]] void fail(std::string_view what) const;

  /// A member of an object; nothing if it is missing or null. Fails if this is no object.
  std::optional<JsonPlace> find(std::string_view key) const;
  /// The same, failing if it is missing.
  JsonPlace at(std::string_view key) const;
  /// Names of an object's members that are not null.
  std::vector<std::string> keys() const;
  /// Elements of an array.
  std::vector<JsonPlace> items() const;

  const std::string& string() const;
  double number() const;  ///< finite
  int integer() const;
  bool boolean() const;
  /// Exactly `count` finite numbers.
  std::vector<double> numbers(std::size_t count) const;
  glm::dvec3 vector() const;

 private:
  const nlohmann::json* json_;
  std::string path_;
};

/// Text as JSON. Throws InputError naming `path`, line and column, if it is none, is nested more than 200
/// deep or larger than 64 MiB.
nlohmann::json parseJson(const std::string& text, const std::string& path);

}  // namespace meniscus

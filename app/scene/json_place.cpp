#include "app/scene/json_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace meniscus {
namespace {

constexpr std::size_t kMostJsonBytes = std::size_t{64} << 20;
constexpr int kDeepest = 200;

const char* kindOf(const nlohmann::json& json) {
  switch (json.type()) {
    case nlohmann::json::value_t::null:
      return "null";
    case nlohmann::json::value_t::object:
      return "an object";
    case nlohmann::json::value_t::array:
      return "a list";
    case nlohmann::json::value_t::string:
      return "a text";
    case nlohmann::json::value_t::boolean:
      return "true or false";
    default:
      return "a number";
  }
}

/// The first place at which brackets are open deeper than allowed; nothing if there is none.
std::optional<std::size_t> tooDeepAt(const std::string& text) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '\\') ++i;
      if (c == '"') quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kDeepest) return i;
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return std::nullopt;
}

std::string lineAndColumn(const std::string& text, std::size_t byte) {
  byte = std::min(byte, text.size());
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(byte);
  const auto line = std::count(text.begin(), end, '\n') + 1;
  const std::size_t start = byte == 0 ? std::string::npos : text.rfind('\n', byte - 1);
  return fmt::format("line {}, column {}", line, start == std::string::npos ? byte + 1 : byte - start);
}

}  // namespace

void JsonPlace::fail(std::string_view what) const {
  throw InputError(fmt::format("{}: {}", path_, what));
}

std::optional<JsonPlace> JsonPlace::find(std::string_view key) const {
  if (!json_->is_object()) fail(fmt::format("is {}, not an object", kindOf(*json_)));
  const auto found = json_->find(std::string(key));
  if (found == json_->end() || found->is_null()) return std::nullopt;
  return JsonPlace(*found, fmt::format("{}.{}", path_, key));
}

JsonPlace JsonPlace::at(std::string_view key) const {
  std::optional<JsonPlace> found = find(key);
  if (!found) fail(fmt::format("lacks '{}'", key));
  return *std::move(found);
}

std::vector<std::string> JsonPlace::keys() const {
  if (!json_->is_object()) fail(fmt::format("is {}, not an object", kindOf(*json_)));
  std::vector<std::string> keys;
  for (const auto& [key, value] : json_->items())
    if (!value.is_null()) keys.push_back(key);
  return keys;
}

std::vector<JsonPlace> JsonPlace::items() const {
  if (!json_->is_array()) fail(fmt::format("is {}, not a list", kindOf(*json_)));
  std::vector<JsonPlace> items;
  for (std::size_t i = 0; i < json_->size(); ++i)
    items.emplace_back((*json_)[i], fmt::format("{}[{}]", path_, i));
  return items;
}

const std::string& JsonPlace::string() const {
  if (!json_->is_string()) fail(fmt::format("is {}, not a text", kindOf(*json_)));
  return json_->get_ref<const std::string&>();
}

double JsonPlace::number() const {
  if (!json_->is_number()) fail(fmt::format("is {}, not a number", kindOf(*json_)));
  const double value = json_->get<double>();
  if (!std::isfinite(value)) fail("is not a finite number");
  return value;
}

int JsonPlace::integer() const {
  const double value = number();
  if (value != std::floor(value) || std::abs(value) > 2147483647.0) fail("is not a whole number");
  return static_cast<int>(value);
}

bool JsonPlace::boolean() const {
  if (!json_->is_boolean()) fail(fmt::format("is {}, not true or false", kindOf(*json_)));
  return json_->get<bool>();
}

std::vector<double> JsonPlace::numbers(std::size_t count) const {
  const std::vector<JsonPlace> list = items();
  if (list.size() != count) fail(fmt::format("has {} numbers instead of {}", list.size(), count));
  std::vector<double> values;
  for (const JsonPlace& item : list) values.push_back(item.number());
  return values;
}

glm::dvec3 JsonPlace::vector() const {
  const std::vector<double> v = numbers(3);
  return {v[0], v[1], v[2]};
}

nlohmann::json parseJson(const std::string& text, const std::string& path) {
  if (text.size() > kMostJsonBytes)
    throw InputError(
        fmt::format("{}: is larger than 64 MiB, as no scene is; refer to data by their addresses", path));
  if (const std::optional<std::size_t> place = tooDeepAt(text))
    throw InputError(
        fmt::format("{}: {}: is nested more than {} deep", path, lineAndColumn(text, *place), kDeepest));
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    std::string what =
        error.what();  // "[json.exception...] parse error at line 1, column 2: syntax error ..."
    const std::size_t colon = what.find(": ");
    if (colon != std::string::npos) what.erase(0, colon + 2);
    const std::size_t byte = error.byte > 0 ? error.byte - 1 : 0;
    throw InputError(fmt::format("{}: {}: no valid JSON ({})", path, lineAndColumn(text, byte), what));
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("{}: no valid JSON ({})", path, error.what()));
  }
}

}  // namespace meniscus

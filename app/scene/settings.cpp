#include "app/scene/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

namespace meniscus {
namespace {

using enum SettingPlace;
using enum SettingType;

constexpr std::array kSettings = std::to_array<Setting>({
    {"size", picture, text},
    {"samples", picture, integer},
    {"level-of-detail", picture, onOff},
    {"background", picture, text},
    {"depth", picture, integer},
    {"dpi", picture, number},
    {"channels", picture, list},
    {"style", picture, text},
    {"opacity", picture, number},
    {"surface-method", picture, text},
    {"surface-option", picture, pairs},
    {"label-size", picture, number},
    {"label-color", picture, text},
    {"label-seam", picture, text},
    {"label-font", picture, text},
    {"key-light", picture, number},
    {"fill-light", picture, number},
    {"ambient-light", picture, number},
    {"highlight", picture, number},
    {"light-direction", picture, text},
    {"shadows", picture, text},
    {"penumbra", picture, number},
    {"shadow-samples", picture, integer},
    {"occlusion", picture, onOff},
    {"occlusion-radius", picture, number},
    {"occlusion-strength", picture, number},
    {"occlusion-directions", picture, integer},
    {"trace-shadows", picture, integer},
    {"trace-ao", picture, integer},
    {"reflect", picture, integer},
    {"refract", picture, integer},
    {"refractive-index", picture, number},
    {"attenuation-color", picture, text},
    {"attenuation-distance", picture, number},
    {"environment", picture, text},
    {"outlines", picture, list},
    {"line-width", picture, number},
    {"line-color", picture, text},
    {"line-strength", picture, number},
    {"line-gap", picture, number},
    {"crease-angle", picture, number},
    {"depth-unsharp", picture, text},
    {"unsharp-strength", picture, number},
    {"unsharp-radius", picture, text},
    {"fog", picture, number},
    {"fog-start", picture, number},
    {"fog-end", picture, number},
    {"fov", picture, number},
    {"orthographic", picture, flag},
    {"zoom", picture, number},
    {"select", structure, text},
    {"altloc", structure, text},
    {"hydrogens", structure, onOff},
    {"waters", structure, text},
    {"replicate", structure, text},
    {"representation", look, text},
    {"color", look, text},
    {"carbons", look, text},
    {"radii", look, text},
    {"ball-scale", look, number},
    {"stick-radius", look, number},
    {"ribbon-scale", look, number},
    {"probability", look, number},
    {"blend", look, number},
    {"kernel", look, text},
    {"level", look, number},
});

std::string keyOf(std::string_view option) {
  std::string key(option);
  std::replace(key.begin(), key.end(), '-', '_');
  return key;
}

/// Shortest text that reads back as the same number.
std::string numberText(double value) {
  return fmt::format("{}", value);
}

void addOption(const Setting& setting, const JsonPlace& value, GivenOptions& options) {
  const std::string name(setting.option);
  switch (setting.type) {
    case number:
      options.emplace_back(name, numberText(value.number()));
      return;
    case integer:
      options.emplace_back(name, std::to_string(value.integer()));
      return;
    case text:
      options.emplace_back(name, value.string());
      return;
    case onOff:
      options.emplace_back(name, value.boolean() ? "on" : "off");
      return;
    case flag:
      if (value.boolean()) options.emplace_back(name, "");
      return;
    case list: {
      std::vector<std::string> words;
      for (const JsonPlace& item : value.items()) words.push_back(item.string());
      if (words.empty()) value.fail("is empty; leave it out");
      options.emplace_back(name, fmt::format("{}", fmt::join(words, ",")));
      return;
    }
    case pairs:
      for (const std::string& key : value.keys())
        options.emplace_back(name, fmt::format("{}={}", key, numberText(value.at(key).number())));
      return;
  }
}

nlohmann::ordered_json numberFrom(const std::string& text) {
  double value = 0;
  std::string_view digits = text;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  MENISCUS_CHECK(error == std::errc() && end == digits.data() + digits.size());  // the option has taken it
  return value;
}

std::string lowerCase(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

void addJson(const Setting& setting, const std::string& value, nlohmann::ordered_json& out) {
  nlohmann::ordered_json& target = out[keyOf(setting.option)];
  switch (setting.type) {
    case number:
      target = numberFrom(value);
      return;
    case integer:
      target = static_cast<long long>(numberFrom(value).get<double>());
      return;
    case text:
      target = value;
      return;
    case onOff:
      target = lowerCase(value) == "on";
      return;
    case flag:
      target = true;
      return;
    case list: {
      target = nlohmann::ordered_json::array();
      for (std::size_t at = 0; at <= value.size();) {
        const std::size_t end = std::min(value.find(',', at), value.size());
        target.push_back(value.substr(at, end - at));
        at = end + 1;
      }
      return;
    }
    case pairs: {
      const std::size_t equals = value.find('=');
      target[value.substr(0, equals)] = numberFrom(value.substr(equals + 1));
      return;
    }
  }
}

}  // namespace

std::span<const Setting> settings() {
  return kSettings;
}

const Setting* findSetting(SettingPlace place, std::string_view option) {
  const auto found = std::find_if(kSettings.begin(), kSettings.end(), [&](const Setting& setting) {
    return setting.place == place && setting.option == option;
  });
  return found == kSettings.end() ? nullptr : &*found;
}

std::vector<std::string> asArguments(const GivenOptions& options) {
  std::vector<std::string> arguments;
  for (const auto& [name, value] : options)
    arguments.push_back(value.empty() ? "--" + name : "--" + name + "=" + value);
  return arguments;
}

GivenOptions settingsOf(const JsonPlace& meniscus, SettingPlace place,
                        std::span<const std::string_view> others) {
  GivenOptions options;
  for (const std::string& key : meniscus.keys()) {
    if (std::find(others.begin(), others.end(), key) != others.end()) continue;
    std::string option = key;
    std::replace(option.begin(), option.end(), '_', '-');
    const Setting* setting = keyOf(option) == key ? findSetting(place, option) : nullptr;
    const JsonPlace value = meniscus.at(key);
    if (!setting) value.fail("there is no such setting here; see docs/scene.md");
    addOption(*setting, value, options);
  }
  return options;
}

nlohmann::ordered_json settingsAsJson(const GivenOptions& options, SettingPlace place) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [name, value] : options)
    if (const Setting* setting = findSetting(place, name)) addJson(*setting, value, json);
  return json;
}

void throwAboutKey(const JsonPlace& meniscus, std::string_view message) {
  const std::size_t colon = message.find(':');
  if (!message.starts_with("--") || colon == std::string_view::npos) meniscus.fail(message);
  const std::optional<JsonPlace> value = meniscus.find(keyOf(message.substr(2, colon - 2)));
  if (!value) meniscus.fail(message);
  value->fail(message.substr(std::min(colon + 2, message.size())));
}

}  // namespace meniscus

#pragma once
// What MolViewSpec has no words for stands under "custom": {"meniscus": {...}} of a node: the options of
// `meniscus render` under their names, "_" for "-", as JSON values (docs/meniscus.schema.json). On the root
// they are about the picture, on a structure about its atoms, on a representation about its look.

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/scene/json_place.h"

namespace meniscus {

enum class SettingPlace : std::uint8_t { picture, structure, look };

enum class SettingType : std::uint8_t {
  number,
  integer,
  text,
  list,   ///< texts; the option takes them separated by commas
  onOff,  ///< true or false; the option takes on or off
  flag,   ///< true or false; the option takes no value
  pairs   ///< an object of numbers; the option is given once for each, as NAME=VALUE
};

struct Setting {
  std::string_view option;  ///< without "--"
  SettingPlace place;
  SettingType type;
};

std::span<const Setting> settings();
const Setting* findSetting(SettingPlace place, std::string_view option);

/// Options by name (without "--") and value, in the order given; a flag's value is empty.
using GivenOptions = std::vector<std::pair<std::string, std::string>>;

/// As one would type them: "--name=value".
std::vector<std::string> asArguments(const GivenOptions& options);

/// The options that custom.meniscus of a node holds for `place`; keys in `others` are left to the caller.
/// Throws InputError, naming the key, if it is unknown or its value of a wrong type.
GivenOptions settingsOf(const JsonPlace& meniscus, SettingPlace place,
                        std::span<const std::string_view> others = {});

/// The inverse: those of the options that are about `place`, as an object.
nlohmann::ordered_json settingsAsJson(const GivenOptions& options, SettingPlace place);

/// Runs `use`; a UsageError about an option ("--name: ...") becomes an InputError about its key in
/// `meniscus`.
template <typename Use>
auto namingKeys(const JsonPlace& meniscus, Use use);

[[noreturn]] void throwAboutKey(const JsonPlace& meniscus, std::string_view message);

}  // namespace meniscus

#include "core/error.h"

namespace meniscus {

template <typename Use>
auto namingKeys(const JsonPlace& meniscus, Use use) {
  try {
    return use();
  } catch (const UsageError& error) {
    throwAboutKey(meniscus, error.what());
  }
}

}  // namespace meniscus

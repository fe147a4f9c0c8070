#include "app/style.h"

#include <array>
#include <optional>
#include <sstream>

#include "app/option_values.h"

namespace meniscus {

namespace {

constexpr std::array<Style, 5> kStyles{{
    {"flat", ""},
    {"soft", "--shadows soft --penumbra 4 --occlusion on"},
    {"full",
     "--shadows soft --occlusion on --outlines silhouettes --line-width 1 --depth-unsharp halo --fog 0.4"},
    {"illustration",
     "--key-light 0.2 --fill-light 0.1 --ambient-light 0.75 --highlight 0 "
     "--outlines silhouettes,chains --line-width 2 --fog 0.3"},
    {"publication",
     "--shadows soft --penumbra 3 --occlusion on --outlines silhouettes --line-width 1.2 --samples 64"},
}};

// The value of the last --style, as a word of its own or behind '='.
std::optional<std::string> chosenStyle(const std::vector<std::string>& arguments) {
  std::optional<std::string> chosen;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == "--") break;
    if (arguments[i] == "--style" && i + 1 < arguments.size()) chosen = arguments[i + 1];
    if (arguments[i].starts_with("--style=")) chosen = arguments[i].substr(8);
  }
  return chosen;
}

}  // namespace

std::span<const Style> styles() {
  return kStyles;
}

std::vector<std::string> withStyle(const std::vector<std::string>& arguments) {
  const std::optional<std::string> chosen = chosenStyle(arguments);
  if (!chosen) return arguments;
  std::array<std::string_view, kStyles.size()> names;
  for (std::size_t i = 0; i < kStyles.size(); ++i) names[i] = kStyles[i].name;
  std::istringstream words{std::string(kStyles[parseWord("--style", *chosen, names)].options)};
  std::vector<std::string> out;
  for (std::string word; words >> word;) out.push_back(word);
  out.insert(out.end(), arguments.begin(), arguments.end());
  return out;
}

}  // namespace meniscus

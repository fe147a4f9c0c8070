#pragma once
// Looks with a name: shorthands for options of `meniscus render`, nothing more.

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meniscus {

struct Style {
  std::string_view name;
  std::string_view options;  ///< as one would type them
};

std::span<const Style> styles();

/// The arguments with the options of the last --style among them put first, so that any option given beside
/// it has its way. Throws UsageError if there is no such style.
std::vector<std::string> withStyle(const std::vector<std::string>& arguments);

}  // namespace meniscus

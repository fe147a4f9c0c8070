#pragma once
// Words in any letter case.

#include <string>
#include <string_view>

namespace meniscus {

/// ASCII letters only, whatever the locale.
inline std::string lowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

}  // namespace meniscus

#pragma once
// Values of a CIF document as gemmi keeps them (raw text), read leniently and without throwing.

#include <charconv>
#include <cmath>
#include <cstdint>
#include <gemmi/cifdoc.hpp>
#include <gemmi/numb.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace meniscus {

/// Without quotes; empty for "?" and ".".
inline std::string_view cifText(const std::string& raw) {
  std::string_view text = raw;
  if (text.size() == 1 && (text[0] == '?' || text[0] == '.')) return {};
  if (text.size() >= 2 && (text[0] == '\'' || text[0] == '"')) return text.substr(1, text.size() - 2);
  if (text.size() >= 3 && text[0] == ';' && text[text.size() - 2] == '\n')
    return text.substr(1, text.size() - 3);
  return text;
}

/// NaN if it is not a number; "?" and "." give `absent`.
inline double cifNumber(const std::string& raw, double absent) {
  const std::string_view text = cifText(raw);
  if (text.empty()) return absent;
  return text.size() == raw.size() ? gemmi::cif::as_number(raw) : gemmi::cif::as_number(std::string(text));
}

/// The integer at the start of a text, and what follows it.
struct CifInteger {
  std::int32_t value = 0;
  std::string_view rest;
};

inline std::optional<CifInteger> cifInteger(std::string_view text) {
  if (!text.empty() && text[0] == '+') text.remove_prefix(1);
  CifInteger integer;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), integer.value);
  if (error != std::errc()) return std::nullopt;
  integer.rest = text.substr(static_cast<std::size_t>(end - text.data()));
  return integer;
}

}  // namespace meniscus

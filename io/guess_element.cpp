#include "io/guess_element.h"

#include <cstddef>
#include <string>

#include "core/elements.h"
#include "core/residue_templates.h"

namespace meniscus {
namespace {

bool isLetter(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}
bool isDigit(char c) {
  return c >= '0' && c <= '9';
}
char upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// Letters up to the first other character, leading digits skipped ("1HB2" -> "HB").
std::string leadingLetters(std::string_view name) {
  std::string letters;
  for (const char c : name) {
    if (isLetter(c)) {
      letters += upper(c);
    } else if (!letters.empty() || !isDigit(c)) {
      break;
    }
  }
  return letters;
}

std::uint8_t oneOrTwoLetters(std::string_view letters) {
  const std::uint8_t one = elementFromSymbol(letters.substr(0, 1));
  return one != 0 || letters.size() < 2 ? one : elementFromSymbol(letters.substr(0, 2));
}

}  // namespace

std::uint8_t guessElement(std::string_view field, std::string_view residueName) {
  const std::string_view name = trim(field);
  const std::string letters = leadingLetters(name);
  if (letters.empty()) return 0;
  if (findResidueTemplate(residueName)) {
    return letters.substr(0, 2) == "SE" ? elementFromSymbol("SE") : oneOrTwoLetters(letters.substr(0, 1));
  }
  const std::string residue = leadingLetters(trim(residueName));
  const std::uint8_t two = letters.size() >= 2 ? elementFromSymbol(letters.substr(0, 2)) : std::uint8_t{0};
  if (two != 0 && letters.size() == 2 && letters == residue) return two;  // an ion, however aligned
  const bool secondColumn = field.empty() || field[0] == ' ' || isDigit(field[0]);
  if (secondColumn) return oneOrTwoLetters(letters);
  const bool full = name.size() == 4;
  if (letters[0] == 'H' && full) return 1;
  if (letters.size() == 2 && two != 0) return two;
  return oneOrTwoLetters(letters);
}

}  // namespace meniscus

// Columns: wwPDB, Atomic Coordinate Entry Format Description 3.3 (2012); hybrid-36: R. W. Grosse-Kunstleve,
// cci.lbl.gov/hybrid_36. Columns are counted from 1 in the comments, from 0 in the code.
#include "io/pdb_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <functional>

#include "core/elements.h"
#include "core/error.h"
#include "io/guess_element.h"

namespace meniscus {
namespace {

constexpr std::size_t kWidth = 80;
constexpr std::int32_t kHybridFirst = 10 * 36 * 36 * 36 * 36;  // "A0000" in base 36 ...
constexpr std::int32_t kHybridOffset = 100'000;                // ... stands for this
constexpr std::size_t kMaxAtoms = 43'770'016;                  // "ZZZZZ" + 1: what five columns can number

using Card = std::array<char, kWidth + 1>;  // a line's columns and its end

char upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}
bool isDigit(char c) {
  return c >= '0' && c <= '9';
}
bool isLetter(char c) {
  return upper(c) >= 'A' && upper(c) <= 'Z';
}

bool isRecord(std::string_view line, std::string_view name) {
  if (line.size() < name.size())
    return line.size() >= 3 && name[line.size()] == ' ' && isRecord(line, name.substr(0, line.size()));
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (upper(line[i]) != name[i]) return false;
  }
  return true;
}

bool isAtom(std::string_view line) {
  return isRecord(line, "ATOM") || isRecord(line, "HETATM");
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

std::string_view field(std::string_view line, std::size_t first, std::size_t count) {
  return first < line.size() ? line.substr(first, count) : std::string_view();
}

/// Decimal or hybrid-36 (five columns); nothing for "*****" and the like.
std::optional<std::int32_t> parseSerial(std::string_view text) {
  text = trim(text);
  if (text.empty()) return std::nullopt;
  std::int32_t value = 0;
  const bool hybrid = isLetter(text[0]) && text.size() == 5;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, hybrid ? 36 : 10);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (!hybrid) return value;
  const bool lower = text[0] >= 'a';  // lower-case numbers follow the upper-case ones
  return value - kHybridFirst + kHybridOffset + (lower ? 26 * (kHybridFirst / 10) : 0);
}

void writeSerial(std::size_t index, char* out) {
  if (index < static_cast<std::size_t>(kHybridOffset)) {
    for (int i = 4; i >= 0; --i, index /= 10) out[i] = static_cast<char>('0' + index % 10);
  } else {
    index += static_cast<std::size_t>(kHybridFirst - kHybridOffset);
    for (int i = 4; i >= 0; --i, index /= 36) out[i] = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ"[index % 36];
  }
}

/// Blanks, a number with a decimal point or without, blanks; no NaN, no infinity.
bool isNumber(std::string_view text) {
  text = trim(text);
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) text.remove_prefix(1);
  bool digits = false;
  bool point = false;
  for (const char c : text) {
    if (isDigit(c)) {
      digits = true;
    } else if (c == '.' && !point) {
      point = true;
    } else {
      return false;
    }
  }
  return digits;
}

/// A residue number that gemmi reads: decimal, or hybrid-36 from "A000".
bool isResidueNumber(std::string_view text) {
  if (isLetter(text[0]))
    return std::all_of(text.begin(), text.end(), [](char c) { return isLetter(c) || isDigit(c); });
  return isNumber(text) && text.find('.') == std::string_view::npos;
}

bool containsIgnoringCase(std::string_view text, std::string_view upperWord) {
  return std::search(text.begin(), text.end(), upperWord.begin(), upperWord.end(),
                     [](char a, char b) { return upper(a) == b; }) != text.end();
}

bool namesPredictor(std::string_view line) {
  for (const std::string_view word : {"ALPHAFOLD", "ESMFOLD", "COLABFOLD", "ROSETTAFOLD", "OMEGAFOLD"}) {
    if (containsIgnoringCase(line, word)) return true;
  }
  return false;
}

/// Columns 7-11 are bonded to those in 12-31; what old files hold beyond are hydrogen bonds and salt bridges.
void parseConect(std::string_view line, std::size_t number, PdbOutline& outline, Oddities& oddities) {
  const std::optional<std::int32_t> from = parseSerial(field(line, 6, 5));
  std::array<std::int32_t, 4> partners{};
  std::size_t count = 0;
  bool legible = from.has_value();
  for (std::size_t i = 0; i < 4; ++i) {
    const std::string_view text = field(line, 11 + 5 * i, 5);
    if (trim(text).empty()) continue;
    const std::optional<std::int32_t> to = parseSerial(text);
    legible &= to.has_value();
    if (to && *to != 0) partners[count++] = *to;  // some programs fill up with zeros
  }
  if (!legible) oddities.add("CONECT record with serial numbers that cannot be read: left out", number);
  for (std::size_t i = 0; from && i < count; ++i) {
    // An atom named twice in one record is a double bond, three times a triple one.
    if (std::find(partners.begin(), partners.begin() + i, partners[i]) != partners.begin() + i) continue;
    const auto times = std::count(partners.begin(), partners.begin() + count, partners[i]);
    if (partners[i] != *from) {
      outline.conect.push_back(
          {*from, partners[i], static_cast<std::uint8_t>(std::min<std::ptrdiff_t>(times, 3))});
    }
  }
}

void appendCard(std::string& header, std::string_view line, std::size_t width = kWidth) {
  const std::string_view kept = line.substr(0, width);
  const bool lowerCase = line[0] >= 'a';
  for (const char c : kept) header += c < ' ' || c > '~' ? ' ' : lowerCase ? upper(c) : c;
  header.append(kWidth - kept.size(), ' ');
  header += '\n';
}

void noteHeader(std::string_view line, PdbOutline& outline) {
  if (isRecord(line, "REMARK")) {
    if (trim(field(line, 7, 3)) == "350") appendCard(outline.header, line);
    outline.saysPredicted |= namesPredictor(line);
  } else if (isRecord(line, "CRYST1")) {
    appendCard(outline.header, line, 54);
    outline.spaceGroup = trim(field(line, 55, 11));
  } else if (isRecord(line, "SSBOND") || isRecord(line, "LINK ") || isRecord(line, "HELIX ") ||
             isRecord(line, "SHEET ")) {
    appendCard(outline.header, line);
  } else if (isRecord(line, "HEADER")) {
    outline.entryId = trim(field(line, 62, 4));
    if (outline.entryId == "XXXX") outline.entryId.clear();
  } else if (isRecord(line, "TITLE")) {
    outline.saysPredicted |= namesPredictor(line);
  } else if (isRecord(line, "EXPDTA")) {
    for (const std::string_view word : {"DIFFRACTION", "NMR", "MICROSCOPY", "SCATTERING"}) {
      outline.saysExperiment |= containsIgnoringCase(line, word);
    }
  }
}

/// One ATOM or HETATM record on its way into columns.
class AtomCard {
 public:
  AtomCard(std::string_view line, std::size_t number, Oddities& oddities)
      : number_(number), oddities_(oddities) {
    const bool hetero = upper(line[0]) == 'H';
    lowerCase_ = line[0] >= 'a';
    card_.fill(' ');
    std::memcpy(card_.data(), line.data(), std::min(line.size(), kWidth));
    const auto printable = [](char c) { return c >= ' ' && c <= '~'; };
    int bad = 0;
    for (std::size_t i = 0; i < kWidth; ++i) bad |= printable(card_[i]) ? 0 : 1;
    if (bad) {
      oddities_.add("unprintable characters in an atom record: taken as blanks", number);
      std::replace_if(card_.begin(), card_.begin() + kWidth, std::not_fn(printable), ' ');
    }
    card_[kWidth] = '\n';
    readSerial(line);
    std::memcpy(card_.data(), hetero ? "HETATM" : "ATOM  ", 6);
  }

  const Card& mend(PdbAtomLine& atom) {
    atom.line = number_;
    atom.serial = serial_;
    if (lowerCase_) {
      oddities_.add("records in lower case", number_);
      for (const std::size_t i : {12, 13, 14, 15, 17, 18, 19, 76, 77}) card_[i] = upper(card_[i]);
    }
    mendResidue(atom);
    checkCoordinates();
    mendNumbers();
    mendElement();
    return card_;
  }

 private:
  std::string_view columns(std::size_t first, std::size_t last) const {
    return {card_.data() + first - 1, last - first + 1};
  }
  void readSerial(std::string_view line);
  void mendResidue(PdbAtomLine& atom);
  void checkCoordinates() const;
  void mendNumbers();
  void mendElement();

  Card card_{};
  std::size_t number_;
  Oddities& oddities_;
  std::int32_t serial_ = 0;
  bool lowerCase_ = false;
};

void AtomCard::readSerial(std::string_view line) {
  const bool six = isDigit(card_[6]) && isDigit(card_[10]) && isDigit(card_[11]);
  if (six && card_[34] != '.' && card_[35] == '.') {
    // A serial number of six digits has pushed the rest of the line to the right.
    oddities_.add("columns shifted by a serial number over 99999: moved back", number_);
    serial_ = parseSerial(columns(7, 12)).value_or(0);
    const std::string_view rest = line.substr(12, kWidth - 11);
    std::fill(card_.begin() + 11, card_.begin() + kWidth, ' ');
    std::memcpy(card_.data() + 11, rest.data(), rest.size());
    return;
  }
  const std::size_t first = isDigit(card_[5]) && upper(card_[0]) == 'A' ? 6 : 7;
  const std::optional<std::int32_t> serial = parseSerial(columns(first, 11));
  if (!serial) oddities_.add("serial number that cannot be read (*****?)", number_);
  serial_ = serial.value_or(0);
}

void AtomCard::mendResidue(PdbAtomLine& atom) {
  if (card_[20] != ' ') {
    static constexpr std::array<std::string_view, 8> kKnown{"TIP3", "TIP4", "TIP5", "SPCE",
                                                            "POPC", "POPE", "HEME", "DOPC"};
    const bool known = std::find(kKnown.begin(), kKnown.end(), columns(18, 21)) != kKnown.end();
    if (known || (card_[21] == ' ' && card_[17] != ' ')) {
      oddities_.add("residue name of four letters", number_);
      atom.fourthLetter = card_[20];
      card_[20] = ' ';
    }
  }
  if (!isResidueNumber(columns(23, 26))) std::memset(card_.data() + 22, ' ', 4);
}

void AtomCard::checkCoordinates() const {
  constexpr std::array<char, 3> kAxes{'x', 'y', 'z'};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t first = 31 + 8 * i;
    const std::string_view text = columns(first, first + 7);
    if (isNumber(text)) continue;
    throw InputError(fmt::format(
        "line {}: the {} coordinate '{}' (columns {}-{}) is not a number: correct or remove the line",
        number_, kAxes[i], trim(text), first, first + 7));
  }
}

void AtomCard::mendNumbers() {
  if (!isNumber(columns(55, 60))) {
    oddities_.add("no occupancy: taken as 1", number_);
    std::memcpy(card_.data() + 54, "  1.00", 6);
  }
  if (!isNumber(columns(61, 66))) {
    oddities_.add("no B factor: taken as 0", number_);
    std::memcpy(card_.data() + 60, "  0.00", 6);
  }
}

void AtomCard::mendElement() {
  const std::string_view symbol = trim(columns(77, 78));
  const bool letters = !symbol.empty() && std::all_of(symbol.begin(), symbol.end(), isLetter);
  std::uint8_t element = letters ? elementFromSymbol(symbol) : std::uint8_t{0};
  const bool isX = letters && symbol.size() == 1 && upper(symbol[0]) == 'X';
  if (element == 0 && !isX) {
    if (letters) {
      oddities_.add("unknown element in columns 77-78: guessed from the atom's name", number_);
    } else if (trim(columns(73, 80)).empty()) {
      oddities_.add("no element in columns 77-78: guessed from the atom's name", number_);
    } else {
      oddities_.add(
          "columns 73-80 hold other text (entry id, line number): elements guessed from the atoms' names",
          number_);
    }
    element = guessElement(columns(13, 16), columns(18, 20));
    std::memset(card_.data() + 72, ' ', 8);
  }
  if (element == 0) oddities_.add("atom of unknown element", number_);
  const std::string_view known = elementSymbol(element);
  card_[76] = known.size() == 2 ? known[0] : ' ';
  card_[77] = known.back();
  std::memset(card_.data() + 66, ' ', 10);
  const char a = card_[78];
  const char b = card_[79];
  const bool charge = (isDigit(a) && (b == '+' || b == '-')) || (isDigit(b) && (a == '+' || a == '-'));
  if (!charge) std::memset(card_.data() + 78, ' ', 2);
}

}  // namespace

PdbOutline outlinePdb(std::string_view text, Oddities& oddities) {
  PdbOutline outline;
  std::optional<PdbModelSpan> open;
  std::optional<int> nextNumber;
  bool ended = false;
  const auto close = [&] {
    if (open) outline.models.push_back(*open);
    open.reset();
    nextNumber.reset();
  };
  forEachLine(text, 1, [&](std::string_view line, std::size_t number) {
    if (line.size() < 3) return;
    if (isAtom(line)) {
      const auto begin = static_cast<std::size_t>(line.data() - text.data());
      if (!open) {
        if (ended) oddities.add("atoms after END: read as another model", number);
        open = PdbModelSpan{begin, begin, number, nextNumber};
        ended = false;
      }
      open->end = begin + line.size();
    } else if (isRecord(line, "ANISOU")) {
      if (open) open->end = static_cast<std::size_t>(line.data() - text.data()) + line.size();
    } else if (isRecord(line, "CONECT")) {
      parseConect(line, number, outline, oddities);
    } else if (isRecord(line, "MODEL ")) {
      if (open) oddities.add("MODEL without ENDMDL before it", number);
      close();
      ended = false;
      const std::string_view digits = trim(field(line, 6, 20));
      int value = 0;
      const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), value);
      if (result.ec == std::errc()) nextNumber = value;
    } else if (isRecord(line, "ENDMDL")) {
      close();
    } else if (isRecord(line, "END") && trim(line.substr(3)).empty()) {
      ended = open.has_value();
      close();
    } else {
      noteHeader(line, outline);
    }
  });
  close();
  return outline;
}

MendedPdb mendPdbModel(std::string_view text, const PdbModelSpan& model, Oddities& oddities) {
  MendedPdb mended;
  const std::string_view body = text.substr(model.begin, model.end - model.begin);
  mended.text.reserve(body.size() + body.size() / 16 + 2 * kWidth);
  mended.atoms.reserve(body.size() / kWidth + 1);
  std::array<char, 15> lastAtom{};  // columns 13-27: name, altloc, residue, chain, number
  bool mayHaveAnisou = false;
  forEachLine(body, model.firstLine, [&](std::string_view line, std::size_t number) {
    if (isAtom(line)) {
      if (mended.atoms.size() == kMaxAtoms)
        throw InputError("holds more than 43,770,016 atom records: split it");
      PdbAtomLine atom;
      AtomCard card(line, number, oddities);
      Card columns = card.mend(atom);
      writeSerial(mended.atoms.size(), columns.data() + 6);
      mended.text.append(columns.data(), columns.size());
      mended.atoms.push_back(atom);
      mayHaveAnisou = line.size() >= 27;
      if (mayHaveAnisou) std::memcpy(lastAtom.data(), line.data() + 12, lastAtom.size());
    } else if (isRecord(line, "ANISOU")) {
      if (!mayHaveAnisou || line.size() < 70 ||
          std::memcmp(lastAtom.data(), line.data() + 12, lastAtom.size()) != 0) {
        oddities.add("ANISOU record that does not follow its atom: left out", number);
        return;
      }
      appendCard(mended.text, line);
      mayHaveAnisou = false;
    }
  });
  return mended;
}

}  // namespace meniscus

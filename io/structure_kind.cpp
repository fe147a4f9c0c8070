#include "io/structure_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include "core/error.h"

namespace meniscus {
namespace {

constexpr std::string_view kSupported = "PDB and mmCIF are read, plain or gzipped, and BinaryCIF";

[[noreturn]] void refuse(std::string_view what) {
  throw InputError(fmt::format("{}: {}", what, kSupported));
}

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool startsWithIgnoringCase(std::string_view text, std::string_view lowerPrefix) {
  if (text.size() < lowerPrefix.size()) return false;
  return std::equal(lowerPrefix.begin(), lowerPrefix.end(), text.begin(),
                    [](char a, char b) { return a == lower(b); });
}

/// Text has no NUL and hardly any other control characters.
bool isBinary(std::string_view head) {
  std::size_t odd = 0;
  for (const char c : head) {
    const auto u = static_cast<unsigned char>(c);
    if (u == 0) return true;
    if ((u < 32 && (u < 9 || u > 13)) || u == 127) ++odd;
  }
  return odd * 50 > head.size();
}

/// The text from its first line that is neither blank nor a CIF comment.
std::string_view skipBlankAndComments(std::string_view text) {
  while (!text.empty()) {
    const std::size_t start = text.find_first_not_of(" \t\r\n\f\v");
    if (start == std::string_view::npos) return {};
    text.remove_prefix(start);
    if (text[0] != '#') return text;
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end);
  }
  return text;
}

bool startsLikePdb(std::string_view line) {
  static constexpr std::array<std::string_view, 32> kRecords{
      "atom",   "hetatm", "header", "title",  "remark", "cryst1", "model ", "compnd",
      "source", "keywds", "expdta", "author", "revdat", "jrnl",   "seqres", "helix",
      "sheet",  "ssbond", "link ",  "scale",  "origx",  "mtrix",  "dbref",  "obslte",
      "caveat", "split ", "nummdl", "het ",   "hetnam", "formul", "ter",    "conect"};
  return std::any_of(kRecords.begin(), kRecords.end(),
                     [line](std::string_view record) { return startsWithIgnoringCase(line, record); });
}

}  // namespace

StructureKind detectKind(std::string_view text, std::string_view extension) {
  const std::string_view start = skipBlankAndComments(text);
  for (const std::string_view word : {"data_", "loop_", "global_", "save_"}) {
    if (startsWithIgnoringCase(start, word)) return StructureKind::mmcif;
  }
  if (text.substr(0, 4) == std::string_view("\0\0\x07\xCB", 4) || extension == ".xtc")
    refuse("is a GROMACS XTC trajectory");
  if (text.substr(4, 4) == "CORD" || extension == ".dcd") refuse("is a DCD trajectory");
  if (isBinary(text.substr(0, 4096))) refuse("is a binary file, no structure");
  if (extension == ".gro") refuse("is a GROMACS GRO file");
  if (startsWithIgnoringCase(start, "<!doctype html") || startsWithIgnoringCase(start, "<html")) {
    throw InputError(
        "is a web page, not a structure: open its address in a browser and save the file itself");
  }
  if (startsWithIgnoringCase(start, "<?xml")) refuse("is an XML file");
  if (!start.empty() && (start[0] == '{' || start[0] == '[')) refuse("is a JSON file");
  if (start.empty()) refuse("holds nothing but blanks and comments");
  bool pdb = false;
  std::size_t budget = 1000;  // lines of preamble that may stand before the first record
  for (std::size_t at = 0; at < text.size() && budget > 0 && !pdb; --budget) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    pdb = startsLikePdb(text.substr(at, std::min<std::size_t>(end - at, 80)));
    at = end + 1;
  }
  if (pdb) return StructureKind::pdb;
  refuse("is no structure that is known here");
}

}  // namespace meniscus

#pragma once
// PDB text of every era, brought into the form of format 3.3 that gemmi reads.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/connections.h"
#include "io/oddities.h"

namespace meniscus {

/// Where one model's atoms stand in the text.
struct PdbModelSpan {
  std::size_t begin = 0, end = 0;  ///< bytes
  std::size_t firstLine = 1;
  std::optional<int> number;  ///< of its MODEL record
};

/// What a first walk over the lines finds.
struct PdbOutline {
  std::vector<PdbModelSpan> models;  ///< those that have atoms
  std::string header;                ///< CRYST1, REMARK 350, HELIX, SHEET, SSBOND and LINK, for gemmi
  std::string entryId;               ///< of HEADER; may be empty
  std::string spaceGroup;            ///< of CRYST1; may be empty
  std::vector<SerialBond> conect;
  bool saysPredicted = false;   ///< the title or a remark names a program that predicts structures
  bool saysExperiment = false;  ///< EXPDTA names an experiment
};

PdbOutline outlinePdb(std::string_view text, Oddities& oddities);

/// What gemmi's atoms do not carry, in the order of the file.
struct PdbAtomLine {
  std::size_t line = 0;
  std::int32_t serial = 0;  ///< as in the file, hybrid-36 decoded; 0 if it is no number
  char fourthLetter = ' ';  ///< of a residue name of four letters, which gemmi cuts to three
};

struct MendedPdb {
  std::string
      text;  ///< 80-column ATOM, HETATM and ANISOU records; the serial number is the index into `atoms`
  std::vector<PdbAtomLine> atoms;
};

/// Mends the records of one model: elements are filled in, columns 67-76 emptied, lines cut or padded to 80
/// columns. Throws InputError (line and remedy, without the file's name) where a coordinate is not a number.
MendedPdb mendPdbModel(std::string_view text, const PdbModelSpan& model, Oddities& oddities);

/// Calls visit(line, number) for every line, without its end, which may be LF or CRLF.
template <typename Visit>
void forEachLine(std::string_view text, std::size_t firstLine, Visit visit) {
  for (std::size_t number = firstLine, at = 0; at < text.size(); ++number) {
    std::size_t end = text.find('\n', at);
    if (end == std::string_view::npos) end = text.size();
    std::string_view line = text.substr(at, end - at);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    visit(line, number);
    at = end + 1;
  }
}

}  // namespace meniscus

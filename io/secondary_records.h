#pragma once
// Helices and strands as files state them: from one residue to another.

#include <cstdint>
#include <string>
#include <vector>

#include "core/molecule.h"
#include "io/oddities.h"

namespace meniscus {

struct SecondaryRange {
  SecondaryStructure kind = SecondaryStructure::helix;
  std::string firstChain, lastChain;  ///< names as in Molecule::chains
  std::int32_t firstNumber = 0, lastNumber = 0;
  char firstInsertion = ' ', lastInsertion = ' ';
};

/// Marks the residues and sets hasSecondary if there is any range. Where two overlap, a helix wins. Ranges
/// whose residues are not there become oddities.
void addSecondary(Molecule& molecule, const std::vector<SecondaryRange>& ranges, Oddities& oddities);

}  // namespace meniscus

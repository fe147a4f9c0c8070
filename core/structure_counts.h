#pragma once
// How much of what a molecule holds, counted as structural biologists count.

#include <cstddef>
#include <string>
#include <vector>

#include "core/molecule.h"

namespace meniscus {

struct LigandCount {
  std::string name;       ///< residue name
  std::size_t count = 0;  ///< distinct chain + number + insertion code
  bool operator==(const LigandCount&) const = default;
};

struct StructureCounts {
  std::size_t atoms = 0;  ///< every alternate location counted
  std::size_t residues =
      0;  ///< distinct chain + number + insertion code: a place with two residue names counts once
  std::size_t chains = 0;            ///< distinct author chain ids
  std::vector<LigandCount> ligands;  ///< residues that are neither polymer nor water, by name
};

StructureCounts countStructure(const Molecule& molecule);

}  // namespace meniscus

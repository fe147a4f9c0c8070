#pragma once
// The backbones of proteins and nucleic acids as runs without a gap.

#include <cstdint>
#include <vector>

#include "core/molecule.h"

namespace meniscus {

constexpr std::uint32_t kNoAtom = 0xFFFFFFFFu;

/// One residue of a backbone; atoms that are missing are kNoAtom. Of alternate locations the first is taken.
struct BackboneResidue {
  std::uint32_t residue = 0;
  std::uint32_t trace = kNoAtom;                          ///< always there: CA, or C4' of a nucleotide
  std::uint32_t n = kNoAtom, c = kNoAtom, o = kNoAtom;    ///< amino acids
  std::uint32_t c1 = kNoAtom, o3 = kNoAtom, p = kNoAtom;  ///< nucleotides: C1', O3', P
  std::uint32_t base =
      kNoAtom;  ///< nucleotides: the base's atom farthest from the backbone that pairs: N1 or N3
};

struct Backbone {
  bool nucleic = false;
  std::vector<BackboneResidue> residues;  ///< bound one to the next
};

/// All backbones of a molecule. A run ends where the bond to the next residue is missing (C-N or O3'-P longer
/// than 2.5 Å; without these atoms, trace atoms farther apart than 4.3 or 9 Å) and where a residue lacks its
/// trace atom. Of residues that share a place the first counts.
std::vector<Backbone> findBackbones(const Molecule& molecule);

}  // namespace meniscus

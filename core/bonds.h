#pragma once
// Bonds that a structure file leaves unsaid. Order of trust: the file's own records, residue templates,
// distance.

#include <cstddef>

#include "core/logger.h"
#include "core/molecule.h"

namespace meniscus {

/// Adds to molecule.bonds what its records lack: bonds within standard amino acids and nucleotides and the
/// links between them by template, everything else by distance (sum of Cordero covalent radii + 0.45 Å, at
/// least 0.4 Å; never between different non-blank altlocs, never H-H; metals by a rule of their own).
/// Linear in atoms. Bonds come out sorted by (a, b), without duplicates, each with the most trusted origin.
void addMissingBonds(Molecule& molecule, Logger& logger);

/// Number of bonds of an origin.
std::size_t countBonds(const Molecule& molecule, BondOrigin origin);

}  // namespace meniscus

#pragma once
// What a residue is, by its name or, for names nobody knows, by its atoms.

#include <cstdint>
#include <span>
#include <string>

#include "core/molecule.h"

namespace meniscus {

/// By name: standard and modified amino acids and nucleotides, waters, sugars, ions; by the backbone's atom
/// names otherwise.
ResidueKind residueKind(const std::string& name, std::span<const AtomName> atoms,
                        std::span<const std::uint8_t> elements);

/// Amino acids and nucleotides written as HETATM that continue no chain (cAMP, a glycine of the buffer)
/// become ligands.
void demoteFreeMonomers(Molecule& molecule);

}  // namespace meniscus

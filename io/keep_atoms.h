#pragma once
// Taking atoms out of a molecule.

#include <cstdint>
#include <vector>

#include "core/molecule.h"

namespace meniscus {

/// Drops every atom whose entry in `keep` (one per atom) is 0; residues and chains that become empty go,
/// bonds and assemblies are adjusted.
void keepAtoms(Molecule& molecule, const std::vector<std::uint8_t>& keep);

}  // namespace meniscus

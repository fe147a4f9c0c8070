#pragma once
// Component definitions (wwPDB chemical component dictionary, CCP4 monomer library) as molecules of one
// residue.

#include <gemmi/cifdoc.hpp>

#include "io/format_readers.h"

namespace meniscus {

/// The atoms of _chem_comp_atom at their ideal positions, or at those of the example if an ideal one is
/// missing; the bonds of _chem_comp_bond with their orders (aromatic ones as 4) as BondOrigin::connection.
ReadModels readChemComp(gemmi::cif::Block& block, const ModelChoice& choice, Oddities& oddities);

}  // namespace meniscus

#pragma once
// MolViewSpec's component selectors, evaluated on a Molecule.

#include <cstdint>
#include <string>
#include <vector>

#include "app/scene/json_place.h"
#include "core/molecule.h"

namespace meniscus {

/// Atoms that `selector` chooses, ascending: a word (all, polymer, protein, nucleic, branched, ligand, ion,
/// water, coarse), an expression, or a list of expressions, of which an atom must match one. A structure
/// without label_ ids (PDB) is matched by its auth_ ids. Parts that cannot be evaluated choose nothing and
/// are added to `unsupported`. Throws InputError naming the place on unknown words, fields and types.
std::vector<std::uint32_t> selectComponent(const Molecule& molecule, const JsonPlace& selector,
                                           std::vector<std::string>& unsupported);

}  // namespace meniscus

#pragma once
// Copies of an asymmetric unit by the symmetry of its crystal.

#include <glm/vec3.hpp>
#include <vector>

#include "core/assembly.h"

namespace meniscus {

/// All copies whose middle lies in the unit cells from `low` to `high` (both included), counted from the cell
/// that holds the middle of the molecule. Throws InputError, without a file's name, if the molecule has no
/// cell or no known space group, or if more than a million copies would result.
std::vector<Placement> placeSymmetry(const Molecule& molecule, glm::ivec3 low, glm::ivec3 high);

/// The molecule, and all copies of it that come within `radius` [Å] of one of its atoms. Throws as above.
std::vector<Placement> placeSymmetryMates(const Molecule& molecule, double radius);

}  // namespace meniscus

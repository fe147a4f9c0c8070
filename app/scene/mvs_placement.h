#pragma once
// Where MolViewSpec puts a structure: copies of an assembly or a crystal, moved and repeated.

#include <vector>

#include "app/scene/mvs_nodes.h"
#include "core/assembly.h"

namespace meniscus {

/// The copies that a structure node's type asks for. Throws InputError naming the place.
std::vector<Placement> placementsOf(const MvsNode& structure, const Molecule& molecule);

/// Moves placements by the transform nodes under `node`, and repeats them by its instance nodes. Throws
/// InputError if one is no rigid motion.
void movePlacements(const MvsNode& node, const Molecule& molecule, std::vector<Placement>& placements,
                    std::vector<std::string>& unsupported);

}  // namespace meniscus

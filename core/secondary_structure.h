#pragma once
// Helices and strands from coordinates. W. Kabsch, C. Sander, Dictionary of protein secondary structure,
// Biopolymers 22, 2577-2637 (1983), doi 10.1002/bip.360221211. Deviations: three states only (helices of all
// three kinds are one; isolated bridges, turns and bends are coil).

#include <vector>

#include "core/backbone.h"

namespace meniscus {

/// By residue: what hydrogen bonds between backbones make of it.
std::vector<SecondaryStructure> assignSecondary(const Molecule& molecule,
                                                const std::vector<Backbone>& backbones);

/// By residue: what the file says, or assignSecondary() where it says nothing.
std::vector<SecondaryStructure> secondaryOf(const Molecule& molecule, const std::vector<Backbone>& backbones);

}  // namespace meniscus

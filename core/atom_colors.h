#pragma once
// Colours of atoms by what the molecule says about them.

#include <vector>

#include "core/scene.h"

namespace meniscus {

/// One colour per atom. bFactor: blue (5th percentile) - white - red (95th percentile of this molecule's
/// atoms); plddt: AlphaFold's thresholds 90, 70, 50; rainbow: each chain from blue (N or 5' end) to red;
/// chain: a palette of 20 well separated colours in order of appearance; residue: by chemical kind of
/// residue.
std::vector<Rgb> colorAtoms(const Molecule& molecule, const Coloring& coloring);

}  // namespace meniscus

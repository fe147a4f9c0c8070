#pragma once
// Many copies of one molecule: biological assemblies and lattices.

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "core/molecule.h"

namespace meniscus {

/// One placed copy of a part of a molecule.
struct Placement {
  glm::dmat4 transform{1.0};         ///< rigid motion, Å
  std::vector<IndexRange> residues;  ///< what is copied: ranges into Molecule::residues
  bool operator==(const Placement&) const = default;
};

/// The molecule as it stands: one placement of all residues.
std::vector<Placement> placeOnce(const Molecule& molecule);

/// The copies of assembly `id`; "1", "2", ... as in the file. Throws UsageError listing the ids there are.
std::vector<Placement> placeAssembly(const Molecule& molecule, const std::string& id);

/// Repeats placements on an n.x by n.y by n.z lattice, spaced by the extent of what is placed plus 4 Å and
/// centred on the original.
std::vector<Placement> replicate(const Molecule& molecule, const std::vector<Placement>& placements,
                                 glm::ivec3 n);

/// Indices of placements by the residues that they hold, in the order of the first of each.
std::vector<std::vector<std::uint32_t>> alikePlacements(const std::vector<Placement>& placements);

}  // namespace meniscus

#pragma once
// From a structure file and the options of the command line to pictures.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/picture.h"

namespace meniscus {

/// One object as the options describe it, of all atoms, where it is placed once.
SceneObject objectAsAsked(const RenderOptions& options, std::shared_ptr<const Molecule> molecule);

/// A label at the middle of these atoms, in all placements together.
Label labelOf(std::shared_ptr<const Molecule> molecule, const std::vector<Placement>& placements,
              std::vector<std::uint32_t> atoms, const std::string& text);

/// How many of these atoms (ascending; none = all) the placements draw.
double placedAtomCount(const Molecule& molecule, const std::vector<std::uint32_t>& atoms,
                       const std::vector<Placement>& placements);

/// What an atom takes of memory at most, a picture aside [bytes]. Measured for spheres on 16 million atoms;
/// the others add what their primitives take.
double bytesPerAtom(Representation representation);

/// What these atoms (none = all) in these placements, `lattice` times each, take of memory at most [bytes].
/// Copies of what is drawn atom by atom share it, while it is cast from tiles.
double bytesOfCopies(const Molecule& molecule, const std::vector<std::uint32_t>& atoms,
                     const std::vector<Placement>& placements, Representation representation,
                     double lattice = 1);

/// Throws InputError naming `file` if `placed` atoms, copies of `atoms`, which take `bytes` all together, do
/// not fit into memory.
void requireMemory(const std::string& file, double atoms, double placed, double bytes);
/// Likewise if they are more than there are ids.
void requireIds(const std::string& file, double atoms, double placed);

/// The pictures of a file: one, or one per model. `bytes` are the file's. Throws InputError and UsageError.
Preparation structurePictures(const std::string& file, std::string bytes, const RenderOptions& options);

}  // namespace meniscus

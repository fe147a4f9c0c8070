#pragma once
// Displacement of atoms as probability ellipsoids: the surfaces xᵀ U⁻¹ x = s², inside which a normally
// distributed atom is found with a given probability.
//
// Johnson and Burnett, ORTEP-III, ORNL-6895, 1996, doi 10.2172/369685; U and B as in Trueblood et al.,
// Acta Cryst. A52 (1996), 770-781, doi 10.1107/S0108767396005697.

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <vector>

#include "core/logger.h"
#include "core/molecule.h"

namespace meniscus {

/// What a displacement was taken from, in the order in which they are tried.
enum class DisplacementSource : std::uint8_t {
  tensor,         ///< ANISOU
  isotropicB,     ///< U = B / (8 pi^2)
  isotropicPart,  ///< of a tensor that is not positive definite: a third of its trace
  none            ///< nothing positive: no displacement is known
};

/// Principal axes of the mean-square displacement of one atom.
struct Displacement {
  glm::dmat3 axes{0.0};  ///< columns: orthogonal semi-axes of the ellipsoid xᵀ U⁻¹ x = 1 [Å], longest first
  bool isotropic = true;
  DisplacementSource source = DisplacementSource::none;  ///< none: axes are zero
};

/// One per atom. A predicted model's B column holds no displacement.
std::vector<Displacement> displacementsOf(const Molecule& molecule);

/// Says how many tensors are not positive definite, how many atoms have no displacement, and which is the
/// first of each.
void noteOddDisplacements(const Molecule& molecule, Logger& logger);

/// s of the ellipsoid that holds an atom with `probability` (0 < p < 1): the square root of the quantile of
/// chi-square with three degrees of freedom; 1.5382 for one half.
double displacementScale(double probability);

}  // namespace meniscus

#pragma once
// Axes of a symmetric 3x3 matrix.

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace meniscus {

struct SymmetricEigen {
  glm::dvec3 values;   ///< in no particular order
  glm::dmat3 vectors;  ///< columns: orthonormal, one for each value
};

/// Cyclic Jacobi rotations (Golub & Van Loan, Matrix Computations, 8.5); `m` must be symmetric and finite.
SymmetricEigen symmetricEigen(glm::dmat3 m);

}  // namespace meniscus

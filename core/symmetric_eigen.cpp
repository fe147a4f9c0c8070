#include "core/symmetric_eigen.h"

#include <cmath>
#include <glm/matrix.hpp>

namespace meniscus {

SymmetricEigen symmetricEigen(glm::dmat3 m) {
  glm::dmat3 v(1.0);
  for (int sweep = 0; sweep < 32; ++sweep) {
    const double off = m[0][1] * m[0][1] + m[0][2] * m[0][2] + m[1][2] * m[1][2];
    if (off == 0) break;
    for (int p = 0; p < 2; ++p) {
      for (int q = p + 1; q < 3; ++q) {
        if (m[p][q] == 0) continue;
        const double tau = (m[q][q] - m[p][p]) / (2 * m[p][q]);
        const double t = (tau >= 0 ? 1 : -1) / (std::abs(tau) + std::hypot(1.0, tau));
        const double c = 1 / std::hypot(1.0, t);
        glm::dmat3 turn(1.0);
        turn[p][p] = turn[q][q] = c;
        turn[q][p] = t * c;
        turn[p][q] = -t * c;
        m = glm::transpose(turn) * m * turn;
        m[p][q] = m[q][p] = 0;
        v = v * turn;
      }
    }
  }
  return {{m[0][0], m[1][1], m[2][2]}, v};
}

}  // namespace meniscus

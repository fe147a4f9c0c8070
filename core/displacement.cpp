#include "core/displacement.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/symmetric_eigen.h"

namespace meniscus {

namespace {

constexpr double kPi = 3.141592653589793;

// Eigenvalues nearer to each other, or to zero, than this share of the largest are so within the rounding of
// a float32 tensor.
constexpr double kResolution = 1e-6;

glm::dmat3 matrixOf(const Anisotropy& u) {
  return {{u.u11, u.u12, u.u13}, {u.u12, u.u22, u.u23}, {u.u13, u.u23, u.u33}};
}

bool isFinite(const Anisotropy& u) {
  return std::isfinite(u.u11 + u.u22 + u.u33 + u.u12 + u.u13 + u.u23);
}

Displacement isotropicOf(double meanSquare, DisplacementSource source) {
  if (!(meanSquare > 0 && std::isfinite(meanSquare))) return {};
  return {glm::dmat3(std::sqrt(meanSquare)), true, source};
}

Displacement displacementOf(const Molecule& molecule, std::size_t atom) {
  if (molecule.anisotropies.empty() || molecule.anisotropies[atom].isZero()) {
    if (molecule.predicted) return {};
    return isotropicOf(static_cast<double>(molecule.bFactors[atom]) / (8 * kPi * kPi),
                       DisplacementSource::isotropicB);
  }
  const Anisotropy& u = molecule.anisotropies[atom];
  if (!isFinite(u)) return {};
  const SymmetricEigen eigen = symmetricEigen(matrixOf(u));
  std::array<int, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return eigen.values[a] > eigen.values[b]; });
  const double largest = eigen.values[order[0]], smallest = eigen.values[order[2]];
  if (!(smallest > kResolution * largest)) {
    const double trace = eigen.values.x + eigen.values.y + eigen.values.z;
    return isotropicOf(trace / 3, DisplacementSource::isotropicPart);
  }
  if (largest - smallest <= kResolution * largest) return isotropicOf(largest, DisplacementSource::tensor);
  Displacement d{glm::dmat3(0.0), false, DisplacementSource::tensor};
  for (int i = 0; i < 3; ++i) {
    const int from = order[static_cast<std::size_t>(i)];
    d.axes[i] = eigen.vectors[from] * std::sqrt(eigen.values[from]);
  }
  return d;
}

// "CA of ALA 12 A"
std::string nameOf(const Molecule& molecule, std::size_t atom) {
  const Residue& residue = molecule.residues[molecule.residueOf[atom]];
  std::string text = atom < molecule.names.size() ? std::string(molecule.names[atom].view()) : "?";
  text += fmt::format(" of {} {}", residue.name, residue.number);
  const std::string& chain = molecule.chains[residue.chain].name;
  return chain.empty() ? text : text + " " + chain;
}

struct Tally {
  std::size_t count = 0, first = 0;
  void add(std::size_t atom) {
    if (count++ == 0) first = atom;
  }
};

// Probability of |x| <= s for a standard normal x in three dimensions: erf(s / sqrt 2) - sqrt(2 / pi) s
// exp(-s^2 / 2), and below 1, where that cancels, the series of the incomplete gamma function.
double inside(double s) {
  const double density = std::sqrt(2 / kPi) * std::exp(-0.5 * s * s);
  if (s >= 1) return std::erf(s / std::sqrt(2.0)) - density * s;
  double term = s * s * s / 3, sum = term;
  for (int k = 5; term > 1e-17 * sum; k += 2) sum += term *= s * s / k;
  return density * sum;
}

double outside(double s) {
  return s < 1 ? 1 - inside(s)
               : std::erfc(s / std::sqrt(2.0)) + std::sqrt(2 / kPi) * s * std::exp(-0.5 * s * s);
}

}  // namespace

std::vector<Displacement> displacementsOf(const Molecule& molecule) {
  std::vector<Displacement> out;
  out.reserve(molecule.atomCount());
  for (std::size_t atom = 0; atom < molecule.atomCount(); ++atom)
    out.push_back(displacementOf(molecule, atom));
  return out;
}

void noteOddDisplacements(const Molecule& molecule, Logger& logger) {
  Tally indefinite, unknown;
  const std::vector<Displacement> displacements = displacementsOf(molecule);
  for (std::size_t atom = 0; atom < displacements.size(); ++atom) {
    const bool tensor = !molecule.anisotropies.empty() && !molecule.anisotropies[atom].isZero();
    if (displacements[atom].source == DisplacementSource::isotropicPart) indefinite.add(atom);
    if (displacements[atom].source == DisplacementSource::none) {
      if (tensor) indefinite.add(atom);
      unknown.add(atom);
    }
  }
  if (indefinite.count > 0) {
    logger.note(fmt::format(
        "{} displacement tensor{} not positive definite, first {}; drawn as the isotropic part",
        indefinite.count, indefinite.count == 1 ? " is" : "s are", nameOf(molecule, indefinite.first)));
  }
  if (unknown.count > 0) {
    logger.note(
        fmt::format("{} atom{} no displacement{}, first {}; drawn as small spheres", unknown.count,
                    unknown.count == 1 ? " has" : "s have",
                    molecule.predicted ? " (the B column of a predicted model holds its confidence)" : "",
                    nameOf(molecule, unknown.first)));
  }
}

double displacementScale(double probability) {
  MENISCUS_CHECK(probability > 0 && probability < 1);
  double low = 0, high = 1;
  while (outside(high) > 1 - probability && high < 64) high *= 2;
  double s = 0.5 * (low + high);
  // Newton's method, kept inside the bracket; the tail that is smaller is the one without cancellation.
  for (int i = 0; i < 200; ++i) {
    const double excess = probability <= 0.5 ? inside(s) - probability : (1 - probability) - outside(s);
    (excess > 0 ? high : low) = s;
    const double slope = std::sqrt(2 / kPi) * s * s * std::exp(-0.5 * s * s);
    double next = s - excess / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - s) <= 1e-15 * s) return next;
    s = next;
  }
  return s;
}

}  // namespace meniscus

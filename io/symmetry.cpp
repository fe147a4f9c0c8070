// Space groups and cells are gemmi's.
#include "io/symmetry.h"

#include <fmt/format.h>

#include <cmath>
#include <gemmi/symmetry.hpp>
#include <gemmi/unitcell.hpp>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <unordered_set>

#include "core/error.h"

namespace meniscus {
namespace {

constexpr double kMaxCopies = 1'000'000;

struct Crystal {
  glm::dmat3 toCartesian{1.0}, toFractional{1.0};
  std::vector<glm::dmat4> operations;  // fractional
  glm::dvec3 middle{0.0};              // of the molecule, fractional
};

glm::dvec3 middleOf(const Molecule& molecule) {
  glm::dvec3 sum(0.0);
  for (const glm::dvec3& p : molecule.positions) sum += p;
  return sum / static_cast<double>(std::max<std::size_t>(molecule.atomCount(), 1));
}

Crystal crystalOf(const Molecule& molecule) {
  if (!molecule.cell) throw InputError("the structure has no unit cell, so there are no symmetry mates");
  const UnitCell& c = *molecule.cell;
  const gemmi::SpaceGroup* group = gemmi::find_spacegroup_by_name(molecule.spaceGroup, c.alpha, c.gamma);
  if (group == nullptr)
    throw InputError(fmt::format("the structure's space group '{}' is not known", molecule.spaceGroup));
  const gemmi::UnitCell cell(c.a, c.b, c.c, c.alpha, c.beta, c.gamma);
  Crystal crystal;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) crystal.toCartesian[column][row] = cell.orth.mat[row][column];
  crystal.toFractional = glm::inverse(crystal.toCartesian);
  crystal.middle = crystal.toFractional * middleOf(molecule);
  for (const gemmi::Op& op : group->operations()) {
    glm::dmat4 matrix(1.0);
    for (std::size_t row = 0; row < 3; ++row) {
      const auto r = static_cast<int>(row);
      for (std::size_t column = 0; column < 3; ++column)
        matrix[static_cast<int>(column)][r] = static_cast<double>(op.rot[row][column]) / gemmi::Op::DEN;
      matrix[3][r] = static_cast<double>(op.tran[row]) / gemmi::Op::DEN;
    }
    crystal.operations.push_back(matrix);
  }
  return crystal;
}

// Takes the copy's middle into the cell `at`, relative to the molecule's.
Placement placed(const Crystal& crystal, glm::dmat4 operation, glm::ivec3 at,
                 const std::vector<IndexRange>& residues) {
  const glm::dvec3 middle(operation * glm::dvec4(crystal.middle, 1.0));
  // A middle on a cell's face belongs to either side by a rounding: the identity must not move.
  const glm::dvec3 shift = glm::floor(crystal.middle) - glm::floor(middle + 1e-9) + glm::dvec3(at);
  const bool identity = operation == glm::dmat4(1.0) && at == glm::ivec3(0);
  if (identity) return {glm::dmat4(1.0), residues};
  operation[3] += glm::dvec4(shift, 0.0);
  const glm::dmat4 result = glm::dmat4(crystal.toCartesian) * operation * glm::dmat4(crystal.toFractional);
  return {result, residues};
}

// Which cubes of side `size` hold atoms.
class Cubes {
 public:
  explicit Cubes(double size) : size_(size) {}
  void add(const glm::dvec3& p) { keys_.insert(key(cube(p))); }
  bool nearAny(const glm::dvec3& p) const {
    const glm::ivec3 c = cube(p);
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z)
          if (keys_.contains(key(c + glm::ivec3(x, y, z)))) return true;
    return false;
  }

 private:
  glm::ivec3 cube(const glm::dvec3& p) const { return glm::ivec3(glm::floor(p / size_)); }
  static std::uint64_t key(glm::ivec3 c) {
    const auto part = [](int v) { return static_cast<std::uint64_t>(v + (1 << 20)) & 0x1FFFFFu; };
    return part(c.x) << 42 | part(c.y) << 21 | part(c.z);
  }
  double size_;
  std::unordered_set<std::uint64_t> keys_;
};

bool comesNear(const Molecule& molecule, const Placement& copy, const Cubes& cubes, double radius) {
  std::vector<glm::dvec3> close;
  for (const glm::dvec3& p : molecule.positions) {
    const glm::dvec3 moved(copy.transform * glm::dvec4(p, 1.0));
    if (cubes.nearAny(moved)) close.push_back(moved);
  }
  for (const glm::dvec3& p : close)
    for (const glm::dvec3& q : molecule.positions)
      if (glm::dot(p - q, p - q) <= radius * radius) return true;
  return false;
}

}  // namespace

std::vector<Placement> placeSymmetry(const Molecule& molecule, glm::ivec3 low, glm::ivec3 high) {
  const Crystal crystal = crystalOf(molecule);
  if (high.x < low.x || high.y < low.y || high.z < low.z)
    throw InputError("the last cell lies before the first one");
  const glm::dvec3 cells = glm::dvec3(high) - glm::dvec3(low) + 1.0;
  if (cells.x * cells.y * cells.z * static_cast<double>(crystal.operations.size()) > kMaxCopies)
    throw InputError("these are more than a million copies; ask for fewer cells");
  const std::vector<IndexRange> residues{{0, static_cast<std::uint32_t>(molecule.residues.size())}};
  std::vector<Placement> placements;
  for (int z = low.z; z <= high.z; ++z)
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x)
        for (const glm::dmat4& operation : crystal.operations)
          placements.push_back(placed(crystal, operation, {x, y, z}, residues));
  return placements;
}

std::vector<Placement> placeSymmetryMates(const Molecule& molecule, double radius) {
  const Crystal crystal = crystalOf(molecule);
  const glm::dvec3 middle = middleOf(molecule);
  double reach = 0;
  Cubes cubes(std::max(radius, 1.0));
  for (const glm::dvec3& p : molecule.positions) {
    reach = std::max(reach, glm::length(p - middle));
    cubes.add(p);
  }
  // Middles of touching copies are this far apart at most; a cell's height is the inverse of its row's
  // length.
  glm::ivec3 cells(0);
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec3 row(crystal.toFractional[0][axis], crystal.toFractional[1][axis],
                         crystal.toFractional[2][axis]);
    const double count = std::ceil((2 * reach + radius) * glm::length(row));
    if (count > 100) throw InputError("the radius spans more than a hundred unit cells; ask for less");
    cells[axis] = static_cast<int>(count);
  }
  std::vector<Placement> near;
  for (const Placement& copy : placeSymmetry(molecule, -cells, cells)) {
    const glm::dvec3 moved(copy.transform * glm::dvec4(middle, 1.0));
    if (glm::length(moved - middle) > 2 * reach + radius) continue;
    if (copy.transform == glm::dmat4(1.0) || comesNear(molecule, copy, cubes, radius)) near.push_back(copy);
  }
  return near;
}

}  // namespace meniscus

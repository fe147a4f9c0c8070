#include "app/scene/mvs_placement.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "core/error.h"
#include "io/symmetry.h"

namespace meniscus {
namespace {

// Files give matrices with few digits.
constexpr double kRigid = 1e-3;

void requireRigid(const glm::dmat3& m, const JsonPlace& place) {
  const glm::dmat3 product = glm::transpose(m) * m;
  double off = std::abs(glm::determinant(m) - 1);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) off = std::max(off, std::abs(product[i][j] - (i == j ? 1.0 : 0.0)));
  if (!(off <= kRigid))
    place.fail("is no rotation (its columns must be perpendicular, of unit length, right-handed)");
}

glm::dvec3 centroid(const Molecule& molecule, const std::vector<Placement>& placements) {
  glm::dvec3 sum(0.0);
  double count = 0;
  for (const Placement& placement : placements)
    for (const IndexRange& range : placement.residues)
      for (std::uint32_t r = range.first; r < range.end(); ++r)
        for (std::uint32_t a = molecule.residues[r].atoms.first; a < molecule.residues[r].atoms.end(); ++a) {
          sum += glm::dvec3(placement.transform * glm::dvec4(molecule.positions[a], 1.0));
          ++count;
        }
  return count > 0 ? sum / count : sum;
}

glm::dmat4 matrixOf(const MvsNode& node, const Molecule& molecule, const std::vector<Placement>& placements,
                    std::vector<std::string>& unsupported) {
  node.listOtherParameters({"rotation", "translation", "rotation_center", "matrix"}, unsupported);
  glm::dmat4 matrix(1.0);
  if (const auto given = node.find("matrix")) {
    const std::vector<double> m = given->numbers(16);
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row) matrix[column][row] = m[static_cast<std::size_t>(4 * column + row)];
    requireRigid(glm::dmat3(matrix), *given);
    if (matrix[0][3] != 0 || matrix[1][3] != 0 || matrix[2][3] != 0 || matrix[3][3] != 1)
      given->fail("its last row must be 0 0 0 1");
    return matrix;
  }
  glm::dmat3 rotation(1.0);
  if (const auto given = node.find("rotation")) {
    const std::vector<double> m = given->numbers(9);
    for (int column = 0; column < 3; ++column)
      for (int row = 0; row < 3; ++row) rotation[column][row] = m[static_cast<std::size_t>(3 * column + row)];
    requireRigid(rotation, *given);
  }
  glm::dvec3 shift(0.0), center(0.0);
  if (const auto given = node.find("translation")) shift = given->vector();
  if (const auto given = node.find("rotation_center")) {
    if (!given->json().is_string()) {
      center = given->vector();
    } else if (given->string() == "centroid") {
      center = centroid(molecule, placements);
    } else {
      given->fail(fmt::format("'{}' is neither a point nor centroid", given->string()));
    }
  }
  matrix = glm::dmat4(rotation);
  matrix[3] = glm::dvec4(center - rotation * center + shift, 1.0);
  return matrix;
}

glm::ivec3 cellOf(const MvsNode& node, const char* parameter, int otherwise) {
  const auto given = node.find(parameter);
  if (!given) return glm::ivec3(otherwise);
  const std::vector<JsonPlace> items = given->items();
  if (items.size() != 3) given->fail("needs three whole numbers");
  const glm::ivec3 cell(items[0].integer(), items[1].integer(), items[2].integer());
  for (int i = 0; i < 3; ++i)
    if (cell[i] < -1000 || cell[i] > 1000) items[static_cast<std::size_t>(i)].fail("is beyond 1000 cells");
  return cell;
}

}  // namespace

std::vector<Placement> placementsOf(const MvsNode& structure, const Molecule& molecule) {
  const JsonPlace type = structure.at("type");
  try {
    if (type.string() == "model") return placeOnce(molecule);
    if (type.string() == "assembly") {
      const auto id = structure.find("assembly_id");
      if (id) return placeAssembly(molecule, id->string());
      if (molecule.assemblies.empty()) return placeOnce(molecule);  // then the model is the assembly
      return placeAssembly(molecule, molecule.assemblies.front().id);
    }
    if (type.string() == "symmetry")
      return placeSymmetry(molecule, cellOf(structure, "ijk_min", -1), cellOf(structure, "ijk_max", 1));
    if (type.string() == "symmetry_mates") {
      const auto radius = structure.find("radius");
      const double reach = radius ? radius->number() : 5;
      if (!(reach >= 0 && reach <= 1000)) radius->fail("must be from 0 to 1000");
      return placeSymmetryMates(molecule, reach);
    }
  } catch (const UsageError& error) {
    structure.place().fail(error.what());
  } catch (const InputError& error) {
    if (std::string_view(error.what()).starts_with(structure.place().path())) throw;
    structure.place().fail(error.what());
  }
  type.fail(fmt::format(
      "'{}' is no type of structure; there are model, assembly, symmetry and symmetry_mates", type.string()));
}

void movePlacements(const MvsNode& node, const Molecule& molecule, std::vector<Placement>& placements,
                    std::vector<std::string>& unsupported) {
  std::vector<glm::dmat4> instances;
  for (const MvsNode& child : node.children()) {
    if (child.kind() != "transform") continue;
    const glm::dmat4 matrix = matrixOf(child, molecule, placements, unsupported);
    for (Placement& placement : placements) placement.transform = matrix * placement.transform;
  }
  for (const MvsNode& child : node.children())
    if (child.kind() == "instance") instances.push_back(matrixOf(child, molecule, placements, unsupported));
  if (instances.empty()) return;
  std::vector<Placement> repeated;
  for (const glm::dmat4& matrix : instances)
    for (const Placement& placement : placements)
      repeated.push_back({matrix * placement.transform, placement.residues});
  placements = std::move(repeated);
}

}  // namespace meniscus

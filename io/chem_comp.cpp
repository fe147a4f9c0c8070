#include "io/chem_comp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <utility>

#include "core/elements.h"
#include "core/error.h"
#include "io/cif_values.h"
#include "io/guess_element.h"
#include "io/mmcif_categories.h"

namespace meniscus {
namespace {

using gemmi::cif::Block;
using gemmi::cif::Table;

std::optional<std::vector<glm::dvec3>> positionsFrom(Block& block, const std::array<const char*, 3>& tags) {
  Table table = block.find("_chem_comp_atom.", {tags[0], tags[1], tags[2]});
  if (!table.ok() || table.length() == 0) return std::nullopt;
  std::vector<glm::dvec3> positions;
  for (const Table::Row row : table) {
    const glm::dvec3 p(cifNumber(row[0], NAN), cifNumber(row[1], NAN), cifNumber(row[2], NAN));
    if (std::isnan(p.x + p.y + p.z)) return std::nullopt;
    positions.push_back(p);
  }
  return positions;
}

std::vector<glm::dvec3> findPositions(Block& block, Oddities& oddities) {
  static constexpr std::array<const char*, 3> kIdeal{"pdbx_model_Cartn_x_ideal", "pdbx_model_Cartn_y_ideal",
                                                     "pdbx_model_Cartn_z_ideal"};
  static constexpr std::array<const char*, 3> kExample{"model_Cartn_x", "model_Cartn_y", "model_Cartn_z"};
  static constexpr std::array<const char*, 3> kPlain{"x", "y", "z"};
  if (auto positions = positionsFrom(block, kIdeal)) return *positions;
  if (auto positions = positionsFrom(block, kExample)) {
    oddities.add("component without a full set of ideal positions: the example's are used", 0);
    return *positions;
  }
  if (auto positions = positionsFrom(block, kPlain)) return *positions;
  throw InputError("is a component definition without a full set of coordinates: nothing to draw");
}

void addBonds(Block& block, Molecule& molecule) {
  std::unordered_map<std::string_view, std::uint32_t> atomOf;
  for (std::uint32_t i = 0; i < molecule.atomCount(); ++i) atomOf.emplace(molecule.names[i].view(), i);
  for (const Table::Row row : block.find("_chem_comp_bond.", {"atom_id_1", "atom_id_2", "?value_order",
                                                              "?type", "?pdbx_aromatic_flag", "?aromatic"})) {
    const auto a = atomOf.find(AtomName(cifText(row[0])).view());
    const auto b = atomOf.find(AtomName(cifText(row[1])).view());
    if (a == atomOf.end() || b == atomOf.end() || a == b) continue;
    const auto text = [&row](std::size_t i) { return row.has(i) ? cifText(row[i]) : std::string_view(); };
    const auto isYes = [](std::string_view flag) { return flag == "Y" || flag == "y"; };
    const std::uint8_t order =
        isYes(text(4)) || isYes(text(5)) ? 4 : bondOrder(text(2).empty() ? text(3) : text(2));
    molecule.bonds.push_back(
        {std::min(a->second, b->second), std::max(a->second, b->second), order, BondOrigin::connection});
  }
}

}  // namespace

ReadModels readChemComp(Block& block, const ModelChoice& choice, Oddities& oddities) {
  Table table = block.find("_chem_comp_atom.", {"atom_id", "?type_symbol", "?charge", "?comp_id"});
  const std::vector<glm::dvec3> positions = findPositions(block, oddities);
  std::string id(block.name.substr(block.name.rfind("comp_", 0) == 0 ? 5 : 0));
  MoleculeBuilder builder(oddities);
  for (std::size_t i = 0; i < std::min(table.length(), positions.size()); ++i) {
    const Table::Row row = table[static_cast<int>(i)];
    if (row.has(3) && !cifText(row[3]).empty()) id = cifText(row[3]);
    AtomRecord atom;
    atom.residueName = id;
    atom.residueNumber = 1;
    atom.hetero = true;
    atom.name = cifText(row[0]);
    atom.position = positions[i];
    atom.element = row.has(1) ? elementFromSymbol(cifText(row[1])) : guessElement(atom.name, id);
    if (row.has(2)) {
      const double charge = cifNumber(row[2], 0.0);
      if (std::abs(charge) < 100) atom.charge = static_cast<std::int8_t>(std::lround(charge));
    }
    atom.serial = static_cast<std::int32_t>(i + 1);
    builder.add(atom);
  }
  ReadModels read;
  read.modelCount = 1;
  std::vector<int> numbers{1};
  chooseModels(numbers, choice, oddities);
  Molecule molecule = builder.finish();
  molecule.name = id;
  addBonds(block, molecule);
  read.models.push_back(std::move(molecule));
  return read;
}

}  // namespace meniscus

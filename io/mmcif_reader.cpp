// mmCIF: the syntax is gemmi's; _atom_site is read from gemmi's table rather than through gemmi::Structure,
// which wants columns that many programs leave out, refuses what can be mended, and looks residues up one by
// one (44,000 waters: seconds).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <gemmi/cif.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/elements.h"
#include "core/error.h"
#include "io/chem_comp.h"
#include "io/cif_values.h"
#include "io/format_readers.h"
#include "io/guess_element.h"
#include "io/mmcif_categories.h"
#include "io/pdb_text.h"
#include "io/secondary_records.h"

namespace meniscus {
namespace {

using gemmi::cif::Block;
using gemmi::cif::Table;

gemmi::cif::Document parse(const std::string& text) {
  gemmi::cif::Document document;
  tao::pegtl::memory_input<> input(text.data(), text.size(), "");
  try {
    gemmi::cif::parse_input(document, input);
  } catch (const tao::pegtl::parse_error& error) {
    const std::size_t line = error.positions().empty() ? 0 : error.positions().front().line;
    throw InputError(fmt::format("line {}: no valid mmCIF here ({}): is the file truncated? Fetch it again",
                                 line, error.message()));
  }
  return document;
}

enum Item : std::size_t {
  kX,
  kY,
  kZ,
  kId,
  kGroup,
  kSymbol,
  kLabelAtom,
  kAuthAtom,
  kAltloc,
  kLabelComp,
  kAuthComp,
  kLabelAsym,
  kAuthAsym,
  kLabelSeq,
  kAuthSeq,
  kInsertion,
  kOccupancy,
  kB,
  kCharge,
  kModel,
  kLabelEntity,
  kItemCount
};

Table findAtomSite(Block& block) {
  return block.find("_atom_site.", {"Cartn_x",
                                    "Cartn_y",
                                    "Cartn_z",
                                    "?id",
                                    "?group_PDB",
                                    "?type_symbol",
                                    "?label_atom_id",
                                    "?auth_atom_id",
                                    "?label_alt_id",
                                    "?label_comp_id",
                                    "?auth_comp_id",
                                    "?label_asym_id",
                                    "?auth_asym_id",
                                    "?label_seq_id",
                                    "?auth_seq_id",
                                    "?pdbx_PDB_ins_code",
                                    "?occupancy",
                                    "?B_iso_or_equiv",
                                    "?pdbx_formal_charge",
                                    "?pdbx_PDB_model_num",
                                    "?label_entity_id"});
}

/// Direct access to the columns of _atom_site, in a loop or as single values.
class AtomSite {
 public:
  AtomSite(const std::string& text, Table& table) : text_(text) {
    rows_ = table.length();
    if (gemmi::cif::Loop* loop = table.get_loop()) {
      loopLine_ = table.loop_item->line_number;
      tags_ = loop->width();
      stride_ = loop->width();
      for (std::size_t i = 0; i < kItemCount; ++i) {
        const int position = table.positions[i];
        if (position >= 0) first_[i] = &loop->values[static_cast<std::size_t>(position)];
      }
    } else if (rows_ == 1) {
      Table::Row row = table[0];
      for (std::size_t i = 0; i < kItemCount; ++i) {
        if (row.has(i)) first_[i] = &row[i];
      }
    }
  }

  std::size_t rows() const { return rows_; }
  bool has(Item item) const { return first_[item] != nullptr; }
  const std::string& raw(Item item, std::size_t row) const { return first_[item][row * stride_]; }
  std::string_view text(Item item, std::size_t row) const {
    return has(item) ? cifText(raw(item, row)) : std::string_view();
  }
  double number(Item item, std::size_t row, double absent) const {
    return has(item) ? cifNumber(raw(item, row), absent) : absent;
  }

  /// Where a row stands: its line if rows and lines agree, as they usually do.
  std::string placeOf(std::size_t row) const {
    const std::size_t guess = static_cast<std::size_t>(std::max(loopLine_, 1)) + tags_ + 1 + row;
    std::string place = fmt::format("_atom_site row {}", row + 1);
    forEachLine(text_, 1, [&](std::string_view line, std::size_t number) {
      if (number == guess && line.find(raw(kX, row)) != std::string_view::npos)
        place = fmt::format("line {}", number);
    });
    return place;
  }

 private:
  const std::string& text_;
  std::array<const std::string*, kItemCount> first_{};
  std::size_t stride_ = 0;
  std::size_t rows_ = 0;
  std::size_t tags_ = 0;
  int loopLine_ = 0;
};

/// _atom_site_anisotrop by atom id; usually in the order of the atoms.
class AnisotropyTable {
 public:
  explicit AnisotropyTable(Block& block)
      : table_(block.find("_atom_site_anisotrop.",
                          {"id", "U[1][1]", "U[2][2]", "U[3][3]", "U[1][2]", "U[1][3]", "U[2][3]"})) {
    if (!table_.ok()) return;
    for (std::size_t i = 0; i < table_.length(); ++i) {
      rowOf_.emplace(cifText(table_[static_cast<int>(i)][0]), static_cast<int>(i));
    }
  }

  Anisotropy of(std::string_view id) {
    const auto found = rowOf_.empty() ? rowOf_.end() : rowOf_.find(id);
    if (found == rowOf_.end()) return {};
    const Table::Row row = table_[found->second];
    std::array<float, 6> u{};
    for (std::size_t i = 0; i < 6; ++i) {
      u[i] = static_cast<float>(cifNumber(row[i + 1], 0.0));
      if (!std::isfinite(u[i])) return {};
    }
    return {u[0], u[1], u[2], u[3], u[4], u[5]};
  }

 private:
  Table table_;
  std::unordered_map<std::string_view, int> rowOf_;
};

/// Numbers of the models in order of appearance, and the index of each row's model.
struct ModelColumn {
  std::vector<int> numbers;
  std::vector<std::uint32_t> ofRow;
};

ModelColumn readModelColumn(const AtomSite& site) {
  ModelColumn column;
  if (!site.has(kModel)) {
    column.numbers = {1};
    column.ofRow.assign(site.rows(), 0);
    return column;
  }
  std::map<int, std::uint32_t> indexOf;
  column.ofRow.reserve(site.rows());
  for (std::size_t row = 0; row < site.rows(); ++row) {
    if (row > 0 && site.raw(kModel, row) == site.raw(kModel, row - 1)) {
      column.ofRow.push_back(column.ofRow.back());
      continue;
    }
    const auto integer = cifInteger(site.text(kModel, row));
    const int number = integer ? integer->value : 1;
    const auto [found, isNew] =
        indexOf.try_emplace(number, static_cast<std::uint32_t>(column.numbers.size()));
    if (isNew) column.numbers.push_back(number);
    column.ofRow.push_back(found->second);
  }
  return column;
}

std::uint8_t elementOf(const AtomSite& site, std::size_t row, const AtomRecord& atom, Oddities& oddities) {
  std::string_view symbol = site.text(kSymbol, row);
  while (!symbol.empty() && !((symbol.back() | 0x20) >= 'a' && (symbol.back() | 0x20) <= 'z'))
    symbol.remove_suffix(1);
  const std::uint8_t element = elementFromSymbol(symbol);
  if (element != 0 || symbol == "X") {
    if (element == 0) oddities.add("atom of unknown element", 0);
    return element;
  }
  oddities.add(symbol.empty() ? "no element: guessed from the atom's name"
                              : "unknown element: guessed from the atom's name",
               0);
  return guessElement(atom.name, atom.residueName);
}

/// Which of the paired columns is used; the other fills its gaps.
struct Naming {
  Item asym, otherAsym, seq, otherSeq, comp, otherComp, atom, otherAtom;
};

Naming chooseNaming(const AtomSite& site, Oddities& oddities) {
  Naming naming{kAuthAsym, kLabelAsym, kAuthSeq, kLabelSeq, kAuthComp, kLabelComp, kAuthAtom, kLabelAtom};
  if (!site.has(kAuthAsym)) oddities.add("no auth_asym_id: label_asym_id names the chains", 0);
  if (!site.has(kAuthSeq)) oddities.add("no auth_seq_id: label_seq_id numbers the residues", 0);
  if (!site.has(kLabelAsym)) oddities.add("no label_asym_id: auth_asym_id is used for assemblies", 0);
  return naming;
}

std::string_view either(const AtomSite& site, Item chosen, Item other, std::size_t row) {
  const std::string_view text = site.text(chosen, row);
  return text.empty() ? site.text(other, row) : text;
}

AtomRecord readRow(const AtomSite& site, std::size_t row, const Naming& naming, Oddities& oddities) {
  AtomRecord atom;
  atom.chain = either(site, naming.asym, naming.otherAsym, row);
  atom.subchain = either(site, kLabelAsym, kAuthAsym, row);
  atom.entity = site.text(kLabelEntity, row);
  if (const auto number = cifInteger(site.text(kLabelSeq, row))) atom.labelNumber = number->value;
  atom.residueName = either(site, naming.comp, naming.otherComp, row);
  atom.name = either(site, naming.atom, naming.otherAtom, row);
  if (const auto code = site.text(kInsertion, row); !code.empty()) atom.insertionCode = code[0];
  if (const auto number = cifInteger(either(site, naming.seq, naming.otherSeq, row))) {
    atom.residueNumber = number->value;
    if (!number->rest.empty() && atom.insertionCode == ' ') atom.insertionCode = number->rest[0];
  }
  const std::string_view group = site.text(kGroup, row);
  atom.hetero = !group.empty() && (group[0] | 0x20) == 'h';
  const auto altloc = site.text(kAltloc, row);
  if (!altloc.empty()) atom.altloc = altloc[0];
  if (altloc.size() > 1) oddities.add("alternate location of several letters: the first one is kept", 0);
  atom.position = {site.number(kX, row, NAN), site.number(kY, row, NAN), site.number(kZ, row, NAN)};
  if (std::isnan(atom.position.x + atom.position.y + atom.position.z)) {
    throw InputError(fmt::format("{}: the coordinates {} {} {} are not numbers: correct or remove the atom",
                                 site.placeOf(row), site.raw(kX, row), site.raw(kY, row), site.raw(kZ, row)));
  }
  atom.occupancy = static_cast<float>(site.number(kOccupancy, row, 1.0));
  atom.bFactor = static_cast<float>(site.number(kB, row, 0.0));
  if (const auto charge = cifInteger(site.text(kCharge, row)); charge && std::abs(charge->value) < 100) {
    const bool minus = charge->rest == "-" && charge->value > 0;
    atom.charge = static_cast<std::int8_t>(minus ? -charge->value : charge->value);
  }
  if (const auto serial = cifInteger(site.text(kId, row))) atom.serial = serial->value;
  atom.element = elementOf(site, row, atom, oddities);
  return atom;
}

std::string entryName(Block& block) {
  for (const std::string& id : block.find_values("_entry.id")) {
    if (!cifText(id).empty()) return std::string(cifText(id));
  }
  return block.name == "#" ? std::string() : block.name;
}

ReadModels readAtomSite(const std::string& text, Block& block, const ModelChoice& choice,
                        Oddities& oddities) {
  Table table = findAtomSite(block);
  const AtomSite site(text, table);
  ModelColumn column = readModelColumn(site);
  const Naming naming = chooseNaming(site, oddities);
  AnisotropyTable anisotropies(block);
  ReadModels read;
  read.modelCount = static_cast<int>(column.numbers.size());
  const bool labelIds = !site.has(kAuthAsym);
  const std::vector<NamedBond> named = readConnections(block, labelIds);
  const std::vector<AssemblyRecord> assemblies = readAssemblies(block, oddities);
  const std::vector<SecondaryRange> secondary = readSecondary(block, labelIds);
  const std::vector<std::size_t> chosen = chooseModels(column.numbers, choice, oddities);
  std::vector<MoleculeBuilder> builders(chosen.size(), MoleculeBuilder(oddities));
  std::vector<int> builderOf(column.numbers.size(), -1);
  for (std::size_t i = 0; i < chosen.size(); ++i) builderOf[chosen[i]] = static_cast<int>(i);
  if (chosen.size() == column.numbers.size()) {
    for (MoleculeBuilder& builder : builders) builder.reserve(site.rows() / chosen.size());
  }
  for (std::size_t row = 0; row < site.rows(); ++row) {
    const int builder = builderOf[column.ofRow[row]];
    if (builder < 0) continue;
    AtomRecord atom = readRow(site, row, naming, oddities);
    atom.anisotropy = anisotropies.of(site.text(kId, row));
    builders[static_cast<std::size_t>(builder)].add(atom);
  }
  const bool predicted = saysPredicted(block);
  const std::string name = entryName(block), spaceGroup = readSpaceGroup(block);
  const std::optional<UnitCell> cell = readCell(block);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    Molecule molecule = builders[i].finish();
    molecule.name = name;
    molecule.model = column.numbers[chosen[i]];
    molecule.modelIndex = static_cast<std::int32_t>(chosen[i]);
    molecule.cell = cell;
    molecule.spaceGroup = spaceGroup;
    addNamedBonds(molecule, named, oddities);
    addAssemblies(molecule, assemblies, ChainNaming::subchain, oddities);
    addSecondary(molecule, secondary, oddities);
    if (predicted) markPredicted(molecule, oddities);
    read.models.push_back(std::move(molecule));
  }
  return read;
}

}  // namespace

ReadModels readMmcif(const std::string& text, const ModelChoice& choice, Oddities& oddities) {
  gemmi::cif::Document document = parse(text);
  Block* atoms = nullptr;
  for (Block& block : document.blocks) {
    if (findAtomSite(block).length() == 0) continue;
    if (atoms) {
      oddities.add("several data blocks with atoms: the first is read", 0);
      break;
    }
    atoms = &block;
  }
  if (atoms) return readAtomSite(text, *atoms, choice, oddities);
  for (Block& block : document.blocks) {
    if (block.has_tag("_chem_comp_atom.atom_id")) return readChemComp(block, choice, oddities);
  }
  for (Block& block : document.blocks) {
    if (block.has_tag("_atom_site_fract_x")) {
      throw InputError(
          "holds fractional coordinates of a small-molecule crystal: convert it to PDB or mmCIF");
    }
  }
  throw InputError("has no atoms (no _atom_site with Cartn_x, Cartn_y and Cartn_z): is it a structure?");
}

}  // namespace meniscus

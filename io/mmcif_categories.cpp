#include "io/mmcif_categories.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/text.h"
#include "io/cif_values.h"

namespace meniscus {
namespace {

using gemmi::cif::Table;

std::string_view valueOf(const Table::Row& row, std::size_t column) {
  return row.has(column) ? cifText(row[column]) : std::string_view();
}

bool startsWith(std::string_view text, std::string_view prefix) {
  return text.substr(0, prefix.size()) == prefix;
}

std::vector<std::string> splitList(std::string_view list) {
  std::vector<std::string> items;
  std::string item;
  for (const char c : list) {
    if (c == ',') {
      items.push_back(std::move(item));
      item.clear();
    } else if (c != ' ' && c != '\n' && c != '\r' && c != '\t') {
      item += c;
    }
  }
  items.push_back(std::move(item));
  return items;
}

std::map<std::string, glm::dmat4> readOperators(gemmi::cif::Block& block, Oddities& oddities) {
  std::map<std::string, glm::dmat4> operators;
  std::vector<std::string> tags{"id"};
  for (const char* row : {"1", "2", "3"}) {
    for (const char* column : {"1", "2", "3"})
      tags.push_back(std::string("matrix[") + row + "][" + column + "]");
    tags.push_back(std::string("vector[") + row + "]");
  }
  for (const Table::Row row : block.find("_pdbx_struct_oper_list.", tags)) {
    glm::dmat4 matrix(1.0);
    bool sound = true;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 4; ++c) {
        matrix[c][r] = cifNumber(row[static_cast<std::size_t>(1 + 4 * r + c)], std::nan(""));
        sound &= std::isfinite(matrix[c][r]);
      }
    }
    if (sound) {
      operators.emplace(cifText(row[0]), matrix);
    } else {
      oddities.add("an assembly operator is not made of numbers: left out", 0);
    }
  }
  return operators;
}

}  // namespace

std::uint8_t bondOrder(std::string_view word) {
  const std::string lower = lowerCase(word.substr(0, 4));
  if (lower == "doub") return 2;
  if (lower == "trip") return 3;
  return lower == "arom" || lower == "delo" ? 4 : 1;
}

std::vector<NamedBond> readConnections(gemmi::cif::Block& block, bool labelIds) {
  std::vector<NamedBond> bonds;
  enum { kType, kOrder, kSymmetry1, kSymmetry2, kFirst, kWidth = 9 };
  std::vector<std::string> tags{"conn_type_id", "?pdbx_value_order", "?ptnr1_symmetry", "?ptnr2_symmetry"};
  for (const std::string partner : {"ptnr1", "ptnr2"}) {
    for (const char* item : {"_auth_asym_id", "_label_asym_id", "_auth_seq_id", "_label_seq_id",
                             "_auth_comp_id", "_label_comp_id"}) {
      tags.push_back("?" + partner + item);
    }
    tags.push_back(partner + "_label_atom_id");
    tags.push_back("?pdbx_" + partner + "_PDB_ins_code");
    tags.push_back("?pdbx_" + partner + "_label_alt_id");
  }
  for (const Table::Row row : block.find("_struct_conn.", tags)) {
    const std::string type = lowerCase(valueOf(row, kType));
    if (!startsWith(type, "covale") && !startsWith(type, "disulf") && !startsWith(type, "metal")) continue;
    if (valueOf(row, kSymmetry1) != valueOf(row, kSymmetry2)) continue;
    NamedBond bond;
    bond.order = bondOrder(valueOf(row, kOrder));
    for (std::size_t i = 0; i < 2; ++i) {
      AtomAddress& address = i == 0 ? bond.a : bond.b;
      const std::size_t at = kFirst + kWidth * i;
      // The chosen id, or the other one where a file leaves it out.
      const auto either = [&](std::size_t auth) {
        const std::string_view chosen = valueOf(row, auth + (labelIds ? 1 : 0));
        return chosen.empty() ? valueOf(row, auth + (labelIds ? 0 : 1)) : chosen;
      };
      address.chain = either(at);
      const std::string_view number = either(at + 2);
      if (const auto integer = cifInteger(number)) {
        address.residueNumber = integer->value;
        if (!integer->rest.empty()) address.insertionCode = integer->rest[0];
      }
      address.residueName = either(at + 4);
      address.atom = valueOf(row, at + 6);
      if (const auto code = valueOf(row, at + 7); !code.empty()) address.insertionCode = code[0];
      if (const auto altloc = valueOf(row, at + 8); !altloc.empty()) address.altloc = altloc[0];
    }
    bonds.push_back(std::move(bond));
  }
  return bonds;
}

std::vector<AssemblyRecord> readAssemblies(gemmi::cif::Block& block, Oddities& oddities) {
  std::vector<AssemblyRecord> records;
  Table generators =
      block.find("_pdbx_struct_assembly_gen.", {"assembly_id", "oper_expression", "asym_id_list"});
  if (!generators.ok()) return records;
  const std::map<std::string, glm::dmat4> operators = readOperators(block, oddities);
  for (const Table::Row row : generators) {
    const std::string id(cifText(row[0]));
    auto record =
        std::find_if(records.begin(), records.end(), [&id](const AssemblyRecord& r) { return r.id == id; });
    if (record == records.end()) {
      records.push_back({id, {}});
      record = records.end() - 1;
    }
    auto operations = expandOperations(std::string(cifText(row[1])), operators);
    if (!operations) {
      oddities.add("an assembly's operator expression cannot be expanded: left out", 0);
      continue;
    }
    record->generators.push_back({splitList(cifText(row[2])), std::move(*operations)});
  }
  return records;
}

std::vector<SecondaryRange> readSecondary(gemmi::cif::Block& block, bool labelIds) {
  std::vector<SecondaryRange> ranges;
  const std::string chain = labelIds ? "_label_asym_id" : "_auth_asym_id";
  const std::string number = labelIds ? "_label_seq_id" : "_auth_seq_id";
  const auto read = [&](const char* category, const char* type) {
    for (const Table::Row row :
         block.find(category, {type, "beg" + chain, "beg" + number, "end" + chain, "end" + number,
                               "?pdbx_beg_PDB_ins_code", "?pdbx_end_PDB_ins_code"})) {
      const std::string kind = lowerCase(cifText(row[0]));
      const bool sheet = type[0] == 's' || startsWith(kind, "strn");
      if (!sheet && !startsWith(kind, "helx")) continue;
      const auto first = cifInteger(cifText(row[2])), last = cifInteger(cifText(row[4]));
      if (!first || !last) continue;
      SecondaryRange range;
      range.kind = sheet ? SecondaryStructure::strand : SecondaryStructure::helix;
      range.firstChain = cifText(row[1]);
      range.lastChain = cifText(row[3]);
      range.firstNumber = first->value;
      range.lastNumber = last->value;
      if (const auto code = valueOf(row, 5); !code.empty()) range.firstInsertion = code[0];
      if (const auto code = valueOf(row, 6); !code.empty()) range.lastInsertion = code[0];
      ranges.push_back(std::move(range));
    }
  };
  read("_struct_conf.", "conf_type_id");
  read("_struct_sheet_range.", "sheet_id");
  return ranges;
}

std::string readSpaceGroup(gemmi::cif::Block& block) {
  for (const char* tag : {"_symmetry.space_group_name_H-M", "_space_group.name_H-M_alt"}) {
    for (const std::string& name : block.find_values(tag)) {
      if (!cifText(name).empty()) return std::string(cifText(name));
    }
  }
  return {};
}

std::optional<UnitCell> readCell(gemmi::cif::Block& block) {
  for (const Table::Row row : block.find(
           "_cell.", {"length_a", "length_b", "length_c", "angle_alpha", "angle_beta", "angle_gamma"})) {
    const auto number = [&row](std::size_t i) { return cifNumber(row[i], std::nan("")); };
    const UnitCell cell{number(0), number(1), number(2), number(3), number(4), number(5)};
    const bool angles = cell.alpha > 0 && cell.beta > 0 && cell.gamma > 0;
    if (cell.a > 1 && cell.b > 1 && cell.c > 1 && angles)
      return cell;  // 1 x 1 x 1 Å stands for none; so does NaN
  }
  return std::nullopt;
}

bool saysPredicted(gemmi::cif::Block& block) {
  if (block.has_tag("_ma_qa_metric.id") || block.has_tag("_ma_qa_metric_local.metric_value")) return true;
  for (const std::string& method : block.find_values("_exptl.method")) {
    const std::string_view text = cifText(method);
    if (!text.empty() && lowerCase(text) != "theoretical model") return false;
  }
  for (const std::string& id : block.find_values("_entry.id")) {
    if (startsWith(cifText(id), "AF-")) return true;
  }
  for (const std::string& raw : block.find_values("_software.name")) {
    const std::string name = lowerCase(cifText(raw));
    for (const std::string_view program : {"alphafold", "esmfold", "colabfold", "rosettafold", "omegafold"}) {
      if (name.find(program) != std::string::npos) return true;
    }
  }
  return false;
}

}  // namespace meniscus

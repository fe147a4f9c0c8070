#include "app/scene/selectors.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string_view>

#include "core/elements.h"

namespace meniscus {
namespace {

constexpr std::array<std::string_view, 9> kWords{"all",    "polymer", "protein", "nucleic", "branched",
                                                 "ligand", "ion",     "water",   "coarse"};

bool residueMatches(const Residue& residue, std::string_view word) {
  switch (residue.kind) {
    case ResidueKind::aminoAcid:
      return word == "polymer" || word == "protein";
    case ResidueKind::nucleotide:
      return word == "polymer" || word == "nucleic";
    case ResidueKind::water:
      return word == "water";
    case ResidueKind::ion:
      return word == "ion";
    case ResidueKind::ligand:
      return word == "ligand";
    case ResidueKind::saccharide:
      return word == "branched";
  }
  return false;
}

/// Inclusive bounds of a residue number.
struct NumberRange {
  int least = std::numeric_limits<int>::min(), most = std::numeric_limits<int>::max();
  bool given = false;
  bool holds(int number) const { return number >= least && number <= most; }
};

/// One expression: what is not given matches everything.
struct Expression {
  std::optional<std::string> entity, labelChain, authChain, labelName, authName, labelAtom, authAtom, element,
      insertion;
  NumberRange label, auth;
  std::optional<int> serial;
  bool possible = true;

  bool matchesResidue(const Molecule& m, const Residue& residue) const;
  bool matchesAtom(const Molecule& m, std::uint32_t atom) const;
};

bool Expression::matchesResidue(const Molecule& m, const Residue& residue) const {
  const std::string& chain = m.chains[residue.chain].name;
  const bool hasLabels = !residue.subchain.empty();
  const auto is = [](const std::optional<std::string>& wanted, const std::string& value) {
    return !wanted || *wanted == value;
  };
  if (!is(entity, residue.entity) || !is(labelChain, hasLabels ? residue.subchain : chain) ||
      !is(authChain, chain) || !is(labelName, residue.name) || !is(authName, residue.name))
    return false;
  if (insertion && (insertion->empty() ? ' ' : insertion->front()) != residue.insertionCode) return false;
  if (auth.given && !auth.holds(residue.number)) return false;
  if (!label.given) return true;
  if (!hasLabels) return label.holds(residue.number);
  return residue.labelNumber && label.holds(*residue.labelNumber);
}

bool Expression::matchesAtom(const Molecule& m, std::uint32_t atom) const {
  if (labelAtom && AtomName(*labelAtom) != m.names[atom]) return false;
  if (authAtom && AtomName(*authAtom) != m.names[atom]) return false;
  if (element && elementFromSymbol(*element) != m.elements[atom]) return false;
  return !serial || *serial == m.serials[atom];
}

void narrow(NumberRange& range, int least, int most) {
  range.given = true;
  range.least = std::max(range.least, least);
  range.most = std::min(range.most, most);
}

Expression parseExpression(const JsonPlace& place, std::vector<std::string>& unsupported) {
  constexpr int kLeast = std::numeric_limits<int>::min(), kMost = std::numeric_limits<int>::max();
  Expression e;
  const auto text = [](std::optional<std::string>& target) {
    return [&target](const JsonPlace& value) { target = value.string(); };
  };
  const std::pair<std::string_view, std::function<void(const JsonPlace&)>> fields[] = {
      {"label_entity_id", text(e.entity)},
      {"label_asym_id", text(e.labelChain)},
      {"auth_asym_id", text(e.authChain)},
      {"label_comp_id", text(e.labelName)},
      {"auth_comp_id", text(e.authName)},
      {"label_atom_id", text(e.labelAtom)},
      {"auth_atom_id", text(e.authAtom)},
      {"type_symbol", text(e.element)},
      {"pdbx_PDB_ins_code", text(e.insertion)},
      {"label_seq_id", [&](const JsonPlace& v) { narrow(e.label, v.integer(), v.integer()); }},
      {"auth_seq_id", [&](const JsonPlace& v) { narrow(e.auth, v.integer(), v.integer()); }},
      {"beg_label_seq_id", [&](const JsonPlace& v) { narrow(e.label, v.integer(), kMost); }},
      {"end_label_seq_id", [&](const JsonPlace& v) { narrow(e.label, kLeast, v.integer()); }},
      {"beg_auth_seq_id", [&](const JsonPlace& v) { narrow(e.auth, v.integer(), kMost); }},
      {"end_auth_seq_id", [&](const JsonPlace& v) { narrow(e.auth, kLeast, v.integer()); }},
      {"atom_id", [&](const JsonPlace& v) { e.serial = v.integer(); }}};
  for (const std::string& key : place.keys()) {
    const JsonPlace value = place.at(key);
    const auto* field = std::find_if(std::begin(fields), std::end(fields),
                                     [&](const auto& entry) { return entry.first == key; });
    if (field != std::end(fields)) {
      field->second(value);
    } else if (key == "atom_index" || key == "residue_index" || key == "instance_id") {
      unsupported.push_back(
          fmt::format("{}: is not known here, so this chooses nothing; there is atom_id", value.path()));
      e.possible = false;
    } else {
      value.fail("there is no such field in a selector");
    }
  }
  return e;
}

void select(const Molecule& m, const Expression& e, std::vector<std::uint8_t>& chosen) {
  if (!e.possible) return;
  for (const Residue& residue : m.residues) {
    if (!e.matchesResidue(m, residue)) continue;
    for (std::uint32_t atom = residue.atoms.first; atom < residue.atoms.end(); ++atom)
      if (e.matchesAtom(m, atom)) chosen[atom] = 1;
  }
}

}  // namespace

std::vector<std::uint32_t> selectComponent(const Molecule& molecule, const JsonPlace& selector,
                                           std::vector<std::string>& unsupported) {
  std::vector<std::uint8_t> chosen(molecule.atomCount(), 0);
  if (selector.json().is_string()) {
    const std::string& word = selector.string();
    if (std::find(kWords.begin(), kWords.end(), word) == kWords.end())
      selector.fail(fmt::format("'{}' is no selector; there are {}", word, fmt::join(kWords, ", ")));
    if (word == "coarse")
      unsupported.push_back(fmt::format("{}: coarse-grained parts are not read", selector.path()));
    for (const Residue& residue : molecule.residues) {
      if (word != "all" && !residueMatches(residue, word)) continue;
      std::fill_n(chosen.begin() + residue.atoms.first, residue.atoms.count, std::uint8_t{1});
    }
  } else if (selector.json().is_array()) {
    for (const JsonPlace& item : selector.items())
      select(molecule, parseExpression(item, unsupported), chosen);
  } else if (selector.json().is_object()) {
    select(molecule, parseExpression(selector, unsupported), chosen);
  } else {
    selector.fail("is no selector: give a word, an expression or a list of expressions");
  }
  std::vector<std::uint32_t> atoms;
  for (std::uint32_t i = 0; i < chosen.size(); ++i)
    if (chosen[i]) atoms.push_back(i);
  return atoms;
}

}  // namespace meniscus

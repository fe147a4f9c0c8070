// Names are looked up in gemmi's table of the common residues of the PDB; what it lacks is added here.
#include "io/residue_kind.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <gemmi/resinfo.hpp>
#include <initializer_list>
#include <numeric>
#include <optional>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/elements.h"
#include "core/residue_templates.h"

namespace meniscus {
namespace {

bool isOneOf(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool isWater(std::string_view name) {
  return isOneOf(name, {"HOH", "DOD", "WAT", "H2O", "OH2", "SOL", "SPC", "SPCE", "TIP", "TP3", "T3P", "TIP3",
                        "TIP4", "TIP5", "T4P", "TP4"});
}

bool isSaccharide(std::string_view name) {
  return isOneOf(name, {"NAG", "NDG", "BMA", "MAN", "GAL", "GLA", "GLC", "BGC", "FUC", "FUL",
                        "FUB", "SIA", "XYS", "XYP", "A2G", "NGA", "GCU", "BDP", "IDR", "RAM",
                        "ARA", "AHR", "RIB", "FRU", "SUC", "TRE", "MAL", "LAT"});
}

std::optional<ResidueKind> kindByName(const std::string& name) {
  if (isWater(name)) return ResidueKind::water;
  if (const ResidueTemplate* known = findResidueTemplate(name)) return known->kind;
  if (isSaccharide(name)) return ResidueKind::saccharide;
  using Kind = gemmi::ResidueInfo;
  switch (gemmi::find_tabulated_residue(name).kind) {
    case Kind::AA:
    case Kind::AAD:
    case Kind::PAA:
    case Kind::MAA:
      return ResidueKind::aminoAcid;
    case Kind::RNA:
    case Kind::DNA:
      return ResidueKind::nucleotide;
    case Kind::HOH:
      return ResidueKind::water;
    case Kind::PYR:
    case Kind::KET:
      return ResidueKind::saccharide;
    default:
      return std::nullopt;  // ligands and ions: told apart by their atoms
  }
}

}  // namespace

ResidueKind residueKind(const std::string& name, std::span<const AtomName> atoms,
                        std::span<const std::uint8_t> elements) {
  const auto has = [atoms](std::string_view atom) {
    return std::find(atoms.begin(), atoms.end(), AtomName(atom)) != atoms.end();
  };
  if (const std::optional<ResidueKind> known = kindByName(name)) {
    // Small molecules are called UNK or C too.
    const bool amino = name != "UNK" || has("CA");
    const bool nucleo = has("P") || has("C1'") || has("C1*");
    if (*known == ResidueKind::aminoAcid ? amino : *known != ResidueKind::nucleotide || nucleo) return *known;
  }
  if (atoms.size() == 1) {
    const std::uint8_t e = elements[0];
    const bool halogen = e == 9 || e == 17 || e == 35 || e == 53;
    return isMetal(e) || halogen ? ResidueKind::ion : ResidueKind::ligand;
  }
  if (gemmi::find_tabulated_residue(name).found()) return ResidueKind::ligand;  // ADP looks like a nucleotide
  if (has("N") && has("CA") && has("C") && has("O")) return ResidueKind::aminoAcid;
  if (!has("P")) return ResidueKind::ligand;
  if ((has("C1'") && has("C3'") && has("O3'")) || (has("C1*") && has("C3*") && has("O3*")))
    return ResidueKind::nucleotide;
  return ResidueKind::ligand;
}

void demoteFreeMonomers(Molecule& molecule) {
  const auto isPolymer = [](const Residue& r) {
    return r.kind == ResidueKind::aminoAcid || r.kind == ResidueKind::nucleotide;
  };
  std::vector<std::uint8_t> bound(molecule.residues.size(), 0);
  bool any = false;
  for (std::size_t i = 0; i < bound.size(); ++i) {
    bound[i] = isPolymer(molecule.residues[i]) && !molecule.residues[i].hetero ? 1 : 0;
    any |= bound[i] != 0;
  }
  if (!any) return;  // everything is HETATM: the file makes no difference
  // Files may put such residues after the chain: neighbours are those by number.
  std::vector<std::uint32_t> order(bound.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&molecule](std::uint32_t a, std::uint32_t b) {
    const Residue& x = molecule.residues[a];
    const Residue& y = molecule.residues[b];
    return std::tie(x.chain, x.kind, x.number) < std::tie(y.chain, y.kind, y.number);
  });
  const auto passOn = [&](std::uint32_t a, std::uint32_t b) {
    const Residue& from = molecule.residues[a];
    const Residue& to = molecule.residues[b];
    const std::int64_t step = std::int64_t{from.number} - to.number;
    if (bound[a] && from.chain == to.chain && from.kind == to.kind && step >= -1 && step <= 1) bound[b] = 1;
  };
  for (std::size_t i = 1; i < order.size(); ++i) passOn(order[i - 1], order[i]);
  for (std::size_t i = order.size(); i-- > 1;) passOn(order[i], order[i - 1]);
  for (std::size_t i = 0; i < bound.size(); ++i) {
    if (!bound[i] && isPolymer(molecule.residues[i])) molecule.residues[i].kind = ResidueKind::ligand;
  }
}

}  // namespace meniscus

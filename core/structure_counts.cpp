#include "core/structure_counts.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <tuple>

namespace meniscus {
namespace {

/// A place in a chain.
using Place = std::tuple<std::uint32_t, std::int32_t, char>;

std::size_t countDistinct(std::vector<Place>& places) {
  std::sort(places.begin(), places.end());
  return static_cast<std::size_t>(std::unique(places.begin(), places.end()) - places.begin());
}

/// Modified residues within a polymer (MSE, PSU) are written as HETATM but are no ligands.
bool isLigand(const Residue& residue) {
  return residue.kind == ResidueKind::ligand || residue.kind == ResidueKind::ion ||
         residue.kind == ResidueKind::saccharide;
}

}  // namespace

StructureCounts countStructure(const Molecule& molecule) {
  StructureCounts counts;
  counts.atoms = molecule.atomCount();
  counts.chains = molecule.chains.size();
  std::vector<Place> places;
  places.reserve(molecule.residues.size());
  std::map<std::string, std::vector<Place>> ligands;
  for (const Residue& residue : molecule.residues) {
    const Place place{residue.chain, residue.number, residue.insertionCode};
    places.push_back(place);
    if (isLigand(residue)) ligands[residue.name].push_back(place);
  }
  counts.residues = countDistinct(places);
  for (auto& [name, where] : ligands) counts.ligands.push_back({name, countDistinct(where)});
  return counts;
}

}  // namespace meniscus

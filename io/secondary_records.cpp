#include "io/secondary_records.h"

#include <map>
#include <tuple>

namespace meniscus {

void addSecondary(Molecule& molecule, const std::vector<SecondaryRange>& ranges, Oddities& oddities) {
  if (ranges.empty()) return;
  molecule.hasSecondary = true;
  using Key = std::tuple<std::string, std::int32_t, char>;
  std::map<Key, IndexRange> places;  // residues at one place: of several names, by alternate location
  for (std::uint32_t r = 0; r < molecule.residues.size(); ++r) {
    const Residue& residue = molecule.residues[r];
    if (residue.kind != ResidueKind::aminoAcid) continue;
    const Key key{molecule.chains[residue.chain].name, residue.number, residue.insertionCode};
    IndexRange& range = places.try_emplace(key, IndexRange{r, 0}).first->second;
    range.count = r + 1 - range.first;
  }
  for (const SecondaryRange& range : ranges) {
    const auto first = places.find({range.firstChain, range.firstNumber, range.firstInsertion});
    const auto last = places.find({range.lastChain, range.lastNumber, range.lastInsertion});
    if (first == places.end() || last == places.end() || range.firstChain != range.lastChain ||
        last->second.end() <= first->second.first) {
      oddities.add("a helix or strand names residues that are not there: left out", 0);
      continue;
    }
    for (std::uint32_t r = first->second.first; r < last->second.end(); ++r) {
      Residue& residue = molecule.residues[r];
      if (residue.kind != ResidueKind::aminoAcid || residue.secondary == SecondaryStructure::helix) continue;
      residue.secondary = range.kind;
    }
  }
}

}  // namespace meniscus

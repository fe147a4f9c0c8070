#include "core/backbone.h"

#include <glm/geometric.hpp>
#include <initializer_list>
#include <string_view>

namespace meniscus {
namespace {

constexpr double kLongestBond = 2.5;                    // Å: C-N is 1.33, O3'-P 1.6
constexpr double kFarthestCa = 4.3, kFarthestC4 = 9.0;  // Å: usually 3.8 and 5.5 to 7

/// The atom of a residue with one of these names, at its first alternate location.
std::uint32_t atomOf(const Molecule& m, const Residue& residue,
                     std::initializer_list<std::string_view> names) {
  std::uint32_t found = kNoAtom;
  for (const std::string_view name : names) {
    const AtomName wanted(name);
    for (std::uint32_t i = residue.atoms.first; i < residue.atoms.end(); ++i) {
      if (m.names[i] != wanted) continue;
      if (found == kNoAtom || m.altlocs[i] < m.altlocs[found]) found = i;
    }
    if (found != kNoAtom) return found;
  }
  return found;
}

BackboneResidue backboneOf(const Molecule& m, std::uint32_t index) {
  const Residue& residue = m.residues[index];
  BackboneResidue b;
  b.residue = index;
  if (residue.kind == ResidueKind::aminoAcid) {
    b.trace = atomOf(m, residue, {"CA"});
    if (b.trace != kNoAtom && m.elements[b.trace] == 20) b.trace = kNoAtom;  // calcium
    b.n = atomOf(m, residue, {"N"});
    b.c = atomOf(m, residue, {"C"});
    b.o = atomOf(m, residue, {"O", "OXT", "O1", "OT1"});
  } else {
    b.trace = atomOf(m, residue, {"C4'", "C4*"});
    b.c1 = atomOf(m, residue, {"C1'", "C1*"});
    b.o3 = atomOf(m, residue, {"O3'", "O3*"});
    b.p = atomOf(m, residue, {"P"});
    // Purines pair by N1, pyrimidines by N3; only purines have N9.
    const bool purine = atomOf(m, residue, {"N9"}) != kNoAtom;
    b.base = purine ? atomOf(m, residue, {"N1"}) : atomOf(m, residue, {"N3"});
  }
  return b;
}

bool areBound(const Molecule& m, const BackboneResidue& a, const BackboneResidue& b, bool nucleic) {
  const auto within = [&](std::uint32_t x, std::uint32_t y, double most) {
    return glm::distance(m.positions[x], m.positions[y]) <= most;
  };
  const std::uint32_t from = nucleic ? a.o3 : a.c, to = nucleic ? b.p : b.n;
  if (from != kNoAtom && to != kNoAtom) return within(from, to, kLongestBond);
  return within(a.trace, b.trace, nucleic ? kFarthestC4 : kFarthestCa);
}

}  // namespace

std::vector<Backbone> findBackbones(const Molecule& molecule) {
  std::vector<Backbone> backbones;
  for (const Chain& chain : molecule.chains) {
    bool open = false;  // whether the last backbone may go on
    for (std::uint32_t r = chain.residues.first; r < chain.residues.end(); ++r) {
      const Residue& residue = molecule.residues[r];
      const bool nucleic = residue.kind == ResidueKind::nucleotide;
      if (!nucleic && residue.kind != ResidueKind::aminoAcid) continue;
      if (open && samePlace(residue, molecule.residues[backbones.back().residues.back().residue])) continue;
      const BackboneResidue b = backboneOf(molecule, r);
      if (b.trace == kNoAtom) {
        open = false;
        continue;
      }
      if (!open || backbones.back().nucleic != nucleic ||
          !areBound(molecule, backbones.back().residues.back(), b, nucleic))
        backbones.push_back({nucleic, {}});
      backbones.back().residues.push_back(b);
      open = true;
    }
  }
  return backbones;
}

}  // namespace meniscus

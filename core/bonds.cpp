// Distance rule: the upper bound is the customary one of Open Babel and Jmol, sum of Cordero's covalent radii
// + 0.45 Å. Metals (ours): donors N, O, F, P, S, Cl, As, Se, Br, I within sum + 0.45 Å, carbon within sum +
// 0.2 Å (haem CO, cobalamin, metallocenes; not to alkali and alkaline earth metals), another metal within
// 0.95 of the sum, which keeps metal-metal bonds and leaves the iron atoms of a 4Fe-4S cluster (2.7 Å apart,
// sum 2.64 Å) to their sulphurs.
#include "core/bonds.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <tuple>
#include <vector>

#include "core/cell_grid.h"
#include "core/elements.h"
#include "core/residue_templates.h"

namespace meniscus {
namespace {

constexpr double kTolerance = 0.45;            // Å
constexpr double kShortest = 0.4;              // Å
constexpr double kCarbonMetalTolerance = 0.2;  // Å
constexpr double kMetalMetalFactor = 0.95;
// Old refinements stretch side chains: CE-NZ of 4HHB's lysines reaches 2.7 Å. The bond is there all the same.
constexpr double kLongestTemplateBond = 3.0;    // Å
constexpr std::size_t kMaxTemplateAtoms = 512;  // a residue with more is no residue
constexpr std::size_t kMaxCellAtoms = 256;  // real structures stay below 70 in (3 Å)^3, alternates included
constexpr std::uint8_t kMaxDistanceBonds = 24;  // per atom
constexpr std::size_t kMaxHeterogeneity = 8;    // residues looked at for a link to the next number

enum AtomFlag : std::uint8_t { hydrogen = 1, metal = 2, water = 4, inTemplate = 8 };

bool altlocsMeet(char a, char b) {
  return a == b || a == ' ' || b == ' ';
}

bool isDonor(std::uint8_t element) {
  switch (element) {
    case 7:
    case 8:
    case 9:
    case 15:
    case 16:
    case 17:
    case 33:
    case 34:
    case 35:
    case 53:
      return true;
    default:
      return false;
  }
}

bool isAlkaline(std::uint8_t element) {
  switch (element) {
    case 3:
    case 4:
    case 11:
    case 12:
    case 19:
    case 20:
    case 37:
    case 38:
    case 55:
    case 56:
    case 87:
    case 88:
      return true;
    default:
      return false;
  }
}

/// Longest bond between two elements [Å]; 0 if they never bond.
double longestBond(std::uint8_t a, std::uint8_t b) {
  const double sum = static_cast<double>(covalentRadius(a)) + static_cast<double>(covalentRadius(b));
  const bool metalA = isMetal(a);
  const bool metalB = isMetal(b);
  if (metalA && metalB) return sum * kMetalMetalFactor;
  if (!metalA && !metalB) return a == 1 && b == 1 ? 0 : sum + kTolerance;
  const std::uint8_t ligand = metalA ? b : a;
  if (isDonor(ligand)) return sum + kTolerance;
  return ligand == 6 && !isAlkaline(metalA ? a : b) ? sum + kCarbonMetalTolerance : 0;
}

/// Finds the bonds of one molecule, one source of knowledge after the other.
class BondFinder {
 public:
  BondFinder(const Molecule& molecule, Logger& logger)
      : m_(molecule), logger_(logger), flags_(molecule.atomCount(), 0), degree_(molecule.atomCount(), 0) {
    for (std::size_t i = 0; i < m_.atomCount(); ++i) {
      if (m_.elements[i] == 1) flags_[i] |= hydrogen;
      if (isMetal(m_.elements[i])) flags_[i] |= metal;
      if (m_.residues[m_.residueOf[i]].kind == ResidueKind::water) flags_[i] |= water;
    }
  }

  std::vector<Bond> find() {
    for (const Residue& residue : m_.residues) addTemplateBonds(residue);
    for (const Chain& chain : m_.chains) addLinks(chain);
    addDistanceBonds();
    return std::move(found_);
  }

 private:
  double distance(std::uint32_t a, std::uint32_t b) const {
    return glm::distance(m_.positions[a], m_.positions[b]);
  }
  void addTemplateBonds(const Residue& residue);
  void addLinks(const Chain& chain);
  void linkAtoms(const Residue& from, std::string_view nameFrom, const Residue& to, std::string_view nameTo);
  void addDistanceBonds();
  void addMetalBonds(const CellGrid& grid);
  void tryDistance(std::uint32_t a, std::uint32_t b);
  double cellSize() const;

  const Molecule& m_;
  Logger& logger_;
  std::vector<std::uint8_t> flags_;
  std::vector<std::uint8_t> degree_;  ///< distance bonds so far
  bool saturated_ = false;
  std::vector<std::uint32_t> metals_;
  std::array<bool, kElementCount> present_{};
  std::array<std::array<float, kElementCount>, kElementCount> longest_{};  ///< filled for present elements
  std::vector<Bond> found_;
};

void BondFinder::addTemplateBonds(const Residue& residue) {
  const ResidueTemplate* known = findResidueTemplate(residue.name);
  if (!known || known->kind != residue.kind || residue.atoms.count > kMaxTemplateAtoms) return;
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::array<std::uint32_t, 256> firstOf;
  std::fill_n(firstOf.begin(), known->names.size(), kNone);
  std::array<std::uint32_t, kMaxTemplateAtoms> nextOf;  // alternates of the same name, linked
  for (std::uint32_t i = residue.atoms.end(); i-- > residue.atoms.first;) {
    const int name = known->indexOf(m_.names[i]);
    if (name < 0) continue;
    flags_[i] |= inTemplate;
    nextOf[i - residue.atoms.first] = firstOf[static_cast<std::size_t>(name)];
    firstOf[static_cast<std::size_t>(name)] = i;
  }
  for (const TemplateBond& bond : known->bonds) {
    for (std::uint32_t a = firstOf[bond.a]; a != kNone; a = nextOf[a - residue.atoms.first]) {
      for (std::uint32_t b = firstOf[bond.b]; b != kNone; b = nextOf[b - residue.atoms.first]) {
        if (!altlocsMeet(m_.altlocs[a], m_.altlocs[b])) continue;
        const double d = distance(a, b);
        if (d < kShortest || d > kLongestTemplateBond) continue;
        found_.push_back({std::min(a, b), std::max(a, b), bond.order, BondOrigin::residueTemplate});
      }
    }
  }
}

/// Peptide and phosphodiester links from each residue to those of the next number.
void BondFinder::addLinks(const Chain& chain) {
  for (std::uint32_t i = chain.residues.first; i < chain.residues.end(); ++i) {
    const Residue& from = m_.residues[i];
    if (from.kind != ResidueKind::aminoAcid && from.kind != ResidueKind::nucleotide) continue;
    const std::uint32_t last = std::min<std::uint32_t>(chain.residues.end(), i + 1 + kMaxHeterogeneity);
    std::uint32_t next = i + 1;
    while (next < last && samePlace(m_.residues[next], from)) ++next;
    for (std::uint32_t j = next; j < last && samePlace(m_.residues[j], m_.residues[next]); ++j) {
      const Residue& to = m_.residues[j];
      if (to.kind != from.kind) continue;
      if (from.kind == ResidueKind::aminoAcid) {
        linkAtoms(from, "C", to, "N");
      } else {
        linkAtoms(from, "O3'", to, "P");
        linkAtoms(from, "O3*", to, "P");
      }
    }
  }
}

void BondFinder::linkAtoms(const Residue& from, std::string_view nameFrom, const Residue& to,
                           std::string_view nameTo) {
  if (from.atoms.count > kMaxTemplateAtoms || to.atoms.count > kMaxTemplateAtoms) return;
  const AtomName wantedFrom(nameFrom);
  const AtomName wantedTo(nameTo);
  for (std::uint32_t a = from.atoms.first; a < from.atoms.end(); ++a) {
    if (m_.names[a] != wantedFrom) continue;
    for (std::uint32_t b = to.atoms.first; b < to.atoms.end(); ++b) {
      if (m_.names[b] != wantedTo || !altlocsMeet(m_.altlocs[a], m_.altlocs[b])) continue;
      const double d = distance(a, b);
      if (d < kShortest || d > longestBond(m_.elements[a], m_.elements[b])) continue;
      found_.push_back({std::min(a, b), std::max(a, b), 1, BondOrigin::residueTemplate});
    }
  }
}

/// Edge of the grid's cells: the longest bond between the non-metals that are present.
double BondFinder::cellSize() const {
  double radius = 0.5;
  for (std::size_t e = 0; e < present_.size(); ++e) {
    const auto element = static_cast<std::uint8_t>(e);
    if (present_[e] && !isMetal(element))
      radius = std::max(radius, static_cast<double>(covalentRadius(element)));
  }
  return 2 * radius + kTolerance;
}

void BondFinder::addDistanceBonds() {
  for (std::uint32_t i = 0; i < m_.atomCount(); ++i) {
    present_[m_.elements[i]] = true;
    if (flags_[i] & metal) metals_.push_back(i);
  }
  for (std::size_t a = 0; a < present_.size(); ++a) {
    for (std::size_t b = 0; present_[a] && b < present_.size(); ++b) {
      if (present_[b]) {
        longest_[a][b] =
            static_cast<float>(longestBond(static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b)));
      }
    }
  }
  const CellGrid grid(m_.positions, cellSize());
  static constexpr std::array<std::array<int, 3>, 13> kForward{{{1, 0, 0},
                                                                {-1, 1, 0},
                                                                {0, 1, 0},
                                                                {1, 1, 0},
                                                                {-1, -1, 1},
                                                                {0, -1, 1},
                                                                {1, -1, 1},
                                                                {-1, 0, 1},
                                                                {0, 0, 1},
                                                                {1, 0, 1},
                                                                {-1, 1, 1},
                                                                {0, 1, 1},
                                                                {1, 1, 1}}};
  std::size_t crowded = 0;
  for (std::size_t cell = 0; cell < grid.cellCount(); ++cell) {
    const auto atoms = grid.pointsOf(cell);
    if (atoms.size() > kMaxCellAtoms) {
      crowded += atoms.size();
      continue;
    }
    for (std::size_t i = 0; i < atoms.size(); ++i) {
      for (std::size_t j = i + 1; j < atoms.size(); ++j) tryDistance(atoms[i], atoms[j]);
    }
    for (const auto& [x, y, z] : kForward) {
      const std::int64_t other = grid.neighborOf(cell, {x, y, z});
      if (other < 0) continue;
      const auto others = grid.pointsOf(static_cast<std::size_t>(other));
      if (others.size() > kMaxCellAtoms) continue;
      for (const std::uint32_t a : atoms) {
        for (const std::uint32_t b : others) tryDistance(a, b);
      }
    }
  }
  addMetalBonds(grid);
  if (crowded > 0) {
    logger_.note(fmt::format(
        "{} atoms lie on top of each other (over {} in a cube of {:.1f} Å): no bonds by distance there",
        crowded, kMaxCellAtoms, grid.size()));
  }
  if (saturated_) {
    logger_.note(
        fmt::format("some atoms have over {} neighbours in bonding distance: only the first are bonded",
                    kMaxDistanceBonds));
  }
}

/// Bonds of metals that reach farther than the grid's next cells; nearer ones have been found already.
void BondFinder::addMetalBonds(const CellGrid& grid) {
  for (const std::uint32_t a : metals_) {
    float range = 0;
    for (std::size_t e = 0; e < present_.size(); ++e) range = std::max(range, longest_[m_.elements[a]][e]);
    const int reach = static_cast<int>(std::ceil(static_cast<double>(range) / grid.size()));
    const std::size_t home = grid.cellOf(a);
    if (reach < 2 || grid.pointsOf(home).size() > kMaxCellAtoms) continue;
    for (int z = -reach; z <= reach; ++z) {
      for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
          if (std::abs(x) < 2 && std::abs(y) < 2 && std::abs(z) < 2) continue;
          const std::int64_t cell = grid.neighborOf(home, {x, y, z});
          if (cell < 0 || grid.pointsOf(static_cast<std::size_t>(cell)).size() > kMaxCellAtoms) continue;
          for (const std::uint32_t b : grid.pointsOf(static_cast<std::size_t>(cell))) {
            if (!(flags_[b] & metal) || a < b) tryDistance(a, b);
          }
        }
      }
    }
  }
}

void BondFinder::tryDistance(std::uint32_t a, std::uint32_t b) {
  const double limit = static_cast<double>(longest_[m_.elements[a]][m_.elements[b]]);
  const glm::dvec3 between = m_.positions[a] - m_.positions[b];
  const double squared = glm::dot(between, between);
  if (squared > limit * limit || squared < kShortest * kShortest) return;
  const bool sameResidue = m_.residueOf[a] == m_.residueOf[b];
  if (sameResidue ? (flags_[a] & flags_[b] & inTemplate) != 0 : ((flags_[a] | flags_[b]) & water) != 0)
    return;
  if (!altlocsMeet(m_.altlocs[a], m_.altlocs[b])) return;
  if (degree_[a] >= kMaxDistanceBonds || degree_[b] >= kMaxDistanceBonds) {
    saturated_ = true;
    return;
  }
  ++degree_[a];
  ++degree_[b];
  found_.push_back({std::min(a, b), std::max(a, b), 1, BondOrigin::distance});
}

/// One bond for each pair: the most trusted origin, and an order above 1 if any source knows one.
void sortAndMerge(std::vector<Bond>& bonds) {
  std::sort(bonds.begin(), bonds.end(), [](const Bond& x, const Bond& y) {
    return std::tie(x.a, x.b, x.origin) < std::tie(y.a, y.b, y.origin);
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < bonds.size(); ++i) {
    if (kept > 0 && bonds[kept - 1].a == bonds[i].a && bonds[kept - 1].b == bonds[i].b) {
      if (bonds[kept - 1].order == 1) bonds[kept - 1].order = bonds[i].order;
    } else {
      bonds[kept++] = bonds[i];
    }
  }
  bonds.resize(kept);
}

}  // namespace

void addMissingBonds(Molecule& molecule, Logger& logger) {
  const std::vector<Bond> found = BondFinder(molecule, logger).find();
  molecule.bonds.insert(molecule.bonds.end(), found.begin(), found.end());
  sortAndMerge(molecule.bonds);
}

std::size_t countBonds(const Molecule& molecule, BondOrigin origin) {
  return static_cast<std::size_t>(std::count_if(molecule.bonds.begin(), molecule.bonds.end(),
                                                [origin](const Bond& b) { return b.origin == origin; }));
}

}  // namespace meniscus

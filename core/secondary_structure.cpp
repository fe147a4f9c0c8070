#include "core/secondary_structure.h"

#include <algorithm>
#include <cstddef>
#include <glm/geometric.hpp>
#include <unordered_map>

#include "core/cell_grid.h"

namespace meniscus {
namespace {

// The paper's charges and unit: 0.42 e on C and O, 0.20 e on N and H, 332 Å kcal/mol per e^2.
constexpr double kCoupling = 0.42 * 0.20 * 332;
constexpr double kBondEnergy = -0.5;    // kcal/mol; below it, the paper speaks of a hydrogen bond
constexpr double kHydrogenBond = 1.01;  // N-H [Å]
constexpr double kFarthestCa = 9.0;     // of residues that can be bonded [Å]
constexpr double kClosest =
    0.5;  // atoms nearer than that are an error of the file: as close a bond as can be

struct Link {
  bool whole = false;  // N, CA, C and O are there
  bool donor = false;  // with a place for the hydrogen
  glm::dvec3 n, ca, c, o, h;
  std::uint32_t residue = 0;
  std::size_t run = 0;  // backbone
};

enum class Bridge : std::uint8_t { none, parallel, antiparallel };

/// All amino acids one after the other; patterns never reach across runs.
class Pattern {
 public:
  Pattern(const Molecule& molecule, const std::vector<Backbone>& backbones);
  void mark(std::vector<SecondaryStructure>& out) const;

 private:
  void findBonds();
  bool bonded(std::ptrdiff_t acceptor, std::ptrdiff_t donor) const;
  bool sameRun(std::ptrdiff_t first, std::ptrdiff_t last) const;
  Bridge bridgeOf(std::ptrdiff_t i, std::ptrdiff_t j) const;
  void markHelices(std::vector<SecondaryStructure>& out, int turn) const;
  void markStrands(std::vector<SecondaryStructure>& out) const;

  std::vector<Link> links_;
  // By acceptor (C=O): the donors (N-H) bonded to it.
  std::vector<std::vector<std::uint32_t>> bonds_;
};

Pattern::Pattern(const Molecule& m, const std::vector<Backbone>& backbones) {
  for (std::size_t run = 0; run < backbones.size(); ++run) {
    if (backbones[run].nucleic) continue;
    for (std::size_t i = 0; i < backbones[run].residues.size(); ++i) {
      const BackboneResidue& b = backbones[run].residues[i];
      Link link;
      link.residue = b.residue;
      link.run = run;
      link.ca = m.positions[b.trace];
      link.whole = b.n != kNoAtom && b.c != kNoAtom && b.o != kNoAtom;
      if (link.whole) {
        link.n = m.positions[b.n];
        link.c = m.positions[b.c];
        link.o = m.positions[b.o];
      }
      // The hydrogen lies opposite to the carbonyl oxygen before it; proline has none.
      if (i > 0 && link.whole && links_.back().whole && m.residues[b.residue].name != "PRO") {
        const glm::dvec3 carbonyl = links_.back().c - links_.back().o;
        if (glm::length(carbonyl) > 0) {
          link.h = link.n + kHydrogenBond * glm::normalize(carbonyl);
          link.donor = true;
        }
      }
      links_.push_back(link);
    }
  }
  findBonds();
}

double bondEnergy(const Link& acceptor, const Link& donor) {
  const double on = glm::distance(acceptor.o, donor.n), ch = glm::distance(acceptor.c, donor.h),
               oh = glm::distance(acceptor.o, donor.h), cn = glm::distance(acceptor.c, donor.n);
  if (on < kClosest || ch < kClosest || oh < kClosest || cn < kClosest) return -9.9;
  return kCoupling * (1 / on + 1 / ch - 1 / oh - 1 / cn);
}

void Pattern::findBonds() {
  bonds_.resize(links_.size());
  std::vector<glm::dvec3> points;
  for (const Link& link : links_) points.push_back(link.ca);
  if (points.empty()) return;
  const CellGrid grid(points, kFarthestCa);
  for (std::size_t cell = 0; cell < grid.cellCount(); ++cell) {
    for (int n = 0; n < 27; ++n) {
      const std::int64_t other = grid.neighborOf(cell, {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1});
      if (other < 0) continue;
      for (const std::uint32_t a : grid.pointsOf(cell)) {
        for (const std::uint32_t d : grid.pointsOf(static_cast<std::size_t>(other))) {
          // Not to itself, nor to the neighbour whose nitrogen the carbonyl is bound to.
          if (a == d || (d == a + 1 && sameRun(a, d)) || !links_[a].whole || !links_[d].donor) continue;
          if (glm::distance(points[a], points[d]) > kFarthestCa) continue;
          if (bondEnergy(links_[a], links_[d]) < kBondEnergy) bonds_[a].push_back(d);
        }
      }
    }
  }
}

bool Pattern::bonded(std::ptrdiff_t acceptor, std::ptrdiff_t donor) const {
  const std::vector<std::uint32_t>& donors = bonds_[static_cast<std::size_t>(acceptor)];
  return std::find(donors.begin(), donors.end(), static_cast<std::uint32_t>(donor)) != donors.end();
}

bool Pattern::sameRun(std::ptrdiff_t first, std::ptrdiff_t last) const {
  return first >= 0 && last < static_cast<std::ptrdiff_t>(links_.size()) &&
         links_[static_cast<std::size_t>(first)].run == links_[static_cast<std::size_t>(last)].run;
}

Bridge Pattern::bridgeOf(std::ptrdiff_t i, std::ptrdiff_t j) const {
  if (!sameRun(i - 1, i + 1) || !sameRun(j - 1, j + 1)) return Bridge::none;
  if ((bonded(i - 1, j) && bonded(j, i + 1)) || (bonded(j - 1, i) && bonded(i, j + 1)))
    return Bridge::parallel;
  if ((bonded(i, j) && bonded(j, i)) || (bonded(i - 1, j + 1) && bonded(j - 1, i + 1)))
    return Bridge::antiparallel;
  return Bridge::none;
}

// Two turns in a row make a helix of the residues between their ends.
void Pattern::markHelices(std::vector<SecondaryStructure>& out, int turn) const {
  const auto isTurn = [&](std::ptrdiff_t i) { return sameRun(i, i + turn) && bonded(i, i + turn); };
  for (std::ptrdiff_t i = 1; i < static_cast<std::ptrdiff_t>(links_.size()); ++i) {
    if (!isTurn(i - 1) || !isTurn(i) || !sameRun(i - 1, i)) continue;
    for (std::ptrdiff_t k = i; k < i + turn; ++k)
      out[links_[static_cast<std::size_t>(k)].residue] = SecondaryStructure::helix;
  }
}

// Bridges of one type in a row make a ladder, also across a bulge: at most one residue more on one side and
// four on the other (the paper, p. 2582). All residues between the ends of a ladder's two sides are strand.
void Pattern::markStrands(std::vector<SecondaryStructure>& out) const {
  struct Found {
    std::ptrdiff_t i, j;
    Bridge type;
  };
  std::vector<Found> bridges;
  for (std::ptrdiff_t i = 1; i + 1 < static_cast<std::ptrdiff_t>(links_.size()); ++i) {
    // Partners of a bridge at i are next to the partners of i's, or its neighbours', hydrogen bonds.
    std::vector<std::ptrdiff_t> candidates;
    for (std::ptrdiff_t a = i - 1; a <= i + 1; ++a)
      for (const std::uint32_t d : bonds_[static_cast<std::size_t>(a)])
        for (std::ptrdiff_t step = -1; step <= 1; ++step)
          candidates.push_back(static_cast<std::ptrdiff_t>(d) + step);
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    for (const std::ptrdiff_t j : candidates) {
      if (j <= 0 || j + 1 >= static_cast<std::ptrdiff_t>(links_.size())) continue;
      if (sameRun(std::min(i, j), std::max(i, j)) && std::abs(j - i) <= 2) continue;
      const Bridge type = bridgeOf(i, j);
      if (type != Bridge::none) bridges.push_back({i, j, type});
    }
  }
  std::unordered_map<std::ptrdiff_t, std::vector<std::size_t>> byFirst;
  for (std::size_t k = 0; k < bridges.size(); ++k) byFirst[bridges[k].i].push_back(k);
  const auto mark = [&](std::ptrdiff_t a, std::ptrdiff_t b) {
    for (std::ptrdiff_t k = std::min(a, b); k <= std::max(a, b); ++k) {
      SecondaryStructure& state = out[links_[static_cast<std::size_t>(k)].residue];
      if (state != SecondaryStructure::helix) state = SecondaryStructure::strand;
    }
  };
  for (const Found& a : bridges) {
    for (std::ptrdiff_t step = 1; step <= 5; ++step) {
      const auto next = byFirst.find(a.i + step);
      if (next == byFirst.end() || !sameRun(a.i, a.i + step)) continue;
      for (const std::size_t k : next->second) {
        const Found& b = bridges[k];
        const std::ptrdiff_t across = a.type == Bridge::parallel ? b.j - a.j : a.j - b.j;
        if (b.type != a.type || across < 1 || !sameRun(std::min(a.j, b.j), std::max(a.j, b.j))) continue;
        if (!((step <= 2 && across <= 5) || across <= 2)) continue;
        mark(a.i, b.i);
        mark(a.j, b.j);
      }
    }
  }
}

void Pattern::mark(std::vector<SecondaryStructure>& out) const {
  // The paper's order of precedence: 4-helix, bridge, then the other helices.
  markHelices(out, 4);
  markStrands(out);
  std::vector<SecondaryStructure> others(out.size(), SecondaryStructure::coil);
  markHelices(others, 3);
  markHelices(others, 5);
  for (std::size_t i = 0; i < out.size(); ++i)
    if (out[i] == SecondaryStructure::coil) out[i] = others[i];
}

}  // namespace

std::vector<SecondaryStructure> assignSecondary(const Molecule& molecule,
                                                const std::vector<Backbone>& backbones) {
  std::vector<SecondaryStructure> out(molecule.residues.size(), SecondaryStructure::coil);
  Pattern(molecule, backbones).mark(out);
  return out;
}

std::vector<SecondaryStructure> secondaryOf(const Molecule& molecule,
                                            const std::vector<Backbone>& backbones) {
  if (!molecule.hasSecondary) return assignSecondary(molecule, backbones);
  std::vector<SecondaryStructure> out;
  for (const Residue& residue : molecule.residues) out.push_back(residue.secondary);
  return out;
}

}  // namespace meniscus

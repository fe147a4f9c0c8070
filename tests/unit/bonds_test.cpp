#include "core/bonds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <set>
#include <string>
#include <utility>

#include "core/elements.h"
#include "core/residue_templates.h"

namespace meniscus {
namespace {

/// A molecule put together atom by atom.
struct Maker {
  Molecule m;
  void residue(const std::string& name, int number, ResidueKind kind = ResidueKind::ligand) {
    if (m.chains.empty()) m.chains.push_back({"A", {0, 0}});
    Residue r;
    r.name = name;
    r.number = number;
    r.kind = kind;
    r.atoms = {static_cast<std::uint32_t>(m.atomCount()), 0};
    m.residues.push_back(r);
    ++m.chains[0].residues.count;
  }
  void atom(const char* name, const char* element, glm::dvec3 p, char altloc = ' ') {
    m.positions.push_back(p);
    m.names.emplace_back(name);
    m.elements.push_back(elementFromSymbol(element));
    m.residueOf.push_back(static_cast<std::uint32_t>(m.residues.size() - 1));
    m.altlocs.push_back(altloc);
    ++m.residues.back().atoms.count;
  }
  const std::vector<Bond>& bonds() {
    addMissingBonds(m, logger);
    return m.bonds;
  }
  Logger logger;
};

std::size_t bondsAt(const char* a, const char* b, double distance) {
  Maker maker;
  maker.residue("LIG", 1);
  maker.atom("A1", a, {0, 0, 0});
  maker.atom("B1", b, {distance, 0, 0});
  return maker.bonds().size();
}

TEST(DistanceRule, boundsAreThoseOfCordero) {
  EXPECT_EQ(bondsAt("C", "C", 1.96), 1u);  // 0.76 + 0.76 + 0.45 = 1.97
  EXPECT_EQ(bondsAt("C", "C", 1.98), 0u);
  EXPECT_EQ(bondsAt("C", "C", 0.41), 1u);
  EXPECT_EQ(bondsAt("C", "C", 0.39), 0u);
  EXPECT_EQ(bondsAt("C", "C", 0.0), 0u);
  EXPECT_EQ(bondsAt("H", "H", 0.74), 0u);
  EXPECT_EQ(bondsAt("C", "H", 1.09), 1u);
  EXPECT_EQ(bondsAt("S", "S", 2.05), 1u);
}

TEST(DistanceRule, metals) {
  EXPECT_EQ(bondsAt("Zn", "S", 2.3), 1u);
  EXPECT_EQ(bondsAt("Ca", "O", 2.6), 1u);
  EXPECT_EQ(bondsAt("Cs", "O", 3.4), 1u);  // farther than the grid's next cell
  EXPECT_EQ(bondsAt("Zn", "C", 2.4), 0u);
  EXPECT_EQ(bondsAt("Fe", "C", 1.8), 1u);
  EXPECT_EQ(bondsAt("Na", "C", 2.4), 0u);
  EXPECT_EQ(bondsAt("Zn", "H", 1.6), 0u);
  EXPECT_EQ(bondsAt("Fe", "Fe", 2.7), 0u);
  EXPECT_EQ(bondsAt("W", "W", 2.2), 1u);
}

TEST(DistanceRule, ironSulphurCubaneHasNoIronIronBond) {
  Maker maker;
  maker.residue("SF4", 1);
  const double f = 2.72 / std::sqrt(8.0);
  const double s = 3.55 / std::sqrt(8.0);
  const glm::dvec3 corners[] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  for (const glm::dvec3& c : corners) maker.atom("FE", "Fe", c * f);
  for (const glm::dvec3& c : corners) maker.atom("S", "S", -c * s);
  EXPECT_EQ(maker.bonds().size(), 12u);
  for (const Bond& bond : maker.m.bonds) EXPECT_TRUE(bond.a < 4 && bond.b >= 4);
}

TEST(DistanceRule, neverBetweenDifferentAltlocs) {
  Maker maker;
  maker.residue("LIG", 1);
  maker.atom("C1", "C", {0, 0, 0});
  maker.atom("C2", "C", {1.5, 0, 0}, 'A');
  maker.atom("C3", "C", {1.5, 0.5, 0}, 'B');
  EXPECT_EQ(maker.bonds().size(), 2u);
}

TEST(DistanceRule, watersBondOnlyWithinTheirResidue) {
  Maker maker;
  maker.residue("HOH", 1, ResidueKind::water);
  maker.atom("O", "O", {0, 0, 0});
  maker.atom("H1", "H", {0.96, 0, 0});
  maker.residue("HOH", 2, ResidueKind::water);
  maker.atom("O", "O", {1.4, 0, 0});
  maker.residue("ZN", 3, ResidueKind::ion);
  maker.atom("ZN", "Zn", {0, 2.0, 0});
  EXPECT_EQ(maker.bonds().size(), 1u);
}

TEST(Templates, decideWithinStandardResidues) {
  Maker maker;
  maker.residue("PHE", 1, ResidueKind::aminoAcid);
  maker.atom("CG", "C", {0, 0, 0});
  maker.atom("CD1", "C", {1.2, 0.7, 0});
  maker.atom("CD2", "C", {0.5, 1.2, 0});  // clashes with CD1, which the distance rule would bond
  maker.residue("GLY", 2, ResidueKind::aminoAcid);
  maker.atom("C", "C", {20, 0, 0});
  maker.atom("O", "O", {21.2, 0, 0});
  maker.residue("GLY", 3, ResidueKind::aminoAcid);
  maker.atom("N", "N", {19.4, 1.2, 0});
  ASSERT_EQ(maker.bonds().size(), 4u);
  EXPECT_EQ(maker.m.bonds[0].order, 4);
  EXPECT_EQ(maker.m.bonds[2].order, 2);
  EXPECT_EQ(countBonds(maker.m, BondOrigin::residueTemplate), 4u);
}

TEST(Templates, phosphodiesterAndDisulphide) {
  Maker maker;
  maker.residue("DA", 1, ResidueKind::nucleotide);
  maker.atom("O3'", "O", {0, 0, 0});
  maker.residue("DC", 2, ResidueKind::nucleotide);
  maker.atom("P", "P", {1.6, 0, 0});
  maker.residue("CYS", 3, ResidueKind::aminoAcid);
  maker.atom("SG", "S", {10, 0, 0});
  maker.residue("CYS", 9, ResidueKind::aminoAcid);
  maker.atom("SG", "S", {12.04, 0, 0});
  ASSERT_EQ(maker.bonds().size(), 2u);
  EXPECT_EQ(maker.m.bonds[0].origin, BondOrigin::residueTemplate);
  EXPECT_EQ(maker.m.bonds[1].origin, BondOrigin::distance);
}

TEST(Templates, ofTheStandardResiduesHoldTheirHeavyAtoms) {
  // Heavy atoms with OXT, and bonds between them: a tree for every ring but R - 1 more.
  const std::pair<const char*, std::pair<int, int>> expected[] = {{"ALA", {6, 5}},  {"TRP", {15, 16}},
                                                                  {"PRO", {8, 8}},  {"HIS", {11, 11}},
                                                                  {"LYS", {10, 9}}, {"MSE", {9, 8}}};
  for (const auto& [name, counts] : expected) {
    const ResidueTemplate* known = findResidueTemplate(name);
    ASSERT_NE(known, nullptr) << name;
    std::set<int> heavy;
    int bonds = 0;
    for (const TemplateBond& bond : known->bonds) {
      if (known->names[bond.a].text[0] == 'H' || known->names[bond.b].text[0] == 'H') continue;
      heavy.insert(bond.a);
      heavy.insert(bond.b);
      ++bonds;
    }
    EXPECT_EQ(static_cast<int>(heavy.size()), counts.first) << name;
    EXPECT_EQ(bonds, counts.second) << name;
  }
  EXPECT_EQ(findResidueTemplate("HEM"), nullptr);
  EXPECT_GE(findResidueTemplate("DA")->indexOf(AtomName("O5*")), 0);
}

TEST(Merging, mostTrustedOriginWinsAndKnowsTheHigherOrder) {
  Maker maker;
  maker.residue("GLY", 1, ResidueKind::aminoAcid);
  maker.atom("C", "C", {0, 0, 0});
  maker.atom("O", "O", {1.23, 0, 0});
  maker.m.bonds = {{0, 1, 1, BondOrigin::conect}, {0, 1, 1, BondOrigin::conect}};
  ASSERT_EQ(maker.bonds().size(), 1u);
  EXPECT_EQ(maker.m.bonds[0].origin, BondOrigin::conect);
  EXPECT_EQ(maker.m.bonds[0].order, 2);
}

TEST(DistanceRule, agreesWithBruteForceOnRandomAtomsFarFromTheOrigin) {
  std::mt19937 random(11);
  const char* elements[] = {"H", "C", "N", "O", "S", "P", "Fe", "Ca", "I", "K"};
  for (const double shift : {0.0, 1e3, 1e6}) {
    Maker maker;
    maker.residue("LIG", 1);
    std::uniform_real_distribution<double> coordinate(0, 19);
    for (int i = 0; i < 300; ++i) {
      maker.atom("X", elements[random() % 10],
                 glm::dvec3(shift + coordinate(random), coordinate(random) - shift, coordinate(random)),
                 "  AB"[random() % 4]);
    }
    std::set<std::pair<std::uint32_t, std::uint32_t>> expected;
    const Molecule& m = maker.m;
    for (std::uint32_t a = 0; a < m.atomCount(); ++a) {
      for (std::uint32_t b = a + 1; b < m.atomCount(); ++b) {
        const std::uint8_t ea = m.elements[a], eb = m.elements[b];
        if (m.altlocs[a] != m.altlocs[b] && m.altlocs[a] != ' ' && m.altlocs[b] != ' ') continue;
        const double sum = double(covalentRadius(ea)) + double(covalentRadius(eb));
        const std::uint8_t other = isMetal(ea) ? eb : ea;
        double limit = sum + 0.45;
        if (isMetal(ea) && isMetal(eb)) {
          limit = sum * 0.95;
        } else if (isMetal(ea) || isMetal(eb)) {
          const std::uint8_t metal = isMetal(ea) ? ea : eb;
          if (other == 1) limit = 0;
          if (other == 6) limit = metal == 26 ? sum + 0.2 : 0;
        } else if (ea == 1 && eb == 1) {
          limit = 0;
        }
        const double d = glm::distance(m.positions[a], m.positions[b]);
        if (d >= 0.4 && d <= limit) expected.insert({a, b});
      }
    }
    std::set<std::pair<std::uint32_t, std::uint32_t>> found;
    for (const Bond& bond : maker.bonds()) found.insert({bond.a, bond.b});
    EXPECT_EQ(found, expected) << shift;
    EXPECT_GT(found.size(), 100u);
    EXPECT_TRUE(maker.logger.notes().empty());
    EXPECT_TRUE(std::is_sorted(m.bonds.begin(), m.bonds.end(), [](const Bond& x, const Bond& y) {
      return std::pair(x.a, x.b) < std::pair(y.a, y.b);
    }));
  }
}

TEST(Robust, atomsOnTopOfEachOtherAreLeftOutWithANote) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(0, 1);
  Maker maker;
  maker.residue("ALA", 1, ResidueKind::aminoAcid);
  for (int i = 0; i < 100'000; ++i) {
    maker.atom(i % 2 ? "CA" : "CB", "C", {coordinate(random), coordinate(random), coordinate(random)});
  }
  EXPECT_TRUE(maker.bonds().empty());
  ASSERT_EQ(maker.logger.notes().size(), 1u);
  EXPECT_NE(maker.logger.notes()[0].find("100000 atoms lie on top of each other"), std::string::npos);
}

TEST(Robust, noAtoms) {
  Molecule empty;
  Logger logger;
  addMissingBonds(empty, logger);
  EXPECT_TRUE(empty.bonds.empty());
}

}  // namespace
}  // namespace meniscus

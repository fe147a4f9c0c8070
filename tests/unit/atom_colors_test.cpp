// Colours of atoms, scheme by scheme.

#include "core/atom_colors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

namespace meniscus {
namespace {

// One atom per residue.
Molecule chainsOf(const std::vector<std::size_t>& residuesPerChain) {
  Molecule m;
  for (std::uint32_t c = 0; c < residuesPerChain.size(); ++c) {
    const auto first = static_cast<std::uint32_t>(m.residues.size());
    for (std::size_t i = 0; i < residuesPerChain[c]; ++i) {
      Residue residue;
      residue.name = "ALA";
      residue.kind = ResidueKind::aminoAcid;
      residue.chain = c;
      residue.atoms = {static_cast<std::uint32_t>(m.positions.size()), 1};
      m.residueOf.push_back(static_cast<std::uint32_t>(m.residues.size()));
      m.residues.push_back(residue);
      m.positions.emplace_back(static_cast<double>(i), 0.0, 0.0);
      m.elements.push_back(6);
      m.bFactors.push_back(0);
    }
    m.chains.push_back({std::string(1, static_cast<char>('A' + c)),
                        {first, static_cast<std::uint32_t>(residuesPerChain[c])}});
  }
  return m;
}

Molecule withBFactors(const std::vector<float>& values) {
  Molecule m = chainsOf({values.size()});
  m.bFactors = values;
  return m;
}

int red(Rgb c) {
  return static_cast<int>(c >> 16);
}
int green(Rgb c) {
  return static_cast<int>((c >> 8) & 0xFF);
}
int blue(Rgb c) {
  return static_cast<int>(c & 0xFF);
}
bool isGrey(Rgb c) {
  return std::max({red(c), green(c), blue(c)}) - std::min({red(c), green(c), blue(c)}) < 8;
}

double hueDegrees(Rgb c) {
  const double r = red(c), g = green(c), b = blue(c);
  return std::fmod(std::atan2(std::sqrt(3.0) * (g - b), 2 * r - g - b) * 57.29577951308232 + 360, 360);
}

TEST(AtomColors, PlddtChangesExactlyAboveItsThresholds) {
  const float above90 = std::nextafter(90.0f, 100.0f), above70 = std::nextafter(70.0f, 100.0f),
              above50 = std::nextafter(50.0f, 100.0f);
  const std::vector<Rgb> colors =
      colorAtoms(withBFactors({100, above90, 90, above70, 70, above50, 50, 0, -1, NAN, INFINITY}),
                 {.scheme = ColorScheme::plddt});
  // AlphaFold Database: very high (> 90), confident (90 >= x > 70), low (70 >= x > 50), very low.
  constexpr Rgb kVeryHigh = 0x0053D6, kHigh = 0x65CBF3, kLow = 0xFFDB13, kVeryLow = 0xFF7D45;
  const std::vector<Rgb> expected{kVeryHigh, kVeryHigh, kHigh,    kHigh,   kLow,
                                  kLow,      kVeryLow,  kVeryLow, kVeryLow};
  EXPECT_EQ(std::vector<Rgb>(colors.begin(), colors.begin() + 9), expected);
  EXPECT_TRUE(isGrey(colors[9])) << "no value, no band";
  EXPECT_TRUE(isGrey(colors[10]));
}

TEST(AtomColors, ElementsAreThoseOfJmol) {
  Molecule m = chainsOf({8});
  m.elements = {1, 6, 7, 8, 15, 16, 26, 0};
  // jmol.sourceforge.net/jscolors
  EXPECT_EQ(colorAtoms(m, {}), (std::vector<Rgb>{0xFFFFFF, 0x909090, 0x3050F8, 0xFF0D0D, 0xFF8000, 0xFFFF30,
                                                 0xE06633, 0xFF1493}));
}

TEST(AtomColors, CarbonsTakeTheirChainsColour) {
  Molecule m = chainsOf({2, 2});
  m.elements = {6, 8, 6, 8};
  const std::vector<Rgb> chains = colorAtoms(m, {.scheme = ColorScheme::chain});
  const std::vector<Rgb> colors = colorAtoms(m, {.scheme = ColorScheme::element, .carbonsByChain = true});
  EXPECT_EQ(colors, (std::vector<Rgb>{chains[0], 0xFF0D0D, chains[2], 0xFF0D0D}));
  EXPECT_NE(colors[0], colors[2]);
}

TEST(AtomColors, TwentyChainsHaveTwentyColoursThatCanBeToldApart) {
  const std::vector<Rgb> colors =
      colorAtoms(chainsOf(std::vector<std::size_t>(25, 1)), {.scheme = ColorScheme::chain});
  EXPECT_EQ(std::set<Rgb>(colors.begin(), colors.begin() + 20).size(), 20u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(colors[20 + i], colors[i]) << "the palette starts again";
  for (std::size_t i = 0; i < 20; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const int d = std::abs(red(colors[i]) - red(colors[j])) +
                    std::abs(green(colors[i]) - green(colors[j])) +
                    std::abs(blue(colors[i]) - blue(colors[j]));
      EXPECT_GE(d, 40) << i << " and " << j;
    }
  }
}

TEST(AtomColors, UniformIsTheColourAskedFor) {
  const Coloring coloring{.scheme = ColorScheme::uniform, .uniform = 0x123456};
  for (const Rgb color : colorAtoms(chainsOf({3}), coloring)) EXPECT_EQ(color, 0x123456u);
}

TEST(AtomColors, RainbowRunsFromBlueToRedInEveryChain) {
  const Molecule m = chainsOf({100, 7});
  const std::vector<Rgb> colors = colorAtoms(m, {.scheme = ColorScheme::rainbow});
  for (const IndexRange& chain : {IndexRange{0, 100}, IndexRange{100, 7}}) {
    const Rgb first = colors[chain.first], last = colors[chain.end() - 1];
    EXPECT_GT(blue(first), std::max(red(first), green(first)) + 40);
    EXPECT_GT(red(last), std::max(green(last), blue(last)) + 40);
    for (std::uint32_t i = chain.first; i + 1 < chain.end(); ++i) {
      double from = hueDegrees(colors[i]), to = hueDegrees(colors[i + 1]);
      if (to > 300) to -= 360;  // the red end may lie on either side of 0
      if (from > 300) from -= 360;
      EXPECT_LE(to, from + 1.0) << "hue turns back at residue " << i;  // 1 degree: 8-bit channels
    }
  }
  EXPECT_EQ(colors[0], colors[100]) << "every chain has its own ends";
}

TEST(AtomColors, RainbowLeavesOutWhatIsNoPolymer) {
  Molecule m = chainsOf({12});
  m.residues[10].kind = ResidueKind::water;
  m.residues[11].kind = ResidueKind::ligand;
  const std::vector<Rgb> colors = colorAtoms(m, {.scheme = ColorScheme::rainbow});
  EXPECT_TRUE(isGrey(colors[10]));
  EXPECT_TRUE(isGrey(colors[11]));
  EXPECT_GT(red(colors[9]), green(colors[9]) + 40) << "the last of the polymer is red";
  EXPECT_EQ(colorAtoms(chainsOf({1}), {.scheme = ColorScheme::rainbow}).size(), 1u) << "a chain of one";
}

TEST(AtomColors, BFactorRunsBetweenThe5thAnd95thPercentile) {
  std::vector<float> values(101);
  std::iota(values.begin(), values.end(), 0.0f);
  values[100] = 1e6f;  // an outlier must not flatten the rest
  const std::vector<Rgb> colors = colorAtoms(withBFactors(values), {.scheme = ColorScheme::bFactor});
  EXPECT_GT(blue(colors[5]), red(colors[5]) + 60);
  EXPECT_EQ(colors[0], colors[5]) << "clamped";
  EXPECT_NE(colors[5], colors[6]);
  EXPECT_TRUE(isGrey(colors[50])) << "white in the middle";
  EXPECT_GT(red(colors[50]), 230);
  EXPECT_GT(red(colors[95]), blue(colors[95]) + 60);
  EXPECT_EQ(colors[100], colors[95]) << "clamped";
  EXPECT_NE(colors[94], colors[95]);
  for (std::size_t i = 5; i < 95; ++i) {
    EXPECT_GE(red(colors[i + 1]) - blue(colors[i + 1]), red(colors[i]) - blue(colors[i]))
        << "monotone at " << i;
  }
}

TEST(AtomColors, TwoDifferentBFactorsHaveDifferentColours) {
  const std::vector<Rgb> colors = colorAtoms(withBFactors({10, 90}), {.scheme = ColorScheme::bFactor});
  EXPECT_GT(blue(colors[0]), red(colors[0]));
  EXPECT_GT(red(colors[1]), blue(colors[1]));
}

TEST(AtomColors, BFactorsThatAreNoNumbersAreGreyAndDoNoHarm) {
  std::vector<float> values{NAN, 10, 20, 30, INFINITY, 40, -INFINITY};
  const std::vector<Rgb> colors = colorAtoms(withBFactors(values), {.scheme = ColorScheme::bFactor});
  for (const std::size_t i : {0u, 4u, 6u}) EXPECT_TRUE(isGrey(colors[i])) << i;
  EXPECT_GT(blue(colors[1]), red(colors[1]));
  for (const Rgb color : colorAtoms(withBFactors({NAN, NAN}), {.scheme = ColorScheme::bFactor})) {
    EXPECT_TRUE(isGrey(color));
  }
  for (const Rgb color : colorAtoms(withBFactors({30, 30, 30}), {.scheme = ColorScheme::bFactor})) {
    EXPECT_TRUE(isGrey(color)) << "all the same: the middle of the scale";
  }
}

TEST(AtomColors, ResiduesByKind) {
  Molecule m = chainsOf({10});
  const char* names[] = {"ASP", "GLU", "LYS", "ARG", "DA", "A", "HOH", "NA", "HEM", "XYZ"};
  for (std::size_t i = 0; i < 10; ++i) m.residues[i].name = names[i];
  m.residues[4].kind = m.residues[5].kind = ResidueKind::nucleotide;
  m.residues[6].kind = ResidueKind::water;
  m.residues[7].kind = ResidueKind::ion;
  m.residues[8].kind = ResidueKind::ligand;
  const std::vector<Rgb> c = colorAtoms(m, {.scheme = ColorScheme::residue});
  EXPECT_EQ(c[0], c[1]) << "acids";
  EXPECT_EQ(c[2], c[3]) << "bases";
  EXPECT_EQ(c[4], c[5]) << "the same base in DNA and RNA";
  EXPECT_TRUE(isGrey(c[9])) << "an unknown amino acid";
  EXPECT_EQ((std::set<Rgb>{c[0], c[2], c[4], c[6], c[7], c[8], c[9]}.size()), 7u);
}

TEST(AtomColors, AMoleculeWithoutAtomsHasNoColours) {
  for (const ColorScheme scheme :
       {ColorScheme::element, ColorScheme::chain, ColorScheme::residue, ColorScheme::bFactor,
        ColorScheme::plddt, ColorScheme::rainbow, ColorScheme::uniform}) {
    EXPECT_TRUE(colorAtoms(Molecule{}, {.scheme = scheme}).empty());
  }
}

}  // namespace
}  // namespace meniscus

#include "core/atom_colors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace meniscus {

namespace {

// Neighbours in the list differ in hue and in lightness. The first ones are neither the blue of nitrogen nor
// the red of oxygen, so that carbons by chain stay apart from both.
constexpr std::array<Rgb, 20> kChainColors{
    0x59A89C, 0xF2A541, 0xA98BC3, 0xB9C46A, 0xE7A6B8, 0x8CC5E3, 0xA3805F, 0x4C78A8, 0xD4605A, 0xE8D174,
    0x6E9F46, 0xB2477F, 0x3D5A6C, 0xC7B299, 0x9ED06B, 0x8F4E8B, 0xE27D3A, 0x5E7FD6, 0x2F8F6B, 0xB0B0B0};

constexpr Rgb kNoValue = 0xAAAAAA;

// Linear blend of two sRGB colours, channel by channel.
Rgb mix(Rgb from, Rgb to, double share) {
  Rgb out = 0;
  for (const int shift : {16, 8, 0}) {
    const double a = (from >> shift) & 0xFF, b = (to >> shift) & 0xFF;
    out |= static_cast<Rgb>(std::lround(a + (b - a) * share)) << shift;
  }
  return out;
}

Rgb chainColor(std::uint32_t chain) {
  return kChainColors[chain % kChainColors.size()];
}

// AlphaFold Database: confidence bands and their colours (Jumper et al. 2021; Varadi et al. 2022).
Rgb plddtColor(float value) {
  if (!std::isfinite(value)) return kNoValue;
  return value > 90 ? 0x0053D6 : value > 70 ? 0x65CBF3 : value > 50 ? 0xFFDB13 : 0xFF7D45;
}

std::vector<Rgb> colorByBFactor(const Molecule& molecule) {
  std::vector<float> sorted;
  for (const float b : molecule.bFactors) {
    if (std::isfinite(b)) sorted.push_back(b);
  }
  std::vector<Rgb> colors(molecule.atomCount(), kNoValue);
  if (sorted.empty()) return colors;
  std::sort(sorted.begin(), sorted.end());
  const auto percentile = [&](double p) {
    return static_cast<double>(sorted[static_cast<std::size_t>(p * static_cast<double>(sorted.size() - 1))]);
  };
  double low = percentile(0.05), high = percentile(0.95);
  if (!(high > low)) {
    low = percentile(0);
    high = percentile(1);
  }
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const double b = static_cast<double>(molecule.bFactors[i]);
    if (!std::isfinite(b)) continue;
    const double x = high > low ? std::clamp((b - low) / (high - low), 0.0, 1.0) : 0.5;
    colors[i] = x < 0.5 ? mix(0x2C5FB8, 0xF4F4F4, 2 * x) : mix(0xF4F4F4, 0xC8322B, 2 * x - 1);
  }
  return colors;
}

// Blue - cyan - green - yellow - red; anchors rather than pure hues, so that no band glares.
Rgb rainbowColor(double x) {
  constexpr std::array<Rgb, 5> kAnchors{0x3B55C4, 0x35B5C9, 0x58B84F, 0xF0CE3D, 0xD63A33};
  const double scaled = std::clamp(x, 0.0, 1.0) * (kAnchors.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(scaled), kAnchors.size() - 2);
  return mix(kAnchors[i], kAnchors[i + 1], scaled - static_cast<double>(i));
}

bool isPolymer(const Residue& residue) {
  return residue.kind == ResidueKind::aminoAcid || residue.kind == ResidueKind::nucleotide;
}

// By position in its chain's polymer; what is no polymer is grey.
std::vector<Rgb> residueRainbow(const Molecule& molecule) {
  std::vector<Rgb> colors(molecule.residues.size(), kNoValue);
  for (const Chain& chain : molecule.chains) {
    std::vector<std::uint32_t> polymer;
    for (std::uint32_t r = chain.residues.first; r < chain.residues.end(); ++r) {
      if (isPolymer(molecule.residues[r])) polymer.push_back(r);
    }
    const double last = polymer.size() > 1 ? static_cast<double>(polymer.size() - 1) : 1;
    for (std::size_t i = 0; i < polymer.size(); ++i) {
      colors[polymer[i]] = rainbowColor(static_cast<double>(i) / last);
    }
  }
  return colors;
}

// Amino acids by the character of their side chain, nucleotides by base, the rest by what they are.
Rgb residueColor(const Residue& residue) {
  struct Kind {
    std::string_view names;  // separated by blanks
    Rgb color;
  };
  static constexpr std::array<Kind, 7> kAminoAcids{{{"ASP GLU ASX GLX", 0xD9534F},
                                                    {"LYS ARG HIS", 0x4A6FC3},
                                                    {"SER THR ASN GLN", 0x4FA9A0},
                                                    {"PHE TYR TRP", 0x8A63B0},
                                                    {"ALA VAL LEU ILE MET MSE", 0xC9C3B4},
                                                    {"CYS SEC", 0xE3C236},
                                                    {"GLY PRO", 0xE59A5B}}};
  static constexpr std::array<Kind, 4> kBases{
      {{"A DA", 0x4FA96B}, {"C DC", 0x4A7FC3}, {"G DG", 0xE0A63A}, {"T DT U DU", 0xCC5B5B}}};
  const auto isIn = [&](std::string_view names) {
    for (std::size_t at = 0; at < names.size();) {
      const std::size_t end = std::min(names.find(' ', at), names.size());
      if (names.substr(at, end - at) == residue.name) return true;
      at = end + 1;
    }
    return false;
  };
  if (residue.kind == ResidueKind::aminoAcid) {
    for (const Kind& kind : kAminoAcids) {
      if (isIn(kind.names)) return kind.color;
    }
    return 0xB0B0B0;
  }
  if (residue.kind == ResidueKind::nucleotide) {
    for (const Kind& kind : kBases) {
      if (isIn(kind.names)) return kind.color;
    }
    return 0xB0B0B0;
  }
  switch (residue.kind) {
    case ResidueKind::water:
      return 0xE06A6A;
    case ResidueKind::ion:
      return 0x9B6BD6;
    case ResidueKind::saccharide:
      return 0x69B3E7;
    default:
      return 0xE07BC0;
  }
}

}  // namespace

std::vector<Rgb> colorAtoms(const Molecule& molecule, const Coloring& coloring) {
  if (coloring.scheme == ColorScheme::bFactor) return colorByBFactor(molecule);
  std::vector<Rgb> rainbow;
  if (coloring.scheme == ColorScheme::rainbow) rainbow = residueRainbow(molecule);

  std::vector<Rgb> colors(molecule.atomCount());
  for (std::size_t i = 0; i < colors.size(); ++i) {
    switch (coloring.scheme) {
      case ColorScheme::element: {
        const bool carbon = molecule.elements[i] == 6 && coloring.carbonsByChain;
        colors[i] = carbon ? chainColor(molecule.chainOf(i)) : elementColor(molecule.elements[i]);
        break;
      }
      case ColorScheme::chain:
        colors[i] = chainColor(molecule.chainOf(i));
        break;
      case ColorScheme::residue:
        colors[i] = residueColor(molecule.residues[molecule.residueOf[i]]);
        break;
      case ColorScheme::plddt:
        colors[i] = plddtColor(molecule.bFactors[i]);
        break;
      case ColorScheme::rainbow:
        colors[i] = rainbow[molecule.residueOf[i]];
        break;
      case ColorScheme::uniform:
        colors[i] = coloring.uniform;
        break;
      case ColorScheme::bFactor:
        break;  // above
    }
  }
  return colors;
}

}  // namespace meniscus

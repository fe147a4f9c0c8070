// Element tables, index = atomic number.
// Colours: the table of Jmol (jmol.sourceforge.net/jscolors), unknown = its deep pink.
// Bondi radii: A. Bondi, J. Phys. Chem. 68 (1964) 441, doi 10.1021/j100785a001, with H = 1.20; main-group
// elements that Bondi lacks from M. Mantina et al., J. Phys. Chem. A 113 (2009) 5806, doi 10.1021/jp8111556,
// as most programs do. Alvarez radii: S. Alvarez, Dalton Trans. 42 (2013) 8617, doi 10.1039/c3dt50599e,
// Table 1. Covalent radii: B. Cordero et al., Dalton Trans. (2008) 2832, doi 10.1039/b801115j, Table 2: C
// sp3; Mn, Fe, Co low spin.
#include "core/elements.h"

#include <array>

namespace meniscus {
namespace {

struct Element {
  char symbol[3];
  std::uint32_t color;
  float bondi;     ///< 0 = not in the set
  float alvarez;   ///< 0 = not in the set
  float covalent;  ///< 0 = not in the set
};

constexpr float kFallbackVanDerWaals = 2.0f;
constexpr float kUnknownCovalent = 0.76f;       // an unknown atom is most often a carbon of an unknown ligand
constexpr float kTransuraniumCovalent = 1.69f;  // Cordero's last, Cm, for what lies beyond

// clang-format off
constexpr std::array<Element, kElementCount> kElements{{
  {"X",  0xFF1493, 0, 0, kUnknownCovalent},
  {"H",  0xFFFFFF, 1.20f, 1.20f, 0.31f}, {"He", 0xD9FFFF, 1.40f, 1.43f, 0.28f},
  {"Li", 0xCC80FF, 1.82f, 2.12f, 1.28f}, {"Be", 0xC2FF00, 1.53f, 1.98f, 0.96f},
  {"B",  0xFFB5B5, 1.92f, 1.91f, 0.84f}, {"C",  0x909090, 1.70f, 1.77f, 0.76f},
  {"N",  0x3050F8, 1.55f, 1.66f, 0.71f}, {"O",  0xFF0D0D, 1.52f, 1.50f, 0.66f},
  {"F",  0x90E050, 1.47f, 1.46f, 0.57f}, {"Ne", 0xB3E3F5, 1.54f, 1.58f, 0.58f},
  {"Na", 0xAB5CF2, 2.27f, 2.50f, 1.66f}, {"Mg", 0x8AFF00, 1.73f, 2.51f, 1.41f},
  {"Al", 0xBFA6A6, 1.84f, 2.25f, 1.21f}, {"Si", 0xF0C8A0, 2.10f, 2.19f, 1.11f},
  {"P",  0xFF8000, 1.80f, 1.90f, 1.07f}, {"S",  0xFFFF30, 1.80f, 1.89f, 1.05f},
  {"Cl", 0x1FF01F, 1.75f, 1.82f, 1.02f}, {"Ar", 0x80D1E3, 1.88f, 1.83f, 1.06f},
  {"K",  0x8F40D4, 2.75f, 2.73f, 2.03f}, {"Ca", 0x3DFF00, 2.31f, 2.62f, 1.76f},
  {"Sc", 0xE6E6E6, 0,     2.58f, 1.70f}, {"Ti", 0xBFC2C7, 0,     2.46f, 1.60f},
  {"V",  0xA6A6AB, 0,     2.42f, 1.53f}, {"Cr", 0x8A99C7, 0,     2.45f, 1.39f},
  {"Mn", 0x9C7AC7, 0,     2.45f, 1.39f}, {"Fe", 0xE06633, 0,     2.44f, 1.32f},
  {"Co", 0xF090A0, 0,     2.40f, 1.26f}, {"Ni", 0x50D050, 1.63f, 2.40f, 1.24f},
  {"Cu", 0xC88033, 1.40f, 2.38f, 1.32f}, {"Zn", 0x7D80B0, 1.39f, 2.39f, 1.22f},
  {"Ga", 0xC28F8F, 1.87f, 2.32f, 1.22f}, {"Ge", 0x668F8F, 2.11f, 2.29f, 1.20f},
  {"As", 0xBD80E3, 1.85f, 1.88f, 1.19f}, {"Se", 0xFFA100, 1.90f, 1.82f, 1.20f},
  {"Br", 0xA62929, 1.85f, 1.86f, 1.20f}, {"Kr", 0x5CB8D1, 2.02f, 2.25f, 1.16f},
  {"Rb", 0x702EB0, 3.03f, 3.21f, 2.20f}, {"Sr", 0x00FF00, 2.49f, 2.84f, 1.95f},
  {"Y",  0x94FFFF, 0,     2.75f, 1.90f}, {"Zr", 0x94E0E0, 0,     2.52f, 1.75f},
  {"Nb", 0x73C2C9, 0,     2.56f, 1.64f}, {"Mo", 0x54B5B5, 0,     2.45f, 1.54f},
  {"Tc", 0x3B9E9E, 0,     2.44f, 1.47f}, {"Ru", 0x248F8F, 0,     2.46f, 1.46f},
  {"Rh", 0x0A7D8C, 0,     2.44f, 1.42f}, {"Pd", 0x006985, 1.63f, 2.15f, 1.39f},
  {"Ag", 0xC0C0C0, 1.72f, 2.53f, 1.45f}, {"Cd", 0xFFD98F, 1.58f, 2.49f, 1.44f},
  {"In", 0xA67573, 1.93f, 2.43f, 1.42f}, {"Sn", 0x668080, 2.17f, 2.42f, 1.39f},
  {"Sb", 0x9E63B5, 2.06f, 2.47f, 1.39f}, {"Te", 0xD47A00, 2.06f, 1.99f, 1.38f},
  {"I",  0x940094, 1.98f, 2.04f, 1.39f}, {"Xe", 0x429EB0, 2.16f, 2.06f, 1.40f},
  {"Cs", 0x57178F, 3.43f, 3.48f, 2.44f}, {"Ba", 0x00C900, 2.68f, 3.03f, 2.15f},
  {"La", 0x70D4FF, 0,     2.98f, 2.07f}, {"Ce", 0xFFFFC7, 0,     2.88f, 2.04f},
  {"Pr", 0xD9FFC7, 0,     2.92f, 2.03f}, {"Nd", 0xC7FFC7, 0,     2.95f, 2.01f},
  {"Pm", 0xA3FFC7, 0,     0,     1.99f}, {"Sm", 0x8FFFC7, 0,     2.90f, 1.98f},
  {"Eu", 0x61FFC7, 0,     2.87f, 1.98f}, {"Gd", 0x45FFC7, 0,     2.83f, 1.96f},
  {"Tb", 0x30FFC7, 0,     2.79f, 1.94f}, {"Dy", 0x1FFFC7, 0,     2.87f, 1.92f},
  {"Ho", 0x00FF9C, 0,     2.81f, 1.92f}, {"Er", 0x00E675, 0,     2.83f, 1.89f},
  {"Tm", 0x00D452, 0,     2.79f, 1.90f}, {"Yb", 0x00BF38, 0,     2.80f, 1.87f},
  {"Lu", 0x00AB24, 0,     2.74f, 1.87f}, {"Hf", 0x4DC2FF, 0,     2.63f, 1.75f},
  {"Ta", 0x4DA6FF, 0,     2.53f, 1.70f}, {"W",  0x2194D6, 0,     2.57f, 1.62f},
  {"Re", 0x267DAB, 0,     2.49f, 1.51f}, {"Os", 0x266696, 0,     2.48f, 1.44f},
  {"Ir", 0x175487, 0,     2.41f, 1.41f}, {"Pt", 0xD0D0E0, 1.75f, 2.29f, 1.36f},
  {"Au", 0xFFD123, 1.66f, 2.32f, 1.36f}, {"Hg", 0xB8B8D0, 1.55f, 2.45f, 1.32f},
  {"Tl", 0xA6544D, 1.96f, 2.47f, 1.45f}, {"Pb", 0x575961, 2.02f, 2.60f, 1.46f},
  {"Bi", 0x9E4FB5, 2.07f, 2.54f, 1.48f}, {"Po", 0xAB5C00, 1.97f, 0,     1.40f},
  {"At", 0x754F45, 2.02f, 0,     1.50f}, {"Rn", 0x428296, 2.20f, 0,     1.50f},
  {"Fr", 0x420066, 3.48f, 0,     2.60f}, {"Ra", 0x007D00, 2.83f, 0,     2.21f},
  {"Ac", 0x70ABFA, 0,     2.80f, 2.15f}, {"Th", 0x00BAFF, 0,     2.93f, 2.06f},
  {"Pa", 0x00A1FF, 0,     2.88f, 2.00f}, {"U",  0x008FFF, 1.86f, 2.71f, 1.96f},
  {"Np", 0x0080FF, 0,     2.82f, 1.90f}, {"Pu", 0x006BFF, 0,     2.81f, 1.87f},
  {"Am", 0x545CF2, 0,     2.83f, 1.80f}, {"Cm", 0x785CE3, 0,     3.05f, 1.69f},
  {"Bk", 0x8A4FE3, 0,     3.40f, 0},     {"Cf", 0xA136D4, 0,     3.05f, 0},
  {"Es", 0xB31FD4, 0,     2.70f, 0},     {"Fm", 0xB31FBA, 0,     0,     0},
  {"Md", 0xB30DA6, 0,     0,     0},     {"No", 0xBD0D87, 0,     0,     0},
  {"Lr", 0xC70066, 0,     0,     0},     {"Rf", 0xCC0059, 0,     0,     0},
  {"Db", 0xD1004F, 0,     0,     0},     {"Sg", 0xD90045, 0,     0,     0},
  {"Bh", 0xE00038, 0,     0,     0},     {"Hs", 0xE6002E, 0,     0,     0},
  {"Mt", 0xEB0026, 0,     0,     0},     {"Ds", 0xEB0026, 0,     0,     0},
  {"Rg", 0xEB0026, 0,     0,     0},     {"Cn", 0xEB0026, 0,     0,     0},
  {"Nh", 0xEB0026, 0,     0,     0},     {"Fl", 0xEB0026, 0,     0,     0},
  {"Mc", 0xEB0026, 0,     0,     0},     {"Lv", 0xEB0026, 0,     0,     0},
  {"Ts", 0xEB0026, 0,     0,     0},     {"Og", 0xEB0026, 0,     0,     0},
}};
// clang-format on

const Element& at(std::uint8_t element) {
  return kElements[element < kElementCount ? element : 0];
}

char upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

/// Slot of a symbol of one or two letters in the look-up table, -1 if it is none.
int slotOf(std::string_view symbol) {
  if (symbol.empty() || symbol.size() > 2) return -1;
  const char first = upper(symbol[0]);
  const char second = symbol.size() == 2 ? upper(symbol[1]) : '@';  // '@' precedes 'A'
  if (first < 'A' || first > 'Z' || second < '@' || second > 'Z') return -1;
  return (first - 'A') * 27 + (second - '@');
}

std::array<std::uint8_t, 26 * 27> makeSymbolTable() {
  std::array<std::uint8_t, 26 * 27> table{};
  for (int i = 1; i < kElementCount; ++i) {
    table[static_cast<std::size_t>(slotOf(kElements[static_cast<std::size_t>(i)].symbol))] =
        static_cast<std::uint8_t>(i);
  }
  table[static_cast<std::size_t>(slotOf("D"))] = 1;
  table[static_cast<std::size_t>(slotOf("T"))] = 1;
  return table;
}

}  // namespace

std::string_view elementSymbol(std::uint8_t element) {
  return at(element).symbol;
}

std::uint8_t elementFromSymbol(std::string_view symbol) {
  static const std::array<std::uint8_t, 26 * 27> table = makeSymbolTable();
  const int slot = slotOf(symbol);
  return slot < 0 ? std::uint8_t{0} : table[static_cast<std::size_t>(slot)];
}

float vanDerWaalsRadius(std::uint8_t element, RadiusSet set) {
  const float radius = set == RadiusSet::bondi ? at(element).bondi : at(element).alvarez;
  return radius > 0 ? radius : kFallbackVanDerWaals;
}

float covalentRadius(std::uint8_t element) {
  const float radius = at(element).covalent;
  return radius > 0 ? radius : kTransuraniumCovalent;
}

std::uint32_t elementColor(std::uint8_t element) {
  return at(element).color;
}

bool isMetal(std::uint8_t element) {
  const int z = element;
  return (z >= 3 && z <= 4) || (z >= 11 && z <= 13) || (z >= 19 && z <= 31) || (z >= 37 && z <= 50) ||
         (z >= 55 && z <= 84) || (z >= 87 && z <= 116);
}

}  // namespace meniscus

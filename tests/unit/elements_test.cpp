#include "core/elements.h"

#include <gtest/gtest.h>

#include <gemmi/elem.hpp>
#include <string>

namespace meniscus {
namespace {

std::uint8_t of(const char* symbol) {
  return elementFromSymbol(symbol);
}

TEST(Elements, symbolsAgreeWithGemmi) {
  for (int z = 1; z < kElementCount; ++z) {
    const auto element = static_cast<std::uint8_t>(z);
    EXPECT_EQ(elementSymbol(element), gemmi::Element(z).name());
    EXPECT_EQ(elementFromSymbol(gemmi::Element(z).name()), element);
    EXPECT_EQ(elementFromSymbol(gemmi::Element(z).uname()), element);
  }
}

TEST(Elements, isotopesUnknownsAndCase) {
  EXPECT_EQ(of("D"), 1);
  EXPECT_EQ(of("t"), 1);
  EXPECT_EQ(of("fe"), 26);
  for (const char* symbol : {"", "X", "Q", "Xx", "Fex", "1", "C1", " C"}) EXPECT_EQ(of(symbol), 0) << symbol;
  EXPECT_EQ(elementSymbol(0), "X");
  EXPECT_EQ(elementSymbol(200), "X");
}

TEST(Elements, covalentRadiiAgreeWithGemmi) {
  for (int z = 1; z <= 96; ++z) {
    if (z == 6) continue;              // gemmi has the sp2 value
    if (z == 71 || z == 72) continue;  // gemmi swaps Lu (1.87) and Hf (1.75)
    EXPECT_FLOAT_EQ(covalentRadius(static_cast<std::uint8_t>(z)), gemmi::Element(z).covalent_r()) << z;
  }
  EXPECT_FLOAT_EQ(covalentRadius(6), 0.76f);
}

TEST(Elements, vanDerWaalsRadii) {
  for (const char* symbol :
       {"H", "C", "N", "O", "F", "P", "S", "Cl", "Br", "I", "Na", "Mg", "K", "Ca", "Zn", "Cu"}) {
    const gemmi::Element known{std::string(symbol)};
    EXPECT_FLOAT_EQ(vanDerWaalsRadius(of(symbol), RadiusSet::bondi), known.vdw_r()) << symbol;
  }
  EXPECT_FLOAT_EQ(vanDerWaalsRadius(of("C"), RadiusSet::alvarez), 1.77f);
  EXPECT_FLOAT_EQ(vanDerWaalsRadius(of("Fe"), RadiusSet::alvarez), 2.44f);
  EXPECT_FLOAT_EQ(vanDerWaalsRadius(of("Fe"), RadiusSet::bondi), 2.0f);
  EXPECT_FLOAT_EQ(vanDerWaalsRadius(0, RadiusSet::alvarez), 2.0f);
}

TEST(Elements, jmolColors) {
  EXPECT_EQ(elementColor(of("C")), 0x909090u);
  EXPECT_EQ(elementColor(of("O")), 0xFF0D0Du);
  EXPECT_EQ(elementColor(of("Fe")), 0xE06633u);
  EXPECT_EQ(elementColor(of("I")), 0x940094u);
}

TEST(Elements, metalsAgreeWithGemmiButForMetalloids) {
  for (int z = 1; z < kElementCount; ++z) {
    if (z == 32 || z == 51 || z == 52) continue;  // Ge, Sb, Te
    EXPECT_EQ(isMetal(static_cast<std::uint8_t>(z)), gemmi::Element(z).is_metal()) << z;
  }
}

}  // namespace
}  // namespace meniscus

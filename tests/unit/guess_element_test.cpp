#include "io/guess_element.h"

#include <gtest/gtest.h>

#include "core/elements.h"

namespace meniscus {
namespace {

std::string_view guess(std::string_view field, std::string_view residue) {
  return elementSymbol(guessElement(field, residue));
}

TEST(GuessElement, alignmentTellsCarbonFromCalcium) {
  EXPECT_EQ(guess(" CA ", "LIG"), "C");
  EXPECT_EQ(guess("CA  ", "LIG"), "Ca");
  EXPECT_EQ(guess(" CA ", "CA"), "Ca");
  EXPECT_EQ(guess("CA  ", "ALA"), "C");
}

TEST(GuessElement, hydrogens) {
  EXPECT_EQ(guess("HG11", "VAL"), "H");
  EXPECT_EQ(guess("HG  ", "SER"), "H");
  EXPECT_EQ(guess("1HB2", "LIG"), "H");
  EXPECT_EQ(guess("HO5'", "LIG"), "H");
  EXPECT_EQ(guess("HG  ", "HG"), "Hg");
}

TEST(GuessElement, ligandsAndIons) {
  EXPECT_EQ(guess("FE  ", "HEM"), "Fe");
  EXPECT_EQ(guess(" NA ", "HEM"), "N");
  EXPECT_EQ(guess("NA  ", "NA"), "Na");
  EXPECT_EQ(guess("CL1 ", "LIG"), "Cl");
  EXPECT_EQ(guess("BR  ", "BR"), "Br");
  EXPECT_EQ(guess("SE  ", "MSE"), "Se");
  EXPECT_EQ(guess("C10A", "LIG"), "C");
  EXPECT_EQ(guess(" ZN ", "ZN"), "Zn");
  EXPECT_EQ(guess(" Q1 ", "LIG"), "X");
  EXPECT_EQ(guess("    ", "LIG"), "X");
}

}  // namespace
}  // namespace meniscus

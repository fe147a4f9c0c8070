// One small file per habit of the programs and decades that write structures.
#include "io/structure_reader.h"

#include <gtest/gtest.h>

#include <string>

#include "core/structure_counts.h"
#include "tests/unit/structure_files.h"

namespace meniscus {
namespace {

using test::Read;
using test::readData;

/// The two glycines that most files of the folder hold.
void expectTwoGlycines(const Read& read) {
  const Molecule& m = read.molecule();
  ASSERT_EQ(m.atomCount(), 8u);
  ASSERT_EQ(m.residues.size(), 2u);
  EXPECT_EQ(m.residues[1].name, "GLY");
  EXPECT_EQ(m.residues[1].kind, ResidueKind::aminoAcid);
  EXPECT_EQ(m.names[5].view(), "CA");
  EXPECT_EQ(m.elements[5], 6);
  EXPECT_DOUBLE_EQ(m.positions[5].x, 4.6);
  EXPECT_DOUBLE_EQ(m.positions[7].y, -1.2);
}

class TwoGlycines : public ::testing::TestWithParam<const char*> {};
TEST_P(TwoGlycines, areRead) {
  expectTwoGlycines(readData(GetParam()));
}
INSTANTIATE_TEST_SUITE_P(Habits, TwoGlycines,
                         ::testing::Values("plain.pdb", "crlf.pdb", "cr_only.pdb", "byte_order_mark.pdb",
                                           "no_end_no_ter.pdb", "line_numbers.pdb", "short_lines.pdb",
                                           "six_digit_serials.pdb", "blank_residue_numbers.pdb",
                                           "lower_case.pdb", "anisou.pdb", "esmfold.pdb", "assembly.pdb"));

TEST(PdbHabits, plainFileHasNoNotes) {
  const Read read = readData("plain.pdb");
  EXPECT_TRUE(read.logger.notes().empty());
  EXPECT_EQ(read.molecule().name, "1TST");
  EXPECT_EQ(read.file.modelCount, 1);
  EXPECT_FLOAT_EQ(read.molecule().bFactors[0], 10.0f);
}

TEST(PdbHabits, lineEndsAndByteOrderMarkAreNoted) {
  EXPECT_TRUE(readData("crlf.pdb").hasNote("CR LF"));
  EXPECT_TRUE(readData("cr_only.pdb").hasNote("lines end with CR"));
  EXPECT_TRUE(readData("byte_order_mark.pdb").hasNote("byte order mark"));
}

TEST(PdbHabits, entryIdsAndLineNumbersAreNoElements) {
  const Read read = readData("line_numbers.pdb");
  EXPECT_TRUE(read.hasNote("line 1 and 7 more: columns 73-80"));
  EXPECT_EQ(read.molecule().elements[3], 8);
}

TEST(PdbHabits, elementsAreGuessedFromAlignedNames) {
  const Read read = readData("no_elements.pdb");
  const Molecule& m = read.molecule();
  ASSERT_EQ(m.atomCount(), 15u);
  const int expected[] = {7, 6, 6, 8, 7, 6, 6, 8, 20, 6, 1, 1, 26, 6, 30};
  for (std::size_t i = 0; i < 15; ++i) EXPECT_EQ(int{m.elements[i]}, expected[i]) << m.names[i].view();
  EXPECT_TRUE(read.hasNote("no element"));
}

TEST(PdbHabits, shortLinesGetOccupancyOne) {
  const Read read = readData("short_lines.pdb");
  EXPECT_FLOAT_EQ(read.molecule().occupancies[0], 1.0f);
  EXPECT_FLOAT_EQ(read.molecule().bFactors[0], 0.0f);
  EXPECT_TRUE(read.hasNote("no occupancy"));
}

TEST(PdbHabits, hybrid36SerialsAndResidueNumbers) {
  const Read read = readData("hybrid36.pdb");
  const Molecule& m = read.molecule();
  EXPECT_EQ(m.serials[1], 99999);
  EXPECT_EQ(m.serials[2], 100000);
  EXPECT_EQ(m.residues[1].number, 10000);
  ASSERT_EQ(m.bonds.size(), 1u);
  EXPECT_EQ(m.bonds[0].a, 3u);
  EXPECT_EQ(m.bonds[0].b, 7u);
  EXPECT_EQ(m.bonds[0].origin, BondOrigin::conect);
}

TEST(PdbHabits, starSerials) {
  const Read read = readData("star_serials.pdb");
  EXPECT_EQ(read.molecule().atomCount(), 4u);
  EXPECT_TRUE(read.molecule().bonds.empty());
  EXPECT_TRUE(read.hasNote("line 3 and 1 more: serial number that cannot be read"));
  EXPECT_TRUE(read.hasNote("CONECT"));
}

TEST(PdbHabits, serialsOfSixDigits) {
  EXPECT_EQ(readData("six_digit_serials.pdb").molecule().serials[7], 100006);
}

TEST(PdbHabits, repeatedModelNumbersAreRenumbered) {
  StructureOptions all;
  all.allModels = true;
  const Read read = readData("repeated_models.pdb", all);
  ASSERT_EQ(read.file.models.size(), 3u);
  EXPECT_EQ(read.file.models[2].model, 3);
  EXPECT_DOUBLE_EQ(read.file.models[2].positions[0].x, 20.0);
  EXPECT_TRUE(read.hasNote("model numbers repeat"));
}

TEST(PdbHabits, modelsWithoutEnd) {
  EXPECT_EQ(readData("model_without_endmdl.pdb").file.modelCount, 2);
  const Read read = readData("end_between_models.pdb");
  EXPECT_EQ(read.file.modelCount, 2);
  EXPECT_TRUE(read.hasNote("atoms after END"));
}

TEST(PdbHabits, chainIds) {
  EXPECT_EQ(readData("blank_chain.pdb").molecule().chains.at(0).name, "");
  EXPECT_EQ(readData("two_letter_chain.pdb").molecule().chains.at(0).name, "AB");
}

TEST(PdbHabits, lowerCaseRecordsAreRaisedButNotChains) {
  const Read read = readData("lower_case.pdb");
  EXPECT_EQ(read.molecule().chains[0].name, "A");
  EXPECT_TRUE(read.hasNote("lower case"));
}

TEST(PdbHabits, deuteriumIsHydrogenAndUnknownStaysUnknown) {
  const Read read = readData("deuterium.pdb");
  const Molecule& m = read.molecule();
  EXPECT_EQ(m.elements[1], 1);
  EXPECT_EQ(m.elements[3], 0);
  EXPECT_EQ(m.elements[4], 0);
  EXPECT_EQ(m.residues[0].kind, ResidueKind::water);
  EXPECT_TRUE(read.hasNote("unknown element"));
}

TEST(PdbHabits, recurringChainsAndResiduesBecomeContiguous) {
  const Read read = readData("recurring_chain.pdb");
  const Molecule& m = read.molecule();
  ASSERT_EQ(m.chains.size(), 2u);
  ASSERT_EQ(m.residues.size(), 5u);
  EXPECT_EQ(m.chains[0].residues, (IndexRange{0, 3}));
  EXPECT_EQ(m.residues[0].atoms, (IndexRange{0, 4}));
  EXPECT_EQ(m.residues[2].name, "HOH");
  for (std::uint32_t r = 0; r < m.residues.size(); ++r) {
    for (std::uint32_t i = m.residues[r].atoms.first; i < m.residues[r].atoms.end(); ++i)
      EXPECT_EQ(m.residueOf[i], r);
  }
  EXPECT_TRUE(read.hasNote("put together"));
}

TEST(PdbHabits, wrappedResidueNumbersStaySeparate) {
  const Read read = readData("wrapped_residue_numbers.pdb");
  EXPECT_EQ(read.molecule().residues.size(), 5u);
  EXPECT_EQ(countStructure(read.molecule()).residues, 4u);
  EXPECT_TRUE(read.hasNote("used again"));
}

TEST(PdbHabits, fourLetterResidueNames) {
  const Read read = readData("four_letter_residue.pdb");
  EXPECT_EQ(read.molecule().residues.at(0).name, "TIP3");
  EXPECT_EQ(read.molecule().residues[0].kind, ResidueKind::water);
}

TEST(PdbRecords, anisotropyFollowsItsAtom) {
  const Read read = readData("anisou.pdb");
  ASSERT_EQ(read.molecule().anisotropies.size(), 8u);
  EXPECT_FLOAT_EQ(read.molecule().anisotropies[0].u11, 0.01f);
  EXPECT_FLOAT_EQ(read.molecule().anisotropies[0].u23, 0.003f);
  EXPECT_TRUE(read.molecule().anisotropies[1].isZero());
  EXPECT_TRUE(read.hasNote("line 3 and 1 more: ANISOU"));
}

TEST(PdbRecords, conectNamedTwiceIsADoubleBond) {
  const Read read = readData("conect_double.pdb");
  const Molecule& m = read.molecule();
  ASSERT_EQ(m.bonds.size(), 3u);  // 1=2, 1-3, 2=1; merged by addMissingBonds()
  EXPECT_EQ(m.bonds[0].order, 2);
  EXPECT_EQ(m.bonds[1].order, 1);
  EXPECT_TRUE(read.hasNote("not there"));
}

TEST(PdbRecords, conectAppliesToEveryModel) {
  StructureOptions all;
  all.allModels = true;
  const Read read = readData("models.pdb", all);
  for (const Molecule& m : read.file.models) EXPECT_EQ(m.bonds.size(), 1u);
}

TEST(PdbRecords, linkAndSsbondWithoutSymmetryMates) {
  const Read read = readData("link_ssbond.pdb");
  ASSERT_EQ(read.molecule().bonds.size(), 2u);
  for (const Bond& bond : read.molecule().bonds) EXPECT_EQ(bond.origin, BondOrigin::connection);
  EXPECT_TRUE(read.hasNote("names an atom that is not there"));
}

TEST(PdbRecords, assemblyWithAnUnknownChainIsANote) {
  const Read read = readData("assembly.pdb");
  const Molecule& m = read.molecule();
  ASSERT_EQ(m.assemblies.size(), 1u);
  EXPECT_EQ(m.assemblies[0].id, "1");
  ASSERT_EQ(m.assemblies[0].generators.at(0).operations.size(), 2u);
  EXPECT_EQ(m.assemblies[0].generators[0].operations[1] * glm::dvec4(1, 2, 3, 1), glm::dvec4(49, -2, 3, 1));
  EXPECT_TRUE(read.hasNote("names a chain that is not there"));
}

TEST(Predicted, fractionsAreScaledAndExperimentsAreNotPredictions) {
  const Read esm = readData("esmfold.pdb");
  EXPECT_TRUE(esm.molecule().predicted);
  EXPECT_FLOAT_EQ(esm.molecule().bFactors[0], 87.0f);
  EXPECT_TRUE(esm.hasNote("scaled"));
  EXPECT_FALSE(readData("experiment_with_alphafold.pdb").molecule().predicted);
  EXPECT_TRUE(readData("predicted.cif").molecule().predicted);
  EXPECT_FALSE(readData("plain.cif").molecule().predicted);
}

class GlycineAndWaters : public ::testing::TestWithParam<const char*> {};
TEST_P(GlycineAndWaters, areRead) {
  const Read read = readData(GetParam());
  const Molecule& m = read.molecule();
  ASSERT_EQ(m.atomCount(), 6u);
  EXPECT_EQ(m.names[1].view(), "CA");
  EXPECT_EQ(m.residues.at(0).name, "GLY");
  EXPECT_EQ(m.residues.size(), 3u);
  EXPECT_DOUBLE_EQ(m.positions[3].y, -1.2);
  EXPECT_EQ(m.elements[4], 8);
}
INSTANTIATE_TEST_SUITE_P(Habits, GlycineAndWaters,
                         ::testing::Values("plain.cif", "crlf.cif", "cr_only.cif", "label_only.cif",
                                           "auth_only.cif", "few_columns.cif", "quoted_numbers.cif",
                                           "insertion_in_number.cif", "long_chain_id.cif", "shifted.cif",
                                           "assembly.cif", "predicted.cif"));

TEST(MmcifHabits, authorIdsNameChainsAndResidues) {
  const Read read = readData("plain.cif");
  EXPECT_TRUE(read.logger.notes().empty());
  ASSERT_EQ(read.molecule().chains.size(), 1u);
  EXPECT_EQ(read.molecule().chains[0].name, "A");
  EXPECT_EQ(read.molecule().residues[0].number, 11);
  EXPECT_EQ(read.molecule().residues[2].number, 202);
  EXPECT_TRUE(read.molecule().residues[2].hetero);
}

TEST(MmcifHabits, onlyLabelOrOnlyAuthorColumns) {
  const Read label = readData("label_only.cif");
  EXPECT_EQ(label.molecule().chains.size(), 2u);
  EXPECT_TRUE(label.hasNote("no auth_asym_id"));
  const Read author = readData("auth_only.cif");
  EXPECT_EQ(author.molecule().chains.size(), 1u);
  EXPECT_TRUE(author.hasNote("no label_asym_id"));
}

TEST(MmcifHabits, insertionCodeWithinTheNumber) {
  const Read read = readData("insertion_in_number.cif");
  EXPECT_EQ(read.molecule().residues[0].number, 15);
  EXPECT_EQ(read.molecule().residues[0].insertionCode, 'A');
}

TEST(MmcifHabits, longChainIds) {
  EXPECT_EQ(readData("long_chain_id.cif").molecule().chains[0].name, "LongChain");
}

TEST(MmcifHabits, atomOutsideALoop) {
  EXPECT_EQ(readData("single_atom.cif").molecule().atomCount(), 1u);
}

TEST(MmcifHabits, positionsFarFromTheOriginKeepTheirDigits) {
  EXPECT_DOUBLE_EQ(readData("shifted.cif").molecule().positions[1].x, 1000001.2);
}

TEST(MmcifRecords, connections) {
  const Molecule m = readData("connections.cif").molecule();
  ASSERT_EQ(m.bonds.size(), 1u);
  EXPECT_EQ(m.bonds[0].a, 3u);
  EXPECT_EQ(m.bonds[0].b, 4u);
  EXPECT_EQ(m.bonds[0].order, 2);
}

TEST(MmcifRecords, assembliesExpandProductsAndNamedOperators) {
  const Read read = readData("assembly.cif");
  const Molecule& m = read.molecule();
  ASSERT_EQ(m.assemblies.size(), 2u);
  EXPECT_EQ(m.assemblies[0].id, "1");
  const Assembly::Generator& generator = m.assemblies[0].generators.at(0);
  ASSERT_EQ(generator.operations.size(), 4u);
  EXPECT_EQ(generator.residues, (std::vector<IndexRange>{{0, 3}}));
  // 2 after X0: (1, 0, 0) -> (1, 50, 0) -> (-50, 1, 0)
  EXPECT_EQ(generator.operations[2] * glm::dvec4(1, 0, 0, 1), glm::dvec4(-50, 1, 0, 1));
  EXPECT_EQ(m.assemblies[1].id, "PAU");
  EXPECT_TRUE(read.hasNote("cannot be expanded"));
  EXPECT_TRUE(read.hasNote("chain that is not there"));
}

TEST(Components, fallBackToTheExamplePositionsAndKeepOrders) {
  const Read read = readData("component.cif");
  const Molecule& m = read.molecule();
  ASSERT_EQ(m.atomCount(), 3u);
  EXPECT_DOUBLE_EQ(m.positions[0].z, 3.0);
  ASSERT_EQ(m.bonds.size(), 2u);
  EXPECT_EQ(m.bonds[0].order, 2);
  EXPECT_EQ(m.bonds[0].origin, BondOrigin::connection);
  EXPECT_TRUE(read.hasNote("ideal"));
}

}  // namespace
}  // namespace meniscus

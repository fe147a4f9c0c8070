#include <gtest/gtest.h>

#include "core/error.h"
#include "core/structure_counts.h"
#include "tests/support/paths.h"
#include "tests/unit/structure_files.h"

namespace meniscus {
namespace {

using test::readData;

TEST(ModelChoice, byNumberFirstOrAll) {
  StructureOptions options;
  EXPECT_EQ(readData("models.pdb").molecule().model, 3);
  options.model = 5;
  EXPECT_DOUBLE_EQ(readData("models.pdb", options).molecule().positions[0].x, 10.0);
  EXPECT_EQ(readData("models.pdb", options).file.modelCount, 3);
  options.model = 4;
  EXPECT_THROW(readData("models.pdb", options), UsageError);
  EXPECT_EQ(readData("models.cif", options).molecule().model, 4);
  options = {};
  options.allModels = true;
  EXPECT_EQ(readData("models.pdb", options).file.models.size(), 3u);
  EXPECT_EQ(readData("models.cif", options).file.models.size(), 2u);
}

TEST(AltlocChoice, firstKeepsOneResidueNameAtAPlace) {
  StructureOptions options;
  options.altlocs = Altlocs::first;
  const Molecule m = readData("altlocs.pdb", options).molecule();
  EXPECT_EQ(m.atomCount(), 6u);
  ASSERT_EQ(m.residues.size(), 3u);
  EXPECT_EQ(m.residues[1].name, "PRO");
  EXPECT_EQ(m.altlocs[5], 'C');
}

TEST(AltlocChoice, allAndNamed) {
  StructureOptions options;
  EXPECT_EQ(readData("altlocs.pdb").molecule().atomCount(), 10u);
  EXPECT_EQ(countStructure(readData("altlocs.pdb").molecule()).residues, 3u);
  options.altlocs = Altlocs::named;
  options.altloc = 'B';
  const Molecule m = readData("altlocs.pdb", options).molecule();
  EXPECT_EQ(m.atomCount(), 5u);
  EXPECT_EQ(m.residues[1].name, "SER");
  options.altloc = 'Z';
  EXPECT_EQ(readData("altlocs.pdb", options).molecule().atomCount(), 1u);
}

TEST(HydrogensAndWaters, onAndOff) {
  StructureOptions options;
  options.hydrogens = false;
  EXPECT_EQ(readData("deuterium.pdb", options).molecule().atomCount(), 3u);
  options = {};
  options.waters = Waters::off;
  EXPECT_EQ(readData("plain.cif", options).molecule().atomCount(), 4u);
  options.waters = Waters::automatic;
  EXPECT_EQ(readData("plain.cif", options).molecule().atomCount(), 4u);
  EXPECT_EQ(readData("wrapped_residue_numbers.pdb", options).molecule().atomCount(), 5u);
  options.waters = Waters::off;
  EXPECT_THROW(readData("wrapped_residue_numbers.pdb", options), InputError);
}

TEST(Selection, gemmiSyntax) {
  const Molecule m = readData("altlocs.pdb").molecule();
  EXPECT_EQ(selectAtoms(m, "").size(), 10u);
  EXPECT_EQ(selectAtoms(m, "//A/1-2").size(), 9u);
  EXPECT_EQ(selectAtoms(m, "//B").size(), 0u);
  EXPECT_EQ(selectAtoms(m, "(SER)").size(), 7u);
  EXPECT_EQ(selectAtoms(m, "CA[C]").size(), 5u);
  EXPECT_EQ(selectAtoms(m, "CA:B"), (std::vector<std::uint32_t>{2, 7}));
  EXPECT_EQ(selectAtoms(m, "/2").size(), 0u);
  EXPECT_EQ(selectAtoms(m, ";q<0.5").size(), 1u);
  EXPECT_THROW(selectAtoms(m, "//A/x-y/["), UsageError);
}

TEST(Selection, aNumberAloneIsThatResidue) {
  const Molecule ubiquitin = test::readFile(test::projectFile("molecules/1ubq.pdb")).molecule();
  EXPECT_EQ(selectAtoms(ubiquitin, "//A/48").size(), 9u);
  EXPECT_EQ(selectAtoms(ubiquitin, "//A/48/CA").size(), 1u);
  EXPECT_EQ(selectAtoms(ubiquitin, "//A/48-48").size(), 9u);
  EXPECT_EQ(selectAtoms(ubiquitin, "//A/70-/CA").size(), 7u);
  EXPECT_EQ(selectAtoms(ubiquitin, "//A/70-*/CA").size(), 7u);
  EXPECT_EQ(selectAtoms(ubiquitin, "//A/-3/CA").size(), 3u);
}

TEST(Selection, keepsBondsAndAssembliesConsistent) {
  StructureOptions options;
  options.select = "//A/2";
  const Molecule m = readData("assembly.pdb", options).molecule();
  EXPECT_EQ(m.atomCount(), 4u);
  ASSERT_EQ(m.residues.size(), 1u);
  EXPECT_EQ(m.residueOf, (std::vector<std::uint32_t>{0, 0, 0, 0}));
  EXPECT_EQ(m.assemblies.at(0).generators.at(0).residues, (std::vector<IndexRange>{{0, 1}}));
  options.select = "/*/*/*/C2,O1";
  const Molecule ligand = readData("conect_double.pdb", options).molecule();
  EXPECT_EQ(ligand.atomCount(), 2u);
  EXPECT_TRUE(ligand.bonds.empty());
}

TEST(Selection, thatLeavesNothingIsAnInputError) {
  StructureOptions options;
  options.select = "//Z";
  EXPECT_THROW(readData("plain.pdb", options), InputError);
}

TEST(Counts, ligandsAreNeitherPolymerNorWater) {
  const StructureCounts counts = countStructure(readData("no_elements.pdb").molecule());
  EXPECT_EQ(counts.residues, 8u);
  EXPECT_EQ(counts.chains, 1u);
  const std::vector<LigandCount> expected{{"CA", 1}, {"HEM", 1}, {"LIG", 1}, {"ZN", 1}};
  EXPECT_EQ(counts.ligands, expected);
}

}  // namespace
}  // namespace meniscus

// The structures of molecules/ against an outside opinion: gemmi's own command line program (Debian package
// gemmi), which lists the atoms of every residue.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <memory>
#include <set>
#include <sstream>
#include <string>

#include "core/bonds.h"
#include "core/structure_counts.h"
#include "tests/support/paths.h"
#include "tests/unit/structure_files.h"

namespace meniscus {
namespace {

std::string outputOf(const std::string& command) {
  std::unique_ptr<FILE, int (*)(FILE*)> pipe(::popen(command.c_str(), "r"), &::pclose);
  std::string output;
  std::array<char, 4096> buffer;
  while (pipe) {
    const std::size_t got = std::fread(buffer.data(), 1, buffer.size(), pipe.get());
    if (got == 0) break;
    output.append(buffer.data(), got);
  }
  return output;
}

struct Tally {
  std::size_t atoms = 0, residues = 0, chains = 0, models = 0;
};

/// "A   15A VAL  N CA:A,B C": chain, number with insertion code, name, then atoms with their alternate
/// locations.
Tally tally(const std::string& listing) {
  Tally sum;
  std::set<std::string> residues, chains;
  std::istringstream lines(listing);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("Model ", 0) == 0) ++sum.models;
    const std::size_t chainEnd = line.find(' ');
    const std::size_t numberStart =
        line.find_first_not_of(' ', chainEnd == std::string::npos ? line.size() : chainEnd);
    if (numberStart == std::string::npos || line.rfind("Model ", 0) == 0 || sum.models > 1) continue;
    const std::size_t numberEnd = line.find_first_not_of("-0123456789", numberStart);
    if (numberEnd == std::string::npos || numberEnd == numberStart) continue;
    residues.insert(line.substr(0, numberEnd + 1));
    chains.insert(line.substr(0, chainEnd));
    const std::size_t nameEnd =
        line.find("  ", numberEnd + 2);  // after insertion code, blank and residue name
    if (nameEnd == std::string::npos) continue;
    std::istringstream names(line.substr(nameEnd));
    for (std::string name; names >> name;) {
      ++sum.atoms;
      for (const char c : name) sum.atoms += c == ',' ? 1 : 0;
    }
  }
  sum.models = std::max<std::size_t>(sum.models, 1);
  sum.residues = residues.size();
  sum.chains = chains.size();
  return sum;
}

std::vector<std::string> moleculeFiles() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(test::projectFile("molecules"))) {
    if (entry.path().extension() != ".md") files.push_back(entry.path().filename().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

class MoleculeFile : public ::testing::TestWithParam<std::string> {};

TEST_P(MoleculeFile, holdsWhatGemmiCounts) {
  const std::filesystem::path path = test::projectFile("molecules/" + GetParam());
  const test::Read read = test::readFile(path);
  const StructureCounts counts = countStructure(read.molecule());
  // gemmi refuses entry ids and line numbers in columns 73-80 (2hhb): it gets PDB text without them. Its
  // listing separates names by blanks, so that 2hhb's " N A" must lose its own.
  const bool pdb = path.string().find(".pdb") != std::string::npos;
  const std::string text = "zcat -f '" + path.string() + "'" +
                           (pdb ? " | cut -c 1-72 | sed -E 's/^(.{12} N) ([A-D])/\\1\\2 /'" : "");
  const std::string listing = outputOf(text + " | gemmi residues --format=" + (pdb ? "pdb" : "cif") + " -");
  ASSERT_FALSE(listing.empty()) << "gemmi (Debian package gemmi) is missing or fails";
  const Tally expected = tally(listing);
  EXPECT_EQ(counts.atoms, expected.atoms);
  EXPECT_EQ(counts.residues, expected.residues);
  EXPECT_EQ(counts.chains, expected.chains);
  EXPECT_EQ(static_cast<std::size_t>(read.file.modelCount), expected.models);
}

TEST_P(MoleculeFile, isConsistent) {
  test::Read read = test::readFile(test::projectFile("molecules/" + GetParam()));
  Molecule& m = read.file.models[0];
  addMissingBonds(m, read.logger);
  std::uint32_t atom = 0;
  std::uint32_t residue = 0;
  for (std::uint32_t c = 0; c < m.chains.size(); ++c) {
    ASSERT_EQ(m.chains[c].residues.first, residue);
    for (; residue < m.chains[c].residues.end(); ++residue) {
      ASSERT_EQ(m.residues[residue].chain, c);
      ASSERT_EQ(m.residues[residue].atoms.first, atom);
      for (; atom < m.residues[residue].atoms.end(); ++atom) ASSERT_EQ(m.residueOf[atom], residue);
    }
  }
  EXPECT_EQ(atom, m.atomCount());
  EXPECT_EQ(residue, m.residues.size());
  // Nearly every heavy atom that is no water or ion is bonded.
  std::vector<std::uint8_t> bonded(m.atomCount(), 0);
  for (const Bond& bond : m.bonds) bonded[bond.a] = bonded[bond.b] = 1;
  std::size_t loose = 0;
  for (std::size_t i = 0; i < m.atomCount(); ++i) {
    const ResidueKind kind = m.residues[m.residueOf[i]].kind;
    if (!bonded[i] && kind != ResidueKind::water && kind != ResidueKind::ion) ++loose;
  }
  EXPECT_LE(loose, m.atomCount() / 100);
}

std::string testName(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, MoleculeFile, ::testing::ValuesIn(moleculeFiles()), testName);

TEST(MoleculeFiles, pdbAndMmcifOfOneEntryAgree) {
  const std::filesystem::path folder = test::projectFile("molecules");
  const Molecule a = test::readFile(folder / "1a8o.pdb.gz").molecule();
  const Molecule b = test::readFile(folder / "1a8o.cif.gz").molecule();
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.elements, b.elements);
  EXPECT_EQ(a.assemblies.at(0).generators.at(0).operations.size(),
            b.assemblies.at(0).generators.at(0).operations.size());
}

}  // namespace
}  // namespace meniscus

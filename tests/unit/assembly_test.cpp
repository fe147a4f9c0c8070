#include "core/assembly.h"

#include <gtest/gtest.h>

#include <glm/ext/matrix_transform.hpp>

#include "core/error.h"
#include "io/assembly_records.h"

namespace meniscus {
namespace {

Molecule twoAtoms() {
  Molecule m;
  m.positions = {{0, 0, 0}, {10, 0, 0}};
  m.residueOf = {0, 1};
  m.residues.resize(2);
  m.residues[0].atoms = {0, 1};
  m.residues[1].atoms = {1, 1};
  Assembly assembly{"1", {}};
  assembly.generators.push_back(
      {{{0, 2}}, {glm::dmat4(1.0), glm::translate(glm::dmat4(1.0), {0.0, 5.0, 0.0})}});
  assembly.generators.push_back({{{1, 1}}, {glm::dmat4(1.0)}});
  m.assemblies = {assembly};
  return m;
}

TEST(Assembly, everyOperatorOfEveryGeneratorIsPlaced) {
  const Molecule m = twoAtoms();
  EXPECT_EQ(placeOnce(m).at(0).residues, (std::vector<IndexRange>{{0, 2}}));
  const std::vector<Placement> placed = placeAssembly(m, "1");
  ASSERT_EQ(placed.size(), 3u);
  EXPECT_EQ(placed[1].transform[3].y, 5.0);
  EXPECT_EQ(placed[2].residues, (std::vector<IndexRange>{{1, 1}}));
}

TEST(Assembly, unknownIdsListTheKnownOnes) {
  try {
    placeAssembly(twoAtoms(), "7");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("choose one of 1"), std::string::npos);
  }
  EXPECT_THROW(placeAssembly(Molecule{}, "1"), UsageError);
}

TEST(Lattice, isCentredAndSpacedByTheExtent) {
  const Molecule m = twoAtoms();
  const std::vector<Placement> lattice = replicate(m, placeOnce(m), {3, 1, 2});
  ASSERT_EQ(lattice.size(), 6u);
  EXPECT_DOUBLE_EQ(lattice[0].transform[3].x, -14.0);
  EXPECT_DOUBLE_EQ(lattice[1].transform[3].x, 0.0);
  EXPECT_DOUBLE_EQ(lattice[2].transform[3].x, 14.0);
  EXPECT_DOUBLE_EQ(lattice[0].transform[3].z, -2.0);
  EXPECT_THROW(replicate(m, placeOnce(m), {0, 1, 1}), UsageError);
  EXPECT_THROW(replicate(m, placeOnce(m), {100000, 100000, 100000}), UsageError);
}

TEST(OperatorExpression, listsRangesProductsAndNames) {
  std::map<std::string, glm::dmat4> operators;
  for (int i = 1; i <= 88; ++i)
    operators[std::to_string(i)] = glm::translate(glm::dmat4(1.0), {double(i), 0.0, 0.0});
  operators["P"] = operators["X0"] = glm::dmat4(1.0);
  const auto count = [&operators](const char* expression) {
    const auto expanded = expandOperations(expression, operators);
    return expanded ? static_cast<int>(expanded->size()) : -1;
  };
  EXPECT_EQ(count("1"), 1);
  EXPECT_EQ(count("P"), 1);
  EXPECT_EQ(count("1,2,5"), 3);
  EXPECT_EQ(count("(1-60)"), 60);
  EXPECT_EQ(count("(1-60)(61-88)"), 1680);
  EXPECT_EQ(count("(X0)(1,2,6-10)"), 7);
  for (const char* bad : {"", "()", "(1", "1)", "Q", "1-99", "(1-60)(1-60)(1-60)(1-60)"})
    EXPECT_EQ(count(bad), -1) << bad;
}

}  // namespace
}  // namespace meniscus

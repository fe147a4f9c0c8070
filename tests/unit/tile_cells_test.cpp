// Cells of a tile that discs cover: all that lie in the disc and no other, by every instruction set.

#include "core/tiles/tile_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/tiles/instruction_sets.h"
#include "tests/support/random.h"

namespace meniscus::tiles {
namespace {

// How far a disc's edge is from the farthest corner of a cell; negative: the cell is not all in the disc.
double spare(int column, int row, double x, double y, double radius) {
  double farthest = 0;
  for (const int dx : {0, 1}) {
    for (const int dy : {0, 1})
      farthest = std::max(farthest, std::hypot((column + dx) * 0.25 - x, (row + dy) * 0.25 - y));
  }
  return radius - farthest;
}

bool covered(const TileCells& cells, int column, int row) {
  return (cells[static_cast<std::size_t>(row)] >> column & 1) != 0;
}

class Cells : public testing::Test {
 protected:
  void TearDown() override { useInstructionSet(""); }
};

TEST_F(Cells, AreThoseInTheDisc) {
  test::Random random(11);
  std::size_t some = 0;
  for (int i = 0; i < 400; ++i) {
    const auto x = static_cast<float>(random.uniform(-6, 14)), y = static_cast<float>(random.uniform(-6, 14)),
               radius = static_cast<float>(random.logUniform(0.1, 20));
    TileCells first{};
    for (const std::string& set : instructionSets()) {
      SCOPED_TRACE(set);
      useInstructionSet(set);
      TileCells cells{};
      const bool added = coverCells(cells, x, y, radius);
      EXPECT_EQ(added, cells != TileCells{});
      EXPECT_FALSE(coverCells(cells, x, y, radius)) << "the same disc covers nothing new";
      for (int row = 0; row < kTileCells; ++row) {
        for (int column = 0; column < kTileCells; ++column) {
          const double in =
              spare(column, row, static_cast<double>(x), static_cast<double>(y), static_cast<double>(radius));
          if (std::abs(in) > 1e-4) {
            ASSERT_EQ(covered(cells, column, row), in > 0)
                << x << ", " << y << ", " << radius << ": " << column << ", " << row;
          }
        }
      }
      if (set == instructionSets().front()) first = cells;
      EXPECT_EQ(cells, first);
    }
    if (first != TileCells{} && !allCovered(first)) ++some;
  }
  EXPECT_GT(some, 50u);
}

TEST_F(Cells, GoOnBeingCovered) {
  for (const std::string& set : instructionSets()) {
    useInstructionSet(set);
    TileCells cells{};
    EXPECT_FALSE(coverCells(cells, 4, 4, kLeastDisc))
        << "half a cell's diagonal, and no cell around the middle";
    EXPECT_TRUE(coverCells(cells, -1000, 4, 1004));
    EXPECT_FALSE(allCovered(cells));
    EXPECT_TRUE(coverCells(cells, 1008, 4, 1004.5f));
    EXPECT_TRUE(allCovered(cells));
    // Far away, on any side.
    TileCells none{};
    for (const float far : {-1e9f, 1e9f, -3e38f, 3e38f}) {
      EXPECT_FALSE(coverCells(none, far, 4, 1));
      EXPECT_FALSE(coverCells(none, 4, far, 1));
    }
    EXPECT_EQ(none, TileCells{});
    EXPECT_TRUE(coverCells(none, 4, 4, 1e18f));
    EXPECT_TRUE(allCovered(none));
  }
}

}  // namespace
}  // namespace meniscus::tiles

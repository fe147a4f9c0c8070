#include "app/output_name.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace meniscus {
namespace {

template <typename Action>
std::string usageErrorOf(Action action) {
  try {
    action();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no error";
}

TEST(StemOf, dropsFolderExtensionAndGz) {
  EXPECT_EQ(stemOf("folder/1crn.pdb"), "1crn");
  EXPECT_EQ(stemOf("1crn.cif.gz"), "1crn");
  EXPECT_EQ(stemOf("a.b.pdb"), "a.b");
  EXPECT_EQ(stemOf("1crn"), "1crn");
  EXPECT_EQ(stemOf("1crn.gz"), "1crn");
}

TEST(OutputPattern, fillsInStemAndModel) {
  const OutputPattern pattern("out/{stem}-{model}.png");
  EXPECT_TRUE(pattern.namesStem());
  EXPECT_TRUE(pattern.namesModel());
  EXPECT_EQ(pattern.nameFor("x/1l2y.pdb.gz", {38, "", 0}), "out/1l2y-38.png");
  EXPECT_EQ(OutputPattern("{model}/{stem}{stem}.png").nameFor("a.pdb", {-2, "", 0}), "-2/aa.png");
}

TEST(OutputPattern, takesPlainNamesAndDoubledBraces) {
  const OutputPattern plain("a.png");
  EXPECT_FALSE(plain.namesStem());
  EXPECT_FALSE(plain.namesModel());
  EXPECT_EQ(plain.nameFor("b.pdb", {}), "a.png");
  const OutputPattern braces("{{stem}}}.png");
  EXPECT_FALSE(braces.namesStem());
  EXPECT_EQ(braces.nameFor("b.pdb", {}), "{stem}}.png");
}

TEST(OutputPattern, refusesUnknownPlaceholders) {
  EXPECT_NE(usageErrorOf([] { OutputPattern("{name}.png"); }).find("{stem}, {model}, {state} and {frame}"),
            std::string::npos);
  EXPECT_NE(usageErrorOf([] { OutputPattern("{}.png"); }).find("{}"), std::string::npos);
  EXPECT_NE(usageErrorOf([] { OutputPattern("{stem.png"); }).find("lacks a }"), std::string::npos);
}

TEST(RequireDistinctOutputs, refusesTwoInputsForOneName) {
  EXPECT_NO_THROW(requireDistinctOutputs(OutputPattern("{stem}.png"), {"a.pdb", "b.pdb"}));
  EXPECT_NO_THROW(requireDistinctOutputs(OutputPattern("x.png"), {"a.pdb"}));
  const std::string missing = usageErrorOf([] {
    requireDistinctOutputs(OutputPattern("x.png"), {"a.pdb", "b.pdb"});
  });
  EXPECT_NE(missing.find("put {stem} into it"), std::string::npos) << missing;
  const std::string same = usageErrorOf([] {
    requireDistinctOutputs(OutputPattern("{stem}.png"), {"x/a.pdb", "y/a.cif.gz"});
  });
  for (const char* part : {"x/a.pdb", "y/a.cif.gz", "a.png"})
    EXPECT_NE(same.find(part), std::string::npos) << same;
}

}  // namespace
}  // namespace meniscus

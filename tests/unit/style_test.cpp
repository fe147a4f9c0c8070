// Styles are shorthands: every one parses, and what is said beside it wins.

#include "app/style.h"

#include <gtest/gtest.h>

#include "app/render_options.h"
#include "core/error.h"

namespace meniscus {
namespace {

using Arguments = std::vector<std::string>;

RenderOptions styled(const Arguments& more) {
  Arguments arguments{"a.pdb", "-o", "b.png"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return parseRenderOptions(arguments).value();
}

TEST(Style, EveryStyleIsMadeOfValidOptions) {
  for (const Style& style : styles()) {
    EXPECT_NO_THROW(styled({"--style", std::string(style.name)})) << style.name;
  }
}

TEST(Style, FlatIsTheDefault) {
  EXPECT_EQ(withStyle({"a.pdb", "--style", "flat"}), (Arguments{"a.pdb", "--style", "flat"}));
  EXPECT_EQ(styled({"--style", "flat"}).shadows, styled({}).shadows);
}

TEST(Style, TurnsEffectsOn) {
  const RenderOptions soft = styled({"--style", "soft"});
  EXPECT_EQ(soft.shadows.mode, ShadowMode::soft);
  EXPECT_TRUE(soft.occlusion.on);
  EXPECT_FALSE(soft.lines.any());
  EXPECT_TRUE(styled({"--style=full"}).lines.silhouettes);
  EXPECT_EQ(styled({"--style", "illustration"}).highlight, 0.0);
  EXPECT_EQ(styled({"--style", "publication"}).samples, 64);
}

TEST(Style, OptionsBesideItWinWhereverTheyStand) {
  EXPECT_EQ(styled({"--shadows", "hard", "--style", "soft"}).shadows.mode, ShadowMode::hard);
  EXPECT_EQ(styled({"--style", "soft", "--shadows", "off"}).shadows.mode, ShadowMode::off);
  EXPECT_FALSE(styled({"--style", "soft", "--style", "flat"}).occlusion.on) << "the last style counts";
}

TEST(Style, AnUnknownOneIsRefusedByName) {
  try {
    styled({"--style", "glossy"});
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("glossy"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("illustration"), std::string::npos);
  }
}

}  // namespace
}  // namespace meniscus

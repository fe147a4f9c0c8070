// Surface methods by name, their parameters, and how what they counted adds up.

#include "render/surface_method.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "core/error.h"

namespace meniscus {
namespace {

std::string refusalOf(const SurfaceSettings& settings) {
  try {
    surfaceParametersFor(surfaceMethodFor(settings), settings);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "taken";
}

TEST(SurfaceMethods, haveNamesAndDefaultsWithinTheirRanges) {
  ASSERT_FALSE(surfaceMethods().empty());
  std::set<std::string_view> names;
  for (const SurfaceMethodInfo& method : surfaceMethods()) {
    EXPECT_TRUE(names.insert(method.name).second) << method.name;
    EXPECT_NE(method.name, "auto");
    EXPECT_FALSE(method.summary.empty());
    const SurfaceSettings settings{std::string(method.name), {}};
    EXPECT_EQ(surfaceMethodFor(settings).name, method.name);
    const SurfaceParameters values = surfaceParametersFor(method, settings);
    EXPECT_EQ(values.size(), method.parameters.size());
    for (const SurfaceParameter& parameter : method.parameters) {
      EXPECT_LE(parameter.least, parameter.value) << parameter.name;
      EXPECT_LE(parameter.value, parameter.most) << parameter.name;
      EXPECT_EQ(values.at(std::string(parameter.name)), parameter.value);
      for (const double end : {parameter.least, parameter.most})
        EXPECT_EQ(refusalOf({settings.method, {{std::string(parameter.name), end}}}), "taken");
      for (const double beyond : {parameter.least - 1, parameter.most + 1})
        EXPECT_NE(refusalOf({settings.method, {{std::string(parameter.name), beyond}}})
                      .find(std::string(parameter.name)),
                  std::string::npos);
      if (!parameter.whole || parameter.most <= parameter.least) continue;
      EXPECT_NE(refusalOf({settings.method, {{std::string(parameter.name), parameter.least + 0.5}}})
                    .find("whole number"),
                std::string::npos);
    }
  }
  EXPECT_EQ(refusalOf({}), "taken") << "auto";
}

TEST(SurfaceMethods, unknownNamesAreRefused) {
  EXPECT_NE(refusalOf({"magic", {}}).find("there is no 'magic'; there are auto"), std::string::npos);
  EXPECT_NE(refusalOf({"bezier", {{"speed", 1}}}).find("bezier has no 'speed'; it has tolerance"),
            std::string::npos);
}

TEST(SurfaceStats, addUp) {
  SurfaceStats a{"m", 10, 20, 30, 5, 1, 2, 3, {{"layers", 4}, {"most iterations of one piece", 7}}};
  a.add({"m", 1, 2, 3, 9, 1, 1, 1, {{"layers", 6}, {"most iterations of one piece", 2}, {"repairs", 1}}});
  EXPECT_EQ(a.pixels, 11u);
  EXPECT_EQ(a.pieces, 22u);
  EXPECT_EQ(a.iterations, 33u);
  EXPECT_EQ(a.mostIterations, 9u);
  EXPECT_EQ(a.overflow, 2u);
  EXPECT_EQ(a.grazing, 3u);
  EXPECT_EQ(a.notConverged, 4u);
  using Details = std::vector<std::pair<std::string, double>>;
  EXPECT_EQ(a.details, (Details{{"layers", 10}, {"most iterations of one piece", 7}, {"repairs", 1}}));
}

}  // namespace
}  // namespace meniscus

// The stability matrix against what is recorded in tests/data/stability.json: no cell gets worse.

#include <algorithm>

#include "app/measure/stability.h"
#include "core/generated_scenes.h"
#include "tests/cli/cli_test.h"
#include "tests/support/paths.h"

namespace meniscus::test {
namespace {

int rankOf(const std::string& status) {
  const std::vector<std::string> kBestFirst = {"exact", "degraded", "refused", "failed"};
  return static_cast<int>(std::find(kBestFirst.begin(), kBestFirst.end(), status) - kBestFirst.begin());
}

// Drivers and instruction sets round differently: a few pixels and a little more error are the same cell.
void expectNotWorse(const nlohmann::json& now, const nlohmann::json& recorded) {
  const std::string status = now.at("status");
  EXPECT_LE(rankOf(status), rankOf(recorded.at("status"))) << now.dump() << "\nwas " << recorded.dump();
  if (!now.contains("wrong_share") || !recorded.contains("wrong_share")) return;
  const auto value = [](const nlohmann::json& cell, const char* key) { return cell.at(key).get<double>(); };
  EXPECT_LE(value(now, "wrong_share"), 1.5 * value(recorded, "wrong_share") + 0.003);
  EXPECT_LE(value(now, "p99_detail"), 2 * value(recorded, "p99_detail") + 1e-4);
  EXPECT_LE(value(now, "normal_rms_deg"), 2 * value(recorded, "normal_rms_deg") + 0.1);
}

class MeasureStability : public CliTest {};

TEST_F(MeasureStability, noCellIsEmptyAndNoneGetsWorse) {
#ifdef MENISCUS_SANITIZED
  GTEST_SKIP()
      << "its time limits are those of the program without sanitizers; the tests of each method draw "
         "its extremes with them";
#endif
  const std::filesystem::path data = projectFile("tests/data");
  const ProcessResult result = run({"measure", data / "stability_sweep.json", "-o", "out", "-q"});
  expectSuccess(result);
  const auto now = nlohmann::json::parse(readFile(folder_ / "out/stability.json")),
             recorded = nlohmann::json::parse(readFile(data / "stability.json"));
  for (const std::string& method : measure::stabilityMethods()) {
    for (const StabilityRecipe& recipe : stabilityRecipes()) {
      const std::string scene(recipe.name);
      SCOPED_TRACE(method + " on " + scene);
      ASSERT_TRUE(now.contains(method) && now[method].contains(scene)) << "an empty cell";
      const nlohmann::json& cell = now[method][scene];
      if (recorded.contains(method) && recorded[method].contains(scene)) {
        expectNotWorse(cell, recorded[method][scene]);
      } else {  // a method that is new: record it with the command in docs/measuring.md
        EXPECT_NE(cell.at("status"), "failed");
      }
    }
  }
  const std::string report = readFile(folder_ / "out/report.html");
  EXPECT_EQ(report.find("not measured"), std::string::npos);
}

TEST_F(MeasureStability, aCellThatTakesTooLongIsEndedAndTheOthersAreDrawn) {
  writeFile(
      folder_ / "sweep.json",
      R"({"stability": {"size": "16x12", "timeLimit": 0.01, "scenes": ["plain", "sub-pixel", "not-finite"]}})");
  expectSuccess(run({"measure", "sweep.json", "-o", "out", "-q"}));
  const auto cells = nlohmann::json::parse(readFile(folder_ / "out/stability.json"));
  int failed = 0;
  for (const std::string& method : measure::stabilityMethods()) {
    EXPECT_EQ(cells.at(method).size(), 3u);
    for (const auto& cell : cells[method]) failed += cell.at("status") == "failed";
  }
  EXPECT_GT(failed, 0);
}

}  // namespace
}  // namespace meniscus::test

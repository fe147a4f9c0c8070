// The parts of `meniscus measure` that need no picture: sweeps, statistics, tables, judging a cell.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "app/measure/csv.h"
#include "app/measure/points.h"
#include "app/measure/stability.h"
#include "app/measure/statistics.h"
#include "app/measure/sweep.h"
#include "app/measure/table.h"
#include "core/error.h"
#include "core/generated_scenes.h"
#include "render/surface_method.h"
#include "tests/support/paths.h"
#include "tests/support/process.h"

namespace meniscus::measure {
namespace {

using test::readFile;
using test::TemporaryFolder;
using test::writeFile;

Sweep parsed(const std::string& text) {
  return parseSweep(text, "sweep", test::projectFile("molecules"));
}

// What is refused, and the key that is named.
void expectRefused(const std::string& text, const std::string& key) {
  try {
    parsed(text);
    ADD_FAILURE() << "was taken: " << text;
  } catch (const Error& error) {
    const std::string line = error.what();
    EXPECT_NE(line.find(key), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
}

std::string withMethods(const std::string& methods) {
  return R"({"scenes": [{"balls": 10}], "methods": )" + methods + "}";
}

TEST(MeasureSweep, builtInSweepsAreValid) {
  for (const BuiltInSweep& sweep : builtInSweeps()) {
    SCOPED_TRACE(sweep.name);
    EXPECT_NO_THROW(parsed(std::string(sweep.json)));
  }
}

TEST(MeasureSweep, unknownKeysAreNamed) {
  expectRefused(R"({"papers": {}, "metods": "all"})", "metods");
  expectRefused(R"({"scenes": [{"balls": 10, "bals": 1}], "methods": "all"})", "scenes[0].bals");
  expectRefused(R"({"papers": {}, "views": [{}, {"name": "x", "angle": 3}]})", "views[1].angle");
  expectRefused(R"({"stability": {"sise": "8x8"}})", "stability.sise");
}

TEST(MeasureSweep, impossibleValuesAreNamed) {
  expectRefused(R"({"papers": {}, "repetitions": 0})", "repetitions");
  expectRefused(R"({"papers": {}, "repetitions": 2.5})", "repetitions");
  expectRefused(R"({"papers": {}, "sizes": ["640"]})", "sizes[0]");
  expectRefused(R"({"papers": {}, "sizes": ["8x8", "8x8"]})", "sizes[1]");
  expectRefused(R"({"papers": {}, "budget": -1})", "budget");
  expectRefused(R"({"papers": {}, "seed": -1})", "seed");
  expectRefused(R"({"papers": {"scale": 2}})", "papers.scale");
  expectRefused(R"({"papers": {}, "views": [{"fov": 0}]})", "views[0].fov");
  expectRefused(R"({"stability": {"scenes": ["nowhere"]}})", "stability.scenes[0]");
  expectRefused(R"({"shadows": [{"molecule": "1ubq.pdb", "settings": [[8, 8]]}]})",
                "shadows[0].settings[0][1]");
  expectRefused(R"({"scaling": [0]})", "scaling[0]");
  expectRefused(R"({"scenes": [{"balls": 10, "blend": 2}], "methods": "all"})", "scenes[0].blend");
  expectRefused(R"({"scenes": [{"molecule": "1ubq.pdb", "exponent": 4}], "methods": "all"})",
                "scenes[0].exponent");
}

TEST(MeasureSweep, missingFilesAndNamesTwiceAreNamed) {
  expectRefused(R"({"scenes": [{"molecule": "none.pdb"}], "methods": "all"})", "scenes[0].molecule");
  expectRefused(R"({"leavingOut": "none.pdb"})", "leavingOut");
  expectRefused(R"({"scenes": [{"balls": 10}, {"balls": 10}], "methods": "all"})", "scenes[1]");
  expectRefused(R"({"papers": {}, "views": [{}, {}]})", "views[1]");
}

TEST(MeasureSweep, whatIsNoSweepIsSaid) {
  expectRefused("{\n\"papers\": {},\n]", "line 3");
  expectRefused("[]", "object");
  expectRefused("{}", "nothing to measure");
  expectRefused(R"({"scenes": [{"balls": 10}]})", "scenes");
  expectRefused(R"({"methods": "all"})", "methods");
  EXPECT_THROW(loadSweep("quik"), UsageError);
  EXPECT_THROW(loadSweep("quik.json"), InputError);
}

// Whatever methods there are.
TEST(MeasureSweep, methodsAndTheirParametersAreThoseOfTheRegistry) {
  expectRefused(withMethods(R"([{"method": "no such"}])"), "methods[0].method");
  for (const SurfaceMethodInfo& method : surfaceMethods()) {
    SCOPED_TRACE(method.name);
    const std::string name(method.name);
    const auto line = [&](const std::string& rest) {
      return withMethods(R"([{"method": ")" + name + "\"" + rest + "}]");
    };
    EXPECT_EQ(parsed(line("")).lines.at(0).method, name);

    expectRefused(line(R"(, "parameter": "no such", "values": [1])"), "methods[0].parameter");
    expectRefused(line(R"(, "options": {"no such": 1})"), "methods[0].options.no such");
    for (const SurfaceParameter& parameter : method.parameters) {
      const std::string head = R"(, "parameter": ")" + std::string(parameter.name) + R"(", "values": )";
      const std::string least = numberText(parameter.least), most = numberText(parameter.most);
      EXPECT_EQ(parsed(line(head + "[" + most + "]")).lines.at(0).values.at(0), parameter.most);
      expectRefused(line(head + "[" + numberText(parameter.most * 2 + 1) + "]"), "methods[0].values[0]");
      expectRefused(line(head + "[" + most + "," + most + "]"), "methods[0].values[1]");
      expectRefused(line(head + "[]"), "methods[0].values");
      expectRefused(line(head + R"({"from": )" + most + R"(, "to": )" + least + R"(, "steps": 3})"),
                    "methods[0].values");
      if (parameter.whole) expectRefused(line(head + "[" + least + ".5]"), "methods[0].values[0]");
    }
  }
}

TEST(MeasureSweep, aRangeIsSpreadEvenlyAndKeepsItsEnds) {
  for (const SurfaceMethodInfo& method : surfaceMethods()) {
    for (const SurfaceParameter& parameter : method.parameters) {
      if (parameter.whole || !(parameter.least > 0)) continue;
      const Sweep sweep = parsed(withMethods(
          R"([{"method": ")" + std::string(method.name) + R"(", "parameter": ")" +
          std::string(parameter.name) + R"(", "values": {"from": )" + numberText(parameter.least) +
          R"(, "to": )" + numberText(parameter.most) + R"(, "steps": 3, "scale": "log"}}])"));
      const std::vector<double>& values = sweep.lines.at(0).values;
      ASSERT_EQ(values.size(), 3u);
      EXPECT_EQ(values[0], parameter.least);
      EXPECT_EQ(values[2], parameter.most);
      EXPECT_NEAR(values[1] / std::sqrt(parameter.least * parameter.most), 1, 0.01);
    }
  }
}

TEST(MeasureSweep, allMethodsAreMeasuredOnEveryScene) {
  const Sweep sweep =
      parsed(R"({"scenes": [{"balls": 10}, {"stability": "plain"}], "methods": "all", "scaling": [5],
                 "views": [{"name": "a"}, {"name": "b"}], "sizes": ["8x8", "9x9"]})");
  EXPECT_EQ(sweep.lines.size(), surfaceMethods().size());
  const std::vector<PlannedGroup> plan = planOf(sweep);
  EXPECT_EQ(plan.size(), 2u * 2 + 1 * 2 + 1);  // a stability scene has its own view
  std::set<std::size_t> numbers;
  std::set<Row> keys;
  std::size_t points = 0;
  for (const PlannedGroup& group : plan) {
    for (const PlannedPoint& point : group.points) {
      numbers.insert(point.number);
      keys.insert(keyOf(group, point));
      ++points;
    }
  }
  EXPECT_EQ(numbers.size(), points);
  EXPECT_EQ(keys.size(), points);
}

TEST(MeasureStatistics, mediansAndQuantiles) {
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
  EXPECT_TRUE(std::isnan(median({})));
  std::vector<double> hundred;
  for (int i = 100; i >= 1; --i) hundred.push_back(i);
  EXPECT_EQ(quantile(hundred, 0.95), 95);
  EXPECT_EQ(quantile({7}, 0.95), 7);
  EXPECT_EQ(quantile({1, 2, 3}, 0.95), 3);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

TEST(MeasureStatistics, theFrontIsWhatNothingBeats) {
  EXPECT_EQ(paretoFront({{1, 5}, {2, 3}, {3, 3}, {4, 1}, {5, 2}}),
            (std::vector<bool>{true, true, false, true, false}));
  EXPECT_EQ(paretoFront({{1, 1}, {1, 1}}), (std::vector<bool>{true, true}));
  EXPECT_TRUE(paretoFront({}).empty());
}

TEST(MeasureCsv, fieldsSurviveTheFile) {
  const Row row = {"a,b", "say \"x\"", "", "plain", "ü"};
  EXPECT_EQ(parseCsv(csvLine(row)), std::vector<Row>{row});
  EXPECT_EQ(csvLine({"two\nlines"}), "\"two lines\"\n");
}

TEST(MeasureCsv, numbersAreExact) {
  for (const double value : {0.1, 1e-300, 123456789.123456789, std::numeric_limits<double>::infinity()})
    EXPECT_EQ(std::strtod(numberText(value).c_str(), nullptr), value);
  EXPECT_EQ(numberText(std::nan("")), "");
}

TEST(MeasureCsv, aHalfWrittenLineIsCutOff) {
  const TemporaryFolder folder;
  const auto path = folder / "t.csv";
  const Row header = {"a", "b"};
  {
    GrowingCsv csv(path, header);
    csv.append({{"1", "2"}, {"3", "4"}});
  }
  const std::string whole = readFile(path);
  EXPECT_EQ(whole, "a,b\n1,2\n3,4\n");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    SCOPED_TRACE(size);
    writeFile(path, whole.substr(0, size));
    GrowingCsv csv(path, header);
    const std::size_t rows = size < 8 ? 0 : size < 12 ? 1 : 2;
    EXPECT_EQ(csv.rows().size(), rows);
    csv.append({{"5", "6"}});
    EXPECT_EQ(readFile(path), "a,b\n" + std::string(rows > 0 ? "1,2\n" : "") + "5,6\n");
  }
}

TEST(MeasureCsv, anotherTableIsNotOverwritten) {
  const TemporaryFolder folder;
  writeFile(folder / "t.csv", "x,y\n1,2\n");
  EXPECT_THROW(GrowingCsv(folder / "t.csv", {"a", "b"}), InputError);
  EXPECT_EQ(readFile(folder / "t.csv"), "x,y\n1,2\n");
}

TEST(MeasureCsv, rowsCanBeDropped) {
  const TemporaryFolder folder;
  GrowingCsv csv(folder / "t.csv", {"a"});
  csv.append({{"1"}, {"2"}, {"3"}});
  csv.keepIf([](const Row& row) { return row[0] != "2"; });
  csv.append({{"4"}});
  EXPECT_EQ(readFile(folder / "t.csv"), "a\n1\n3\n4\n");
  const Table table(folder / "t.csv");
  EXPECT_EQ(table.number(1, "a"), 3);
  EXPECT_EQ(table.source(1), "t.csv:3");
  EXPECT_EQ(table.text(0, "no such column"), "");
}

struct Judged {
  HitImage image;
  ReferenceImage truth;
  Judged() {
    image.size = truth.hits.size = {10, 10};
    image.distance.assign(100, 5.0f);
    image.normal.assign(100, {0, 0, 1});
    image.id.assign(100, 1);
    truth.distance.assign(100, 5.0);
    truth.grazing.assign(100, 0);
    truth.hits = image;
  }
};

TEST(MeasureStability, aCellIsExactDegradedOrFailed) {
  Judged judged;
  EXPECT_EQ(judgeCell(judged.image, judged.truth, 1).status, Cell::Status::exact);
  judged.image.distance[3] = std::numeric_limits<float>::infinity();
  Cell cell = judgeCell(judged.image, judged.truth, 1);
  EXPECT_EQ(cell.status, Cell::Status::degraded);
  EXPECT_DOUBLE_EQ(cell.wrongShare, 0.01);
  judged.truth.grazing[3] = 1;
  EXPECT_EQ(judgeCell(judged.image, judged.truth, 1).status, Cell::Status::exact);
  for (float& t : judged.image.distance) t += 0.01f;
  cell = judgeCell(judged.image, judged.truth, 0.1);
  EXPECT_EQ(cell.status, Cell::Status::degraded);
  EXPECT_NEAR(cell.p99Detail, 0.1, 1e-5);
  judged.image.normal[7].x = std::numeric_limits<float>::quiet_NaN();
  cell = judgeCell(judged.image, judged.truth, 1);
  EXPECT_EQ(cell.status, Cell::Status::failed);
  EXPECT_NE(cell.message, "");
}

TEST(MeasureStability, everyRegisteredMethodHasItsColumn) {
  EXPECT_EQ(stabilityMethods().size(), std::size(kQuadricMethods) + surfaceMethods().size());
}

}  // namespace
}  // namespace meniscus::measure

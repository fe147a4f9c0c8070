// `meniscus measure`: what it writes, that its errors are right, that it goes on where it was interrupted,
// and what it refuses.

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <set>

#include "app/measure/picture_difference.h"
#include "app/measure/points.h"
#include "app/measure/stability.h"
#include "app/measure/sweep.h"
#include "app/measure/table.h"
#include "render/surface_method.h"
#include "tests/cli/cli_test.h"
#include "tests/support/paths.h"

namespace meniscus::test {
namespace {

using measure::Row;
using measure::Table;

// Two points for each method that has a parameter, on a protein; one for each on packed balls.
constexpr const char* kSweep = R"({
  "sizes": ["96x72"], "scenes": [{"molecule": "1ubq.pdb", "name": "ubiquitin"}], "methods": "all", "steps": 2,
  "scaling": [30], "repetitions": 2, "layers": true
})";

// The same points without pictures, which take longer than the points.
constexpr const char* kTablesOnly = R"({
  "sizes": ["96x72"], "scenes": [{"molecule": "1ubq.pdb", "name": "ubiquitin"}], "methods": "all", "steps": 2,
  "scaling": [30], "repetitions": 2, "images": false
})";

constexpr const char* kColumns =
    "scene,atoms,view,width,height,method,parameter,value,ms_median,ms_p95,missed,false,grazing,rms_relative,"
    "p99_angstrom,max_angstrom,normal_rms_deg,iterations_mean,iterations_max,overflow,not_converged,bytes\n";

Row keyAt(const Table& points, std::size_t i) {
  Row key;
  for (const char* column : {"scene", "view", "width", "height", "method", "parameter", "value"})
    key.push_back(points.text(i, column));
  return key;
}

/// The channels of an OpenEXR file by name, rows from the top.
std::map<std::string, std::vector<float>> readChannels(const std::filesystem::path& path) {
  std::map<std::string, std::vector<float>> out;
  const auto input = OIIO::ImageInput::open(path.string());
  if (!input) {
    ADD_FAILURE() << "cannot read " << path << ": " << OIIO::geterror();
    return out;
  }
  const OIIO::ImageSpec& spec = input->spec();
  for (int c = 0; c < spec.nchannels; ++c) {
    std::vector<float>& values = out[spec.channelnames[static_cast<std::size_t>(c)]];
    values.resize(static_cast<std::size_t>(spec.image_pixels()));
    EXPECT_TRUE(input->read_image(0, 0, c, c + 1, OIIO::TypeDesc::FLOAT, values.data())) << input->geterror();
  }
  return out;
}

/// A square of one color in the middle of black.
void writeSquare(const std::filesystem::path& path, float color, int size) {
  OIIO::ImageBuf picture(OIIO::ImageSpec(64, 48, 3, OIIO::TypeDesc::UINT8));
  OIIO::ImageBufAlgo::zero(picture);
  const float value[] = {color, color, color};
  const int low = 24 - size / 2;
  OIIO::ImageBufAlgo::fill(picture, value, OIIO::ROI(low, low + size, low, low + size));
  ASSERT_TRUE(picture.write(path.string())) << picture.geterror();
}

class Measure : public CliTest {
 protected:
  ProcessResult measureSweep() const { return run({"measure", "sweep.json", "-o", "out", "-q"}); }
  std::filesystem::path out(const std::string& name) const { return folder_ / "out" / name; }

  void expectTablesAndReport() const;
  void expectNoNetwork() const;
  void expectSidecar() const;
  void expectErrorsOfTheLayers() const;
};

void Measure::expectTablesAndReport() const {
  EXPECT_TRUE(readFile(out("points.csv")).starts_with(kColumns));
  const Table points(out("points.csv")), passes(out("passes.csv")), details(out("details.csv"));
  const std::string report = readFile(out("report.html"));
  ASSERT_FALSE(surfaceMethods().empty());
  for (const SurfaceMethodInfo& method : surfaceMethods()) {
    std::size_t rows = 0;
    for (std::size_t i = 0; i < points.size(); ++i) rows += points.text(i, "method") == method.name;
    EXPECT_GE(rows, 2u) << method.name;
    EXPECT_NE(report.find(">" + std::string(method.name) + "<"), std::string::npos) << method.name;
  }
  EXPECT_EQ(details.size(), points.size());
  std::set<Row> timed;
  for (std::size_t i = 0; i < passes.size(); ++i) timed.insert(keyAt(passes, i));
  EXPECT_EQ(timed.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    SCOPED_TRACE(points.source(i));
    EXPECT_GT(points.number(i, "ms_median"), 0);
    EXPECT_GE(points.number(i, "ms_p95"), points.number(i, "ms_median"));
    EXPECT_GT(points.number(i, "bytes"), 0);
    // As people see it. A picture that is right but for rounding looks right.
    EXPECT_GE(details.number(i, "picture_rms"), 0);
    const bool right = points.number(i, "missed") + points.number(i, "false") == 0 &&
                       points.number(i, "rms_relative") < 1e-6;
    EXPECT_GT(details.number(i, "picture_psnr_db"), right ? 40 : 5);
    EXPECT_LE(details.number(i, "picture_largest"), 1);
    const std::string picture = details.text(i, "picture");
    EXPECT_EQ(readPicture(out("images/" + picture + ".png")).width, 2 * 96);
    // Every figure leads to its row, every point to its picture.
    EXPECT_NE(report.find("id=\"row" + std::to_string(Table::lineOf(i)) + "\""), std::string::npos);
    EXPECT_NE(report.find("href=\"#" + picture + "\""), std::string::npos);
  }
}

void Measure::expectNoNetwork() const {
  const std::string report = readFile(out("report.html"));
  EXPECT_NE(report.find("<svg"), std::string::npos);
  for (const char* outside : {"http://", "https://", "<script", "<link", "@import"})
    EXPECT_EQ(report.find(outside), std::string::npos) << outside;
}

void Measure::expectSidecar() const {
  const auto json = nlohmann::json::parse(readFile(out("sidecar.json")));
  for (const char* key : {"version", "commit", "device", "driver", "cpu"})
    EXPECT_NE(json.at(key).get<std::string>(), "") << key;
  EXPECT_EQ(json["version"], MENISCUS_VERSION);
  EXPECT_EQ(json["resolutions"][0], "96x72");
  EXPECT_EQ(json["seed"], 1);
}

// From the OpenEXR layers of the picture and of the truth, by formulas written here.
void Measure::expectErrorsOfTheLayers() const {
  const Table points(out("points.csv")), details(out("details.csv"));
  std::map<std::string, std::string> truthOf;  // by scene: of its first point
  for (std::size_t i = 0; i < points.size(); ++i)
    truthOf.try_emplace(points.text(i, "scene"), details.text(i, "picture"));
  for (std::size_t i = 0; i < points.size(); ++i) {
    SCOPED_TRACE(points.source(i));
    const std::string truthName = truthOf.at(points.text(i, "scene"));
    auto drawn = readChannels(out("layers/" + details.text(i, "picture") + ".exr"));
    auto truth = readChannels(out("layers/truth-" + truthName + ".exr"));
    const Picture grazing = readPicture(out("layers/grazing-" + truthName + ".png"));
    int missed = 0, falseHits = 0, grazed = 0;
    double squares = 0, angles = 0, largest = 0;
    std::vector<double> errors;
    for (std::size_t p = 0; p < truth["distance"].size(); ++p) {
      const double t = drawn["distance"][p], t0 = truth["distance"][p];
      const int x = static_cast<int>(p) % grazing.width, y = static_cast<int>(p) / grazing.width;
      if (grazing.at(x, y)[0] > 0.5f) {
        ++grazed;
        continue;
      }
      const bool hit = std::isfinite(t), hit0 = std::isfinite(t0);
      missed += hit0 && !hit;
      falseHits += hit && !hit0;
      if (!hit || !hit0) continue;
      errors.push_back(std::abs(t - t0));
      largest = std::max(largest, errors.back());
      squares += std::pow((t - t0) / t0, 2);
      double cosine = 0;
      for (const char* axis : {"N.X", "N.Y", "N.Z"})
        cosine += static_cast<double>(drawn[axis][p]) * static_cast<double>(truth[axis][p]);
      angles += std::pow(std::acos(std::min(cosine, 1.0)) * 180 / 3.14159265358979, 2);
    }
    ASSERT_GT(errors.size(), 500u);
    std::sort(errors.begin(), errors.end());
    const double count = static_cast<double>(errors.size());
    // The layers hold float32: a distance of 50 A is rounded by up to 2e-6 A.
    EXPECT_EQ(points.number(i, "missed"), missed);
    EXPECT_EQ(points.number(i, "false"), falseHits);
    EXPECT_EQ(points.number(i, "grazing"), grazed);
    EXPECT_NEAR(points.number(i, "rms_relative"), std::sqrt(squares / count), 6e-8);
    const auto rank = static_cast<std::size_t>(std::ceil(0.99 * count)) - 1;
    EXPECT_NEAR(points.number(i, "p99_angstrom"), errors[rank], 1e-5);
    EXPECT_NEAR(points.number(i, "max_angstrom"), largest, 1e-5);
    EXPECT_NEAR(points.number(i, "normal_rms_deg"), std::sqrt(angles / count), 0.02);
  }
}

// One run for all that is asked of it: it takes a while.
TEST_F(Measure, aSweepYieldsTablesPicturesAReportAndErrorsThatAreRight) {
  writeFile(folder_ / "sweep.json", kSweep);
  expectSuccess(measureSweep());
  expectTablesAndReport();
  expectNoNetwork();
  expectSidecar();
  expectErrorsOfTheLayers();

  // What is there is not measured again, and not mixed with another sweep.
  const std::string before = readFile(out("points.csv"));
  expectSuccess(measureSweep());
  EXPECT_EQ(readFile(out("points.csv")), before);
  writeFile(folder_ / "other.json", R"({"scaling": [20]})");
  expectError(run({"measure", "other.json", "-o", "out"}), ExitCode::badInput, {"out", "another sweep"});
}

TEST_F(Measure, interruptedAndRunAgainItEndsWithTheSamePointsOnce) {
  writeFile(folder_ / "sweep.json", kTablesOnly);
  const std::vector<std::string> command = {program(), "measure", "sweep.json", "-o", "out", "-q"};
  ProcessOptions options;
  options.folder = folder_.path();
  int interrupted = 0;
  for (const auto& [signal, ms] :
       {std::pair{SIGKILL, 700}, std::pair{SIGINT, 1500}, std::pair{SIGKILL, 2200}}) {
    options.signal = signal;
    options.signalAfter = std::chrono::milliseconds(ms);
    interrupted += runProcess(command, options).exitCode < 0;
  }
  EXPECT_GT(interrupted, 0);
  // As if it had been cut off in the middle of a line.
  const std::filesystem::path table = folder_ / "out/points.csv";
  const std::string text = readFile(table);
  if (text.find('\n') + 40 < text.size()) writeFile(table, text.substr(0, text.size() - 25));
  options.signal = 0;
  expectSuccess(runProcess(command, options));
  std::multiset<Row> planned, measured;
  for (const measure::PlannedGroup& group :
       measure::planOf(measure::parseSweep(kTablesOnly, "sweep", projectFile("molecules"))))
    for (const measure::PlannedPoint& point : group.points) planned.insert(measure::keyOf(group, point));
  const Table points(table);
  for (std::size_t i = 0; i < points.size(); ++i) measured.insert(keyAt(points, i));
  EXPECT_EQ(measured, planned);
  EXPECT_EQ(Table(out("details.csv")).size(), points.size());
  const Table passes(out("passes.csv"));
  std::set<Row> passKeys;
  for (std::size_t i = 0; i < passes.size(); ++i) {
    Row key = keyAt(passes, i);
    key.push_back(passes.text(i, "pass"));
    EXPECT_TRUE(passKeys.insert(key).second) << passes.source(i) << " is there twice";
  }
}

TEST_F(Measure, badSweepsAreRefusedBeforeAnythingRuns) {
  const auto refused = [&](const std::string& sweep, const std::string& key) {
    writeFile(folder_ / "bad.json", sweep);
    expectError(run({"measure", "bad.json", "-o", "out"}), ExitCode::badInput, {"bad.json", key});
  };
  refused(R"({"scaling": [20], "repetition": 3})", "repetition");
  refused(R"({"scaling": [20], "repetitions": 0})", "repetitions");
  refused(R"({"scenes": [{"molecule": "none.pdb"}], "methods": "all"})", "scenes[0].molecule");
  refused(R"({"scaling": [20],,})", "line 1");
  expectError(run({"measure", "missing.json", "-o", "out"}), ExitCode::badInput, {"missing.json"});
  expectError(run({"measure", "quik", "-o", "out"}), ExitCode::badUsage, {"quik", "quick"});
  expectError(run({"measure", "quick"}), ExitCode::badUsage, {"--output"});
  expectError(run({"measure", "quick", "-o", "out", "--backend", "glx"}), ExitCode::badUsage,
              {"--backend", "glx", "osmesa"});
  expectError(run({"measure"}), ExitCode::badUsage, {"sweep"});
  EXPECT_EQ(folder_.names(), std::vector<std::string>{"bad.json"});
}

TEST_F(Measure, twoProcessesDoNotMeasureIntoOneFolder) {
  writeFile(folder_ / "sweep.json", R"({"scaling": [20]})");
  std::filesystem::create_directory(folder_ / "out");
  const int other = open((folder_ / "out").c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  ASSERT_EQ(flock(other, LOCK_EX), 0);
  expectError(run({"measure", "sweep.json", "-o", "out"}), ExitCode::badInput, {"out", "another process"});
  close(other);
}

TEST_F(Measure, picturesAreComparedAsPeopleSeeThem) {
  const std::filesystem::path a = folder_ / "a.png", b = folder_ / "b.png";
  writeSquare(a, 200 / 255.0f, 16);
  writeSquare(b, 150 / 255.0f, 16);
  const auto same = measure::comparePictures(a, a), other = measure::comparePictures(a, b);
  ASSERT_TRUE(same && other) << "idiff is missing";
  EXPECT_EQ(same->rms, 0);
  EXPECT_TRUE(std::isinf(same->psnr));
  EXPECT_EQ(same->largest, 0);
  // 50 of 255 in a twelfth of the pixels.
  EXPECT_NEAR(other->rms, 50 / 255.0 * std::sqrt(1 / 12.0), 1e-4);
  EXPECT_NEAR(other->psnr, -20 * std::log10(other->rms), 0.1);
  EXPECT_NEAR(other->largest, 50 / 255.0, 1e-4);
  EXPECT_THROW(measure::comparePictures(a, folder_ / "none.png"), InputError);
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder_.path().c_str(), 1);
  EXPECT_FALSE(measure::comparePictures(a, b).has_value());
  setenv("PATH", path.c_str(), 1);
}

TEST_F(Measure, theWayToOpenGlCanBeChosen) {
  writeFile(folder_ / "sweep.json", R"({"sizes": ["32x24"], "repetitions": 1, "images": false,
    "scenes": [{"balls": 5}], "methods": [{"method": "tiles"}],
    "stability": {"size": "16x12", "scenes": ["plain"]}})");
  expectSuccess(run({"measure", "sweep.json", "-o", "out", "--backend", "osmesa"}));
  EXPECT_EQ(nlohmann::json::parse(readFile(out("sidecar.json")))["backend"], "OSMesa");
  const Table cells(out("cells.csv"));
  EXPECT_EQ(cells.size(), measure::stabilityMethods().size());
  for (std::size_t i = 0; i < cells.size(); ++i)
    EXPECT_NE(cells.text(i, "status"), "failed") << cells.text(i, "message");
}

TEST_F(Measure, withoutGraphicsItSaysSo) {
  writeFile(folder_ / "sweep.json", R"({"scaling": [20]})");
  expectError(run({"measure", "sweep.json", "-o", "out"}, kNoGraphics), ExitCode::noGraphics, {});
}

}  // namespace
}  // namespace meniscus::test

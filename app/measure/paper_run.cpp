#include "app/measure/paper_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>

#include "app/measure/csv.h"
#include "app/measure/measure_scene.h"
#include "app/measure/null_sink.h"
#include "app/measure/stability.h"
#include "app/measure/statistics.h"
#include "core/error.h"
#include "core/generated_scenes.h"
#include "render/renderer.h"
#include "render/surface_method.h"

namespace meniscus::measure {

namespace {

struct PaperRow {
  std::size_t balls;
  double ms;  ///< 1000 / frames per second where the paper gives those
};

struct PaperTable {
  const char *paper, *table;
  ImageSize size;
  bool surface;  ///< metaballs, by every surface method; else spheres as quadrics
  std::vector<PaperRow> rows;
  const char* difference;  ///< of the scenes and machines
};

const std::vector<PaperTable>& paperTables() {
  static const std::vector<PaperTable> kTables = {
      {"Sigg et al. 2006, doi 10.2312/SPBG/SPBG06/059-065",
       "Table 1: deferred, no shadows",
       {1024, 768},
       false,
       {{1712, 1000 / 67.0}, {15000, 1000 / 51.0}, {52000, 1000 / 31.0}},
       "molecules on a GPU of 2006, whose time per primitive was that of a vertex program; packed spheres "
       "here"},
      {"Kanamori et al. 2008, doi 10.1111/j.1467-8659.2008.01132.x",
       "Table 1: GPU, 640x480",
       {640, 480},
       true,
       {{10000, 117.1}, {50000, 191.6}, {100000, 299.4}, {200000, 523.6}},
       "a fluid in a tank there, of which ever more is hidden; a ball of packed balls here, whose surface "
       "always fills the picture"},
      {"Kanamori et al. 2008, doi 10.1111/j.1467-8659.2008.01132.x",
       "Table 1: GPU, 1024x768",
       {1024, 768},
       true,
       {{10000, 230.4}, {50000, 366.3}, {100000, 571.4}},
       "a fluid in a tank there, of which ever more is hidden; a ball of packed balls here, whose surface "
       "always fills the picture"},
      {"Gourmel et al. 2010, doi 10.1111/j.1467-8659.2009.01597.x",
       "Table 1: FBVH, molecules 1 and 2",
       {1024, 768},
       true,
       {{4000, 1000 / 11.0}, {128000, 1000 / 2.4}},
       "averages over a flight around two molecules there; one view of packed balls here"},
      {"Szecsi and Illes 2012, Eurographics short papers",
       "Table 1",
       {1024, 768},
       true,
       {{50000, 1000 / 25.0}, {100000, 1000 / 13.0}, {200000, 1000 / 6.0}, {800000, 1000 / 2.0}},
       "a mud simulation that fills the picture there, sorted on the processor; packed balls here"},
      {"GPU-accelerated ray casting of node-based implicit surfaces, poster",
       "Figures 4 and 2",
       {512, 512},
       true,
       {{3, 1000 / 45.0}, {100, 1000 / 5.0}},
       "a fluid of 100 nodes there, whose frame rate includes its simulation; packed balls here, and no "
       "simulation"},
  };
  return kTables;
}

class PaperRun {
 public:
  PaperRun(const Sweep& sweep, const OutputFolder& folder, Progress& progress)
      : sweep_(sweep),
        progress_(progress),
        table_(folder / "papers.csv", {"paper", "table", "row", "width", "height", "method", "paper_ms",
                                       "paper_ratio", "here_ms", "here_ratio", "why"}) {}
  void run();

 private:
  void measureTable(const PaperTable& table, const std::string& method, ImageSize size);
  double timeOf(const std::string& method, const std::shared_ptr<const Primitives>& primitives,
                ImageSize size, bool surface);
  std::shared_ptr<const Primitives> scene(std::size_t balls, bool surface);

  const Sweep& sweep_;
  Progress& progress_;
  GrowingCsv table_;
  std::map<std::string, std::unique_ptr<Renderer>> renderers_;
};

std::shared_ptr<const Primitives> PaperRun::scene(std::size_t balls, bool surface) {
  auto primitives = packedBalls(balls, sweep_.seed);
  if (surface) return primitives;
  for (const Metaball& b : primitives->surfaces[0].balls)
    primitives->spheres.push_back({b.center, b.support / 2, b.color, b.id});
  primitives->surfaces.clear();
  return primitives;
}

double PaperRun::timeOf(const std::string& method, const std::shared_ptr<const Primitives>& primitives,
                        ImageSize size, bool surface) {
  std::unique_ptr<Renderer>& renderer = renderers_[method];
  if (!renderer) renderer = std::make_unique<Renderer>();
  renderer->setPrimitives(primitives);
  const View view = viewOf(*primitives, {}, size);
  RenderSettings settings;
  settings.samples = 1;
  if (surface) {
    settings.surface.method = method;
  } else {
    settings.quadrics = *quadricMethodNamed(method);
  }
  std::vector<double> times;
  for (int i = -1; i < sweep_.repetitions; ++i) {
    const auto start = std::chrono::steady_clock::now();
    NullSink sink;
    renderer->renderPicture(i < 0 ? beside(view) : view, Lighting{}, Background{}, settings,
                            PixelFormat::rgba8, sink);
    const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
    if (i >= 0) times.push_back(spent.count());
  }
  return median(times);
}

// All rows of a table at once: the ratios are to its first.
void PaperRun::measureTable(const PaperTable& table, const std::string& method, ImageSize size) {
  std::vector<Row> rows;
  double first = 0;
  for (const PaperRow& row : table.rows) {
    if (row.balls > sweep_.papers->mostBalls) break;
    double ms = std::nan("");
    std::string refused;
    try {
      ms = timeOf(method, scene(row.balls, table.surface), size, table.surface);
    } catch (const Error& error) {
      refused = error.what();
    }
    if (rows.empty()) first = ms;
    const double paper = row.ms / table.rows.front().ms, here = ms / first, factor = here / paper;
    std::string why = refused;
    if (rows.empty()) {
      why = "the row that the others are divided by";
    } else if (factor > 1.25 || factor < 0.8) {
      why = fmt::format("grows {} than in the paper: {}", factor > 1 ? "faster" : "slower", table.difference);
    } else if (refused.empty()) {
      why = "as in the paper, within a quarter";
    }
    rows.push_back({table.paper, table.table, fmt::format("{} balls", row.balls),
                    fmt::format("{}", size.width), fmt::format("{}", size.height), method, numberText(row.ms),
                    numberText(paper), numberText(ms), numberText(here), why});
  }
  table_.append(rows);
}

void PaperRun::run() {
  struct Job {
    const PaperTable* table;
    std::string method;
    ImageSize size;
  };
  std::vector<Job> jobs;
  for (const PaperTable& table : paperTables()) {
    const double scale = sweep_.papers->scale;
    const ImageSize size{std::max(1, static_cast<int>(table.size.width * scale)),
                         std::max(1, static_cast<int>(table.size.height * scale))};
    std::vector<std::string> methods;
    if (!table.surface)
      for (const NamedQuadricMethod& quadrics : kQuadricMethods) methods.emplace_back(quadrics.name);
    if (table.surface)
      for (const SurfaceMethodInfo& method : surfaceMethods()) methods.emplace_back(method.name);
    for (const std::string& method : methods) {
      const bool there = std::any_of(table_.rows().begin(), table_.rows().end(), [&](const Row& row) {
        return row[0] == table.paper && row[1] == table.table && row[5] == method;
      });
      // One row alone is no ratio.
      if (!there && table.rows.size() > 1 && table.rows[1].balls <= sweep_.papers->mostBalls)
        jobs.push_back({&table, method, size});
    }
  }
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    progress_.label(fmt::format("papers: {}, {}", jobs[i].table->table, jobs[i].method));
    progress_.update(static_cast<double>(i) / static_cast<double>(jobs.size()));
    measureTable(*jobs[i].table, jobs[i].method, jobs[i].size);
  }
}

}  // namespace

void measurePapers(const Sweep& sweep, const OutputFolder& folder, Progress& progress) {
  PaperRun(sweep, folder, progress).run();
}

}  // namespace meniscus::measure

// `meniscus measure`: error against run time, stability, and what is left out, as tables and one page to look
// at (docs/measuring.md).

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <thread>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/measure/leaving_out.h"
#include "app/measure/output_folder.h"
#include "app/measure/paper_run.h"
#include "app/measure/points.h"
#include "app/measure/report.h"
#include "app/measure/shadow_run.h"
#include "app/measure/stability.h"
#include "app/measure/surface_run.h"
#include "app/measure/sweep.h"
#include "app/option_values.h"
#include "app/progress.h"
#include "core/error.h"
#include "render/gl/context.h"

namespace meniscus {
namespace {

using namespace measure;

constexpr const char* kMeasureDescription =
    "Measures error against run time and writes tables and a page to look at: DIR/report.html.\n"
    "Run again with the same folder, it goes on where it was interrupted.\n";

constexpr const char* kMeasureExamples =
    "  meniscus measure quick -o out\n"
    "  meniscus measure stability -o stable\n"
    "  meniscus measure my_sweep.json -o out      # docs/measuring.md says how to write one\n";

std::string sweepHelp() {
  std::string help = "A sweep as a JSON file, or one of these:";
  for (const BuiltInSweep& sweep : builtInSweeps())
    help += fmt::format("\n{}: {}", sweep.name, sweep.summary);
  return help;
}

Machine thisMachine(const Context& context) {
  Machine machine;
  machine.version = version();
  machine.commit = commit();
  machine.backend = context.name();
  machine.device = context.rendererName();
  machine.driver = context.driverVersion();
  machine.cpu = processorName();
  machine.threads = static_cast<int>(std::thread::hardware_concurrency());
  return machine;
}

struct MeasureOptions {
  std::string sweep, folder, drawCells, backend = "auto";
  bool quiet = false;
};

int runSweep(const MeasureOptions& options) {
  const Backend backend = parseBackend("--backend", options.backend);
  const Sweep sweep = loadSweep(options.sweep);
  const OutputFolder folder(options.folder, sweep, !options.drawCells.empty());
  if (!options.drawCells.empty()) {
    if (!sweep.stability) throw UsageError("--draw-cells: the sweep has no stability scenes");
    drawCells(sweep, folder, options.drawCells, backend);
    return 0;
  }
  const std::unique_ptr<Context> context = Context::create(backend);
  folder.describe(sweep, thisMachine(*context));
  Progress progress(!options.quiet, true);
  progress.start(sweep.name);
  {
    PointTables tables(folder);
    measureSurfaces(sweep, folder, tables, progress);
  }
  if (sweep.leavingOut) {
    progress.start("leaving out");
    measureLeavingOut(sweep, folder, progress);
  }
  if (!sweep.shadows.empty()) {
    progress.start("shadows");
    measureShadows(sweep, folder, progress);
  }
  if (sweep.papers) {
    progress.start("papers");
    measurePapers(sweep, folder, progress);
  }
  if (sweep.stability) {
    progress.start("stability");
    measureStability(sweep, {"--backend", options.backend, options.sweep}, folder, progress);
  }
  progress.clear();
  writeReport(sweep, folder);
  if (!options.quiet) std::printf("%s\n", (folder / "report.html").c_str());
  return 0;
}

}  // namespace

int runMeasure(const std::vector<std::string>& arguments) {
  MeasureOptions options;
  const std::unique_ptr<CLI::App> app = makeCommandLine("measure", kMeasureDescription, kMeasureExamples);
  app->add_option("sweep", options.sweep, sweepHelp())->type_name("SWEEP");
  app->add_option("-o,--output", options.folder, "Folder for the tables and the report; made if missing")
      ->type_name("DIR")
      ->group("Output");
  app->add_option("--backend", options.backend, "How to reach OpenGL [auto]; see 'meniscus doctor'")
      ->type_name("auto|egl|osmesa")
      ->group("Other");
  app->add_flag("-q,--quiet", options.quiet, "Say nothing but errors")->group("Output");
  // A process of the stability suite's own; not for people.
  app->add_option("--draw-cells", options.drawCells)->group("");
  if (!parseCommandLine(*app, arguments)) return 0;
  if (options.sweep.empty()) throw UsageError("measure: no sweep; see meniscus measure --help");
  if (options.folder.empty()) throw UsageError("--output: say where the report goes, with -o DIR");
  return runSweep(options);
}

}  // namespace meniscus

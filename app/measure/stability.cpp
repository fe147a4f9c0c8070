#include "app/measure/stability.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "app/measure/error_picture.h"
#include "app/measure/measure_scene.h"
#include "core/error.h"
#include "core/generated_scenes.h"
#include "io/output_file.h"
#include "render/renderer.h"
#include "render/surface_method.h"

namespace meniscus::measure {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double kExactDetail = 1e-4, kExactNormalDeg = 0.1;
constexpr std::size_t kMethod = 0, kScene = 1;  // columns of cells.csv

const StabilityRecipe& recipeOf(const std::string& name) {
  for (const StabilityRecipe& recipe : stabilityRecipes())
    if (recipe.name == name) return recipe;
  throw UsageError(fmt::format("there is no stability scene '{}'", name));
}

const std::shared_ptr<const Primitives>& drawnBy(const std::string& method, const StabilityScene& scene) {
  return quadricMethodNamed(method) ? scene.quadrics : scene.surface;
}

// Nothing if the scene cannot have one: it must be refused.
std::optional<ReferenceImage> truthIfAny(const Primitives& primitives, const View& view,
                                         const OutputFolder& folder) {
  try {
    return truthOf(primitives, view, folder / "truth");
  } catch (const InputError&) {
    return std::nullopt;
  }
}

bool isNumber(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::string pictureOf(const std::string& method, const std::string& scene) {
  return fmt::format("images/cell-{}-{}.png", method, scene);
}

Row rowOf(const std::string& method, const std::string& scene, const Cell& cell, double ms) {
  const HitErrors& e = cell.errors;
  const bool judged = cell.status == Cell::Status::exact || cell.status == Cell::Status::degraded;
  const auto number = [&](double value) { return judged ? numberText(value) : ""; };
  const auto count = [&](std::size_t value) { return judged ? fmt::format("{}", value) : ""; };
  return {method,
          scene,
          nameOf(cell.status),
          number(cell.wrongShare),
          number(cell.p99Detail),
          number(cell.normalRmsDeg),
          count(e.pixels),
          count(e.compared),
          count(e.missed),
          count(e.falseHits),
          count(e.grazing),
          number(e.distanceP99),
          number(e.largestDistance),
          numberText(ms),
          judged ? pictureOf(method, scene) : "",
          cell.message};
}

bool hasCell(const GrowingCsv& cells, const std::string& method, const std::string& scene) {
  return std::any_of(cells.rows().begin(), cells.rows().end(),
                     [&](const Row& row) { return row[kMethod] == method && row[kScene] == scene; });
}

Cell drawCell(Renderer& renderer, const std::string& method, const StabilityScene& scene,
              const std::optional<ReferenceImage>& truth, const fs::path& picture, double& ms) {
  Cell cell;
  const std::shared_ptr<const Primitives>& primitives = drawnBy(method, scene);
  try {
    const std::optional<QuadricMethod> quadrics = quadricMethodNamed(method);
    SurfaceSettings settings;
    if (!quadrics) settings.method = method;
    renderer.setPrimitives(primitives);
    const Clock::time_point start = Clock::now();
    const HitImage image = renderer.renderHits(scene.view, {true, true, true}, settings,
                                               quadrics.value_or(QuadricMethod::automatic));
    ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    if (!truth) {
      cell.message = "drew what cannot be drawn instead of refusing it";
      return cell;
    }
    cell = judgeCell(image, *truth, scene.detail);
    if (cell.status != Cell::Status::failed) writeErrorPicture(picture, image, *truth, *primitives);
  } catch (const Error& error) {
    cell.status = Cell::Status::refused;
    cell.message = error.what();
  } catch (const std::exception& error) {
    cell.message = fmt::format("exception: {}", error.what());
  }
  return cell;
}

/// A process that draws the cells of one method.
class Worker {
 public:
  Worker(const std::vector<std::string>& given, const OutputFolder& folder, const std::string& method)
      : current_(folder / "cells.current") {
    std::error_code error;
    fs::remove(current_, error);
    const std::string program = "/proc/self/exe", log = (folder / "cells.log").string();
    std::vector<std::string> words = {"meniscus", "measure", "--draw-cells",
                                      method,     "-o",      folder.path().string()};
    words.insert(words.end(), given.begin(), given.end());
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666);
    const int failure = posix_spawn(&pid_, program.c_str(), &files, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (failure != 0)
      throw InputError(fmt::format("cannot start a process of this program: {}", std::strerror(failure)));
  }
  ~Worker() {
    if (running_) end();
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  bool running() {
    if (running_ && waitpid(pid_, &status_, WNOHANG) == pid_) running_ = false;
    return running_;
  }
  void end() {
    kill(pid_, SIGKILL);
    waitpid(pid_, &status_, 0);
    running_ = false;
  }
  /// The cell that is being drawn; empty before the first.
  std::string current() const {
    std::ifstream file(current_);
    std::string name;
    std::getline(file, name);
    return name;
  }
  std::string ending() const {
    if (WIFSIGNALED(status_)) return fmt::format("crashed: {}", strsignal(WTERMSIG(status_)));
    return fmt::format("ended with exit code {}", WEXITSTATUS(status_));
  }
  bool succeeded() const { return WIFEXITED(status_) && WEXITSTATUS(status_) == 0; }
  bool withoutGraphics() const {
    return WIFEXITED(status_) && WEXITSTATUS(status_) == static_cast<int>(ExitCode::noGraphics);
  }

 private:
  fs::path current_;
  pid_t pid_ = 0;
  int status_ = 0;
  bool running_ = true;
};

class StabilityRun {
 public:
  StabilityRun(const Sweep& sweep, const std::vector<std::string>& arguments, const OutputFolder& folder,
               Progress& progress)
      : sweep_(sweep), spec_(*sweep.stability), arguments_(arguments), folder_(folder), progress_(progress) {}

  void run() {
    const std::vector<std::string> methods = stabilityMethods();
    computeTruths(methods);
    for (std::size_t i = 0; i < methods.size(); ++i) {
      progress_.label(fmt::format("stability: {}", methods[i]));
      // Every worker that ends early leaves one cell more behind it.
      while (!complete(methods[i]))
        drawSome(methods[i], static_cast<double>(i) / static_cast<double>(methods.size()));
    }
    writeJson();
  }

 private:
  static constexpr double kTruthShare = 0.3;

  bool complete(const std::string& method) const {
    const GrowingCsv cells(folder_ / "cells.csv", cellColumns());
    return std::all_of(spec_.scenes.begin(), spec_.scenes.end(),
                       [&](const std::string& scene) { return hasCell(cells, method, scene); });
  }

  void computeTruths(const std::vector<std::string>& methods) {
    for (std::size_t i = 0; i < spec_.scenes.size(); ++i) {
      progress_.label(fmt::format("stability: truth of {}", spec_.scenes[i]));
      progress_.update(kTruthShare * static_cast<double>(i) / static_cast<double>(spec_.scenes.size()));
      const StabilityScene scene = recipeOf(spec_.scenes[i]).make(sweep_.seed, spec_.size);
      truthIfAny(*scene.quadrics, scene.view, folder_);
      if (methods.size() > std::size(kQuadricMethods)) truthIfAny(*scene.surface, scene.view, folder_);
    }
  }

  void drawSome(const std::string& method, double before) {
    Worker worker(arguments_, folder_, method);
    std::string current;
    Clock::time_point since = Clock::now();
    const double kinds = static_cast<double>(stabilityMethods().size());
    while (worker.running()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      const std::string now = worker.current();
      if (now != current) {
        current = now;
        since = Clock::now();
        const auto at = std::find(spec_.scenes.begin(), spec_.scenes.end(), current);
        const double within =
            static_cast<double>(at - spec_.scenes.begin()) / static_cast<double>(spec_.scenes.size());
        progress_.label(fmt::format("stability: {}, {}", method, current));
        progress_.update(kTruthShare + (1 - kTruthShare) * (before + within / kinds));
      }
      const double seconds = std::chrono::duration<double>(Clock::now() - since).count();
      if (seconds > spec_.timeLimit) {
        worker.end();
        fail(method, current, fmt::format("too slow: not done within {} s", spec_.timeLimit));
        return;
      }
    }
    if (worker.succeeded()) return;
    if (worker.withoutGraphics())
      throw GraphicsError(fmt::format("no OpenGL 4.5 context for the stability cells; see '{}'",
                                      (folder_ / "cells.log").string()));
    fail(method, current, worker.ending());
  }

  // A worker that dies before its first cell is not the scene's fault; so that this ends, it is said of the
  // next cell all the same.
  void fail(const std::string& method, std::string scene, const std::string& how) {
    GrowingCsv cells(folder_ / "cells.csv", cellColumns());
    for (const std::string& next : spec_.scenes)
      if (scene.empty() && !hasCell(cells, method, next)) scene = next;
    if (hasCell(cells, method, scene)) return;
    Cell cell;
    cell.message = how;
    cells.append({rowOf(method, scene, cell, std::nan(""))});
  }

  // What tests/data/stability.json records.
  void writeJson() const {
    const GrowingCsv cells(folder_ / "cells.csv", cellColumns());
    nlohmann::ordered_json json;
    for (const Row& row : cells.rows()) {
      nlohmann::ordered_json cell = {{"status", row[2]}};
      if (!row[3].empty()) {
        const auto rounded = [](const std::string& text) {
          return text == "inf" ? 1e30 : std::stod(fmt::format("{:.3g}", std::stod(text)));
        };
        cell["wrong_share"] = rounded(row[3]);
        cell["p99_detail"] = rounded(row[4]);
        cell["normal_rms_deg"] = rounded(row[5]);
      }
      json[row[kMethod]][row[kScene]] = cell;
    }
    // A cell a line: what changed is seen.
    std::string text = "{";
    for (const auto& [method, scenes] : json.items()) {
      text += fmt::format("{}\n \"{}\": {{", text.size() > 1 ? "," : "", method);
      bool first = true;
      for (const auto& [scene, cell] : scenes.items()) {
        text += fmt::format("{}\n  \"{}\": {}", first ? "" : ",", scene, cell.dump());
        first = false;
      }
      text += "\n }";
    }
    writeTextFile(folder_ / "stability.json", text + "\n}\n");
  }

  const Sweep& sweep_;
  const StabilitySpec& spec_;
  const std::vector<std::string>& arguments_;
  const OutputFolder& folder_;
  Progress& progress_;
};

}  // namespace

const char* nameOf(Cell::Status status) {
  constexpr const char* kNames[] = {"exact", "degraded", "refused", "failed"};
  return kNames[static_cast<std::size_t>(status)];
}

Row cellColumns() {
  return {"method",       "scene",    "status",  "wrong_share", "p99_detail", "normal_rms_deg",
          "pixels",       "compared", "missed",  "false",       "grazing",    "p99_angstrom",
          "max_angstrom", "ms",       "picture", "message"};
}

std::optional<QuadricMethod> quadricMethodNamed(const std::string& name) {
  for (const NamedQuadricMethod& quadrics : kQuadricMethods)
    if (quadrics.name == name) return quadrics.method;
  return std::nullopt;
}

std::vector<std::string> stabilityMethods() {
  std::vector<std::string> methods;
  for (const NamedQuadricMethod& quadrics : kQuadricMethods) methods.emplace_back(quadrics.name);
  for (const SurfaceMethodInfo& method : surfaceMethods()) methods.emplace_back(method.name);
  return methods;
}

Cell judgeCell(const HitImage& image, const ReferenceImage& truth, double detail) {
  Cell cell;
  for (std::size_t i = 0; i < image.distance.size(); ++i) {
    if (std::isnan(image.distance[i]) || image.distance[i] == -std::numeric_limits<float>::infinity() ||
        (!image.normal.empty() && !isNumber(image.normal[i]))) {
      cell.message = "wrote a number that is not one";
      return cell;
    }
  }
  cell.errors = compareHits(image, truth);
  const HitErrors& e = cell.errors;
  double farthest = 0;
  for (const double t : truth.distance)
    if (std::isfinite(t)) farthest = std::max(farthest, t);
  const double judged = static_cast<double>(std::max<std::size_t>(e.pixels - e.grazing, 1));
  cell.wrongShare = static_cast<double>(e.missed + e.falseHits) / judged;
  cell.p99Detail = e.distanceP99 / detail;
  cell.normalRmsDeg = e.normalRmsDeg;
  const bool exact = e.missed + e.falseHits == 0 &&
                     e.distanceP99 <= kExactDetail * detail + 0x1p-23 * farthest &&
                     e.normalRmsDeg <= kExactNormalDeg;
  cell.status = exact ? Cell::Status::exact : Cell::Status::degraded;
  return cell;
}

void measureStability(const Sweep& sweep, const std::vector<std::string>& arguments,
                      const OutputFolder& folder, Progress& progress) {
  StabilityRun(sweep, arguments, folder, progress).run();
}

void drawCells(const Sweep& sweep, const OutputFolder& folder, const std::string& method, Backend backend) {
  // Whoever started it is killed: nobody would wait for it, and another run would draw the same cells.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const auto context = Context::create(backend);
  Renderer renderer;
  GrowingCsv cells(folder / "cells.csv", cellColumns());
  for (const std::string& name : sweep.stability->scenes) {
    if (hasCell(cells, method, name)) continue;
    const StabilityScene scene = recipeOf(name).make(sweep.seed, sweep.stability->size);
    const auto truth = truthIfAny(*drawnBy(method, scene), scene.view, folder);
    writeTextFile(folder / "cells.current", name + "\n");
    double ms = std::nan("");
    const Cell cell = drawCell(renderer, method, scene, truth, folder / pictureOf(method, name), ms);
    cells.append({rowOf(method, name, cell, ms)});
  }
}

}  // namespace meniscus::measure

// `meniscus render`: structure files and scenes -> pictures. Inputs are prepared while earlier ones are
// drawn, with one OpenGL context; what goes wrong with one of several does not stop the others.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <deque>
#include <future>
#include <memory>
#include <new>
#include <utility>

#include "app/commands.h"
#include "app/content_hash.h"
#include "app/film.h"
#include "app/interrupt.h"
#include "app/manifest.h"
#include "app/output_name.h"
#include "app/picture_drawer.h"
#include "app/progress.h"
#include "app/run_report.h"
#include "app/scene/mvs_scene.h"
#include "app/scene/mvs_writer.h"
#include "app/structure_pictures.h"
#include "core/error.h"
#include "io/file_bytes.h"
#include "io/output_file.h"

namespace meniscus {
namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

struct Input {
  std::string file;
  bool isScene = false;
};

/// An input on its way from its file to pictures.
struct Prepared {
  Preparation made;
  std::string key;
  double milliseconds = 0;
  bool done = false;         ///< by an earlier run
  std::exception_ptr error;  ///< instead of pictures
};

/// What the frames of a film have in common. Throws InputError if the pictures of an input are of several
/// sizes.
ImageSize frameSize(const std::string& input, const std::vector<Picture>& pictures) {
  const ImageSize size = pictures.front().options.size;
  for (const Picture& picture : pictures) {
    const ImageSize other = picture.options.size;
    if (other != size)
      throw InputError(
          fmt::format("'{}': its states are pictures of {}x{} and of {}x{} pixels, which make no film; give "
                      "--size",
                      input, size.width, size.height, other.width, other.height));
  }
  return size;
}

class RenderRun {
 public:
  explicit RenderRun(const RenderOptions& options)
      : options_(options),
        pattern_(options.output.empty() ? options.exportMesh : options.output),
        exportPattern_(options.exportMesh),
        progress_(!options.quiet),
        drawer_(options, report_, progress_) {
    report_.size = options.size;
    report_.samples = options.samples;
    for (const std::string& file : options.files) inputs_.push_back({file, false});
    for (const std::string& file : options.scenes) inputs_.push_back({file, true});
    many_ = inputs_.size() > 1 || !options.manifest.empty() || options.turntable > 0;
  }
  int run();

 private:
  void checkBeforeReading() const;
  Prepared prepare(const Input& input) const;
  void finishInput(const Input& input, Prepared prepared);
  void drawAll(const Input& input, Prepared& prepared);
  void drawOne(Picture picture, const Prepared& prepared, std::size_t count, Clock::time_point start);
  void failed(const Input& input, const Prepared& prepared, const std::string& output,
              const std::string& line, double milliseconds);
  void showNotes(const Input& input, const Preparation& made);
  void finishReport();

  const RenderOptions& options_;
  OutputPattern pattern_;  // of pictures, or of meshes if there are none
  OutputPattern exportPattern_;
  Progress progress_;
  RunReport report_;
  PictureDrawer drawer_;
  std::vector<Input> inputs_;
  bool many_ = false;
  std::unique_ptr<Manifest> manifest_;
  std::unique_ptr<SceneWriter> sceneWriter_;
  std::size_t failedInputs_ = 0;
};

int RenderRun::run() {
  checkBeforeReading();
  if (options_.resume) {
    for (const std::string& name : {options_.output, options_.exportMesh})
      if (!name.empty()) removeAbandonedFiles(name);
  }
  if (!options_.manifest.empty()) manifest_ = std::make_unique<Manifest>(options_.manifest, options_.resume);
  if (!options_.saveScene.empty()) sceneWriter_ = std::make_unique<SceneWriter>(options_.saveScene);
  if (many_) deferInterrupt();

  std::deque<std::future<Prepared>> ahead;
  std::size_t next = 0;
  for (std::size_t i = 0; i < inputs_.size() && !interrupted(); ++i) {
    const auto policy = inputs_.size() > 1 ? std::launch::async : std::launch::deferred;
    for (; next < inputs_.size() && next <= i + static_cast<std::size_t>(options_.jobs); ++next)
      ahead.push_back(std::async(policy, [this, &input = inputs_[next]] { return prepare(input); }));
    Prepared prepared = ahead.front().get();
    ahead.pop_front();
    finishInput(inputs_[i], std::move(prepared));
  }
  progress_.clear();
  if (sceneWriter_ && report_.failures.empty() && !interrupted()) sceneWriter_->write();
  finishReport();
  for (const std::string& failure : report_.failures) std::fprintf(stderr, "meniscus: %s\n", failure.c_str());
  if (failedInputs_ > 1)
    std::fprintf(stderr, "meniscus: %zu of %zu files failed\n", failedInputs_, inputs_.size());
  if (interrupted()) {
    std::fprintf(stderr, "meniscus: interrupted%s\n",
                 manifest_ ? "; the same command with --resume goes on" : "");
    ahead.clear();
    manifest_.reset();
    endByInterrupt();
  }
  return static_cast<int>(report_.failures.empty() ? ExitCode::ok : ExitCode::badInput);
}

// What is wrong whatever the files hold.
void RenderRun::checkBeforeReading() const {
  std::vector<std::string> files;
  for (const Input& input : inputs_) files.push_back(input.file);
  requireDistinctOutputs(pattern_, files);
  std::vector<std::pair<const char*, std::string>> selections{{"--select", options_.structure.select},
                                                              {"--focus", options_.focus}};
  for (const ShownApart& shown : options_.shown) selections.emplace_back("--show", shown.cid);
  for (const std::string& cid : options_.hidden) selections.emplace_back("--hide", cid);
  for (const auto& [cid, text] : options_.labels) selections.emplace_back("--label", cid);
  for (const auto& cids : options_.measures)
    for (const std::string& cid : cids) selections.emplace_back("--measure", cid);
  for (const auto& [option, cid] : selections) {
    try {
      if (!cid.empty()) selectAtoms(Molecule{}, cid);
    } catch (const UsageError& error) {
      throw UsageError(fmt::format("{}: {}", option, error.what()));
    }
  }
  if (!options_.exportMesh.empty()) {
    requireDistinctOutputs(exportPattern_, files);
    const bool filmOfModels = isFilm(options_.output) && options_.structure.allModels;
    if (filmOfModels && !exportPattern_.namesModel())
      throw UsageError(
          fmt::format("--export: '{}' is one name for the meshes of all models; put {{model}} into it",
                      options_.exportMesh));
    if (!filmOfModels && exportPattern_.namesModel() != pattern_.namesModel())
      throw UsageError(
          "--export: put {model} into the names of the picture and of the mesh, or into neither");
    const auto isSurface = [](const ShownApart& s) { return s.representation == Representation::surface; };
    if (options_.representation != Representation::surface &&
        std::none_of(options_.shown.begin(), options_.shown.end(), isSurface))
      throw UsageError("--export: nothing is drawn as a surface; add --representation surface");
    if (!exportPattern_.namesModel())
      for (const std::string& file : files) requireWritable(exportPattern_.nameFor(file, {}));
  }
  if (!pattern_.namesModel() && !pattern_.namesState())
    for (const std::string& file : files) requireWritable(pattern_.nameFor(file, {}));
  for (const std::string& file : {options_.statsFile, options_.saveScene})
    if (!file.empty()) requireWritable(file);
}

/// Runs beside the drawing: touches nothing of the run.
Prepared RenderRun::prepare(const Input& input) const {
  Prepared prepared;
  const auto start = Clock::now();
  try {
    const auto isDone = [&](const std::string& content) {
      prepared.key =
          contentHash(fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{}", version(), content, options_.pictureOptions,
                                  options_.turntable, options_.framesPerSecond,
                                  pattern_.nameFor(input.file, {}), exportPattern_.nameFor(input.file, {})));
      prepared.done = options_.resume && manifest_->allDone(prepared.key);
      return prepared.done;
    };
    if (input.isScene) {
      MvsFile file(input.file, {options_.offline, options_.cache});
      if (!isDone(manifest_ ? file.contentName() : ""))
        prepared.made = scenePictures(input.file, file, options_);
    } else {
      std::string bytes = readBytes(input.file);
      if (!isDone(manifest_ ? contentHash(bytes) : ""))
        prepared.made = structurePictures(input.file, std::move(bytes), options_);
    }
  } catch (...) {
    prepared.error = std::current_exception();
  }
  prepared.milliseconds = millisecondsSince(start);
  return prepared;
}

void RenderRun::finishInput(const Input& input, Prepared prepared) {
  if (prepared.done) return;
  const std::size_t before = report_.failures.size();
  try {
    if (prepared.error) std::rethrow_exception(prepared.error);
    drawAll(input, prepared);
  } catch (const GraphicsError&) {
    throw;
  } catch (const Error& error) {
    if (!many_) throw;
    failed(input, prepared, "", error.what(), prepared.milliseconds);
  } catch (const std::bad_alloc&) {
    if (!many_) throw;
    failed(input, prepared, "",
           "'" + input.file + "': not enough memory; draw fewer atoms or a smaller picture",
           prepared.milliseconds);
  }
  if (report_.failures.size() > before) ++failedInputs_;
}

void RenderRun::failed(const Input& input, const Prepared& prepared, const std::string& output,
                       const std::string& line, double milliseconds) {
  report_.failures.push_back(line);
  if (manifest_)
    manifest_->add({input.file, output, prepared.key, prepared.made.pictures.size(), milliseconds,
                    prepared.made.unsupported, line});
}

void RenderRun::drawAll(const Input& input, Prepared& prepared) {
  Preparation& made = prepared.made;
  report_.parseSeconds += made.parseSeconds;
  report_.bondsSeconds += made.bondsSeconds;
  showNotes(input, made);
  if (options_.strict) requireAllSupported(made);
  const std::size_t frames = static_cast<std::size_t>(std::max(1, options_.turntable));
  const std::size_t count = made.pictures.size() * frames;
  std::unique_ptr<FilmFile> film;
  const std::string filmName = made.pictures.front().output;
  if (isFilm(options_.output))
    film =
        std::make_unique<FilmFile>(filmName, frameSize(input.file, made.pictures), options_.framesPerSecond);
  Clock::time_point start =
      Clock::now() - std::chrono::microseconds(std::llround(1000 * prepared.milliseconds));
  std::string drawing;  // name of the output
  drawer_.watch = [this, &start, &drawing] {
    const double limit = 1000 * options_.timeLimit;
    if (limit > 0 && millisecondsSince(start) > limit)
      throw InputError(
          fmt::format("'{}': takes longer than the time limit of {} s", drawing, options_.timeLimit));
  };
  for (std::size_t i = 0; i < count && !interrupted(); ++i) {
    Picture& picture = made.pictures[i / frames];
    if (frames > 1 && picture.panels.empty() && !picture.primitives)
      picture.primitives = drawer_.primitivesOf(picture);
    for (Picture& panel : picture.panels)
      if (frames > 1 && !panel.primitives) panel.primitives = drawer_.primitivesOf(panel);
    Picture frame = frames > 1 ? picture : std::move(picture);  // its molecules go once they are primitives
    if (i % frames > 0) frame.exported.clear();                 // one mesh, however often it turns
    if (options_.turntable > 0) turn(frame, static_cast<int>(i % frames), options_, pattern_);
    drawing = frame.result();
    if (sceneWriter_) sceneWriter_->add(frame);
    if (film) {
      drawer_.drawTo(std::move(frame), *film, fmt::format("{} {}/{}", options_.output, i + 1, count));
      continue;
    }
    if (!(options_.resume && manifest_->isDone(prepared.key, frame.result())))
      drawOne(std::move(frame), prepared, count, start);
    start = Clock::now();
  }
  if (film && !interrupted()) film->finish();
  if (film && manifest_ && !interrupted())
    manifest_->add({input.file, filmName, prepared.key, 1, millisecondsSince(start), made.unsupported, ""});
}

void RenderRun::drawOne(Picture picture, const Prepared& prepared, std::size_t count,
                        Clock::time_point start) {
  ManifestEntry entry{picture.input, picture.result(), prepared.key, count, 0, prepared.made.unsupported, ""};
  try {
    drawer_.watch();
    drawer_.draw(std::move(picture));
  } catch (const GraphicsError&) {
    throw;
  } catch (const Error& error) {
    if (!many_) throw;
    entry.error = error.what();
  } catch (const std::bad_alloc&) {
    if (!many_) throw;
    entry.error = fmt::format("'{}': not enough memory; draw fewer atoms or a smaller picture", entry.output);
  }
  entry.milliseconds = millisecondsSince(start);
  if (!entry.error.empty()) report_.failures.push_back(entry.error);
  if (manifest_) manifest_->add(entry);
}

void RenderRun::showNotes(const Input& input, const Preparation& made) {
  constexpr std::size_t kMostNotes = 5;
  if (options_.quiet) return;
  progress_.clear();
  for (std::size_t i = 0; i < made.notes.size() && i < kMostNotes; ++i)
    std::fprintf(stderr, "meniscus: %s: note: %s\n", input.file.c_str(), made.notes[i].c_str());
  if (made.notes.size() > kMostNotes)
    std::fprintf(stderr, "meniscus: %s: note: ... and %zu more (meniscus info %s shows all)\n",
                 input.file.c_str(), made.notes.size() - kMostNotes, input.file.c_str());
  // These begin with the file's name and the place; nothing of a scene is left out without a word.
  for (const std::string& line : made.unsupported) std::fprintf(stderr, "meniscus: %s\n", line.c_str());
}

void RenderRun::finishReport() {
  if (!options_.explain && options_.statsFile.empty()) return;
  drawer_.finishReport();
  addProcessUsage(report_);
  if (options_.explain) std::fputs(explanationOf(report_).c_str(), stdout);
  if (!options_.statsFile.empty()) writeTextFile(options_.statsFile, statsAsJson(report_));
}

}  // namespace

int runRender(const std::vector<std::string>& arguments) {
  const std::optional<RenderOptions> options = parseRenderOptions(arguments);
  return options ? RenderRun(*options).run() : 0;
}

}  // namespace meniscus

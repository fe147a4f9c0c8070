#include "app/view/picture_worker.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <new>
#include <utility>

#include "app/picture_drawer.h"
#include "app/scene/mvs_scene.h"
#include "app/scene/settings.h"
#include "app/structure_pictures.h"
#include "app/view/moving_quality.h"
#include "core/buffer_sink.h"
#include "core/error.h"
#include "io/file_bytes.h"

namespace meniscus {
namespace {

using Clock = std::chrono::steady_clock;

// A preview costs about as much as a sample, and the window as much again.
constexpr std::chrono::milliseconds kBetweenPreviews{200};

/// Thrown by a picture that is no longer wanted.
struct Superseded {};

// Options about the picture that decide what there is to draw or from where, too.
constexpr std::array<std::string_view, 7> kSceneToo{"background", "style",       "fov",     "orthographic",
                                                    "zoom",       "label-color", "outlines"};

// What the scene of a structure is made from; other options only say how it is drawn.
GivenOptions sceneOptions(GivenOptions given) {
  std::erase_if(given, [](const auto& option) {
    return option.first == "size" || option.first == "divider" ||
           (findSetting(SettingPlace::picture, option.first) &&
            std::find(kSceneToo.begin(), kSceneToo.end(), option.first) == kSceneToo.end());
  });
  return given;
}

// Where the line between two panels is decides nothing about them.
GivenOptions withoutDivider(GivenOptions given) {
  std::erase_if(given,
                [](const auto& option) { return option.first == "divider" || option.first == "size"; });
  return given;
}

Preparation preparePictures(const RenderOptions& options, const std::string& bytes) {
  if (options.scenes.empty()) return structurePictures(options.files.front(), bytes, options);
  MvsFile file(options.scenes.front(), {options.offline, options.cache});
  Preparation made = scenePictures(options.scenes.front(), file, options);
  if (options.strict) requireAllSupported(made);
  return made;
}

// The picture that a camera is fitted to, if none is given.
ImageSize fittedTo(const RenderOptions& options) {
  if (options.panels.empty()) return options.size;
  return placePanels(options.panels.size(), options.size, options.divider).front().picture;
}

RenderOptions timed(RenderOptions options) {
  options.explain = true;
  return options;
}

}  // namespace

// What the thread holds: all of it is made, used and destroyed there.
class PictureWorker::Drawing {
 public:
  explicit Drawing(PictureWorker& worker) : worker_(worker), base_(timed(worker.base_)) { renew(); }

  void serve(const ViewRequest& request);
  void save(std::uint64_t document, const std::vector<std::string>& arguments);
  /// After OpenGL failed: begins anew with the next picture.
  void renew() {
    drawer_.reset();
    drawer_ = std::make_unique<PictureDrawer>(base_, report_, progress_);
    drawer_->watch = [this] {
      if (interruptible_ && worker_.superseded(number_)) throw Superseded{};
    };
  }

 private:
  using Change = std::function<RenderOptions(RenderOptions)>;
  RenderOptions optionsFrom(const std::vector<std::string>& arguments) const;
  Preparation read(std::uint64_t document, const RenderOptions& options, bool reread);
  void prepare(const ViewRequest& request);
  const RenderOptions& optionsOf(const Picture& picture) const;
  std::vector<std::string> cutsOf(const Picture& picture, int most) const;
  ViewFrame draw(const ViewRequest& request, const Change& change, FrameStage stage);
  ViewFrame emptyFrame(const ViewRequest& request, const RenderOptions& options, FrameStage stage) const;
  void drawStill(const ViewRequest& request);
  Picture live(const Change& change) const;
  ViewHits hits(const ViewRequest& request);

  PictureWorker& worker_;
  const RenderOptions base_;
  RunReport report_;
  Progress progress_{false};
  std::unique_ptr<PictureDrawer> drawer_;
  std::uint64_t number_ = 0;
  bool interruptible_ = false;

  std::map<std::uint64_t, std::string> bytes_;  // structure files as they were read, by document
  std::vector<std::string> arguments_;          // of what is shown
  GivenOptions sceneOptions_, given_;
  ImageSize fit_, fitted_;  // what its camera is to be fitted to, and what preparation_'s was
  std::uint64_t document_ = 0;
  // Both are the window's, too, once they are published: never changed, only replaced.
  std::shared_ptr<const Preparation> preparation_;
  std::shared_ptr<const RenderOptions> options_;  // how a structure is drawn now; scenes say it themselves
  // Of its pictures, or of their panels, once they are wanted.
  std::vector<std::vector<std::shared_ptr<const Primitives>>> primitives_;
  std::size_t shown_ = 0;
  Camera camera_;
  QualityGovernor governor_;
};

// What is no part of a picture is said once, for all of them.
RenderOptions PictureWorker::Drawing::optionsFrom(const std::vector<std::string>& arguments) const {
  std::optional<RenderOptions> options = parseRenderOptions(arguments);
  if (!options) throw UsageError("--help: has no meaning in a window");
  options->offline = base_.offline;
  options->cache = base_.cache;
  options->strict = base_.strict;
  options->quadrics = base_.quadrics;
  return std::move(*options);
}

// A file that has gone since or is being written again stays what it was.
Preparation PictureWorker::Drawing::read(std::uint64_t document, const RenderOptions& options, bool reread) {
  std::string& known = bytes_[document];
  if (!options.scenes.empty() || (!reread && !known.empty())) return preparePictures(options, known);
  std::string bytes = readBytes(options.files.front());
  Preparation made = preparePictures(options, bytes);
  known = std::move(bytes);
  return made;
}

const RenderOptions& PictureWorker::Drawing::optionsOf(const Picture& picture) const {
  return options_ ? *options_ : picture.options;
}

// What is left out of a picture by so many cuts, or of any of its panels.
std::vector<std::string> PictureWorker::Drawing::cutsOf(const Picture& picture, int most) const {
  if (picture.panels.empty()) return possibleCuts(optionsOf(picture), most);
  std::vector<std::string> all;
  for (const Picture& panel : picture.panels)
    for (std::string& cut : possibleCuts(panel.options, most))
      if (std::find(all.begin(), all.end(), cut) == all.end()) all.push_back(std::move(cut));
  return all;
}

// Reads and builds again only what the options that changed are about.
void PictureWorker::Drawing::prepare(const ViewRequest& request) {
  const bool same = preparation_ && request.document == document_ && !request.reread;
  if (same && request.arguments == arguments_ && (request.camera || fit_ == fitted_)) return;
  auto options = std::make_shared<const RenderOptions>(optionsFrom(request.arguments));
  const bool structure = options->scenes.empty();
  GivenOptions sceneOptionsNow = sceneOptions(options->given);
  GivenOptions given = withoutDivider(options->given);
  const bool sameObjects =
      same && structure && sceneOptionsNow == sceneOptions_ && (options->panels.empty() || given == given_);
  const ImageSize fit = fittedTo(*options);
  if (!sameObjects || (!request.camera && fit != fitted_)) {
    auto made = std::make_shared<const Preparation>(read(request.document, *options, request.reread));
    if (!sameObjects) primitives_.assign(made->pictures.size(), {});
    preparation_ = std::move(made);
    fitted_ = fit;
    document_ = request.document;
    sceneOptions_ = std::move(sceneOptionsNow);
  }
  options_ = structure ? std::move(options) : nullptr;
  fit_ = fit;
  given_ = std::move(given);
  arguments_ = request.arguments;
  std::size_t cuts = 0;
  for (const Picture& picture : preparation_->pictures) {
    if (picture.panels.empty()) cuts = std::max(cuts, possibleCuts(optionsOf(picture)).size());
    for (const Picture& panel : picture.panels) cuts = std::max(cuts, possibleCuts(panel.options).size());
  }
  governor_.reset(static_cast<int>(cuts));
  worker_.publish([&](ViewUpdates& updates) {
    updates.preparation = preparation_;
    updates.options = options_;
    updates.document = document_;
  });
}

// Without what only files need; `change` says what of it is drawn.
Picture PictureWorker::Drawing::live(const Change& change) const {
  const auto bare = [&](const Picture& whole, const RenderOptions& options,
                        std::shared_ptr<const Primitives> primitives) {
    Picture picture;
    picture.input = whole.input;
    picture.options = change(options);
    picture.scene.labels = whole.scene.labels;
    picture.scene.background = whole.scene.background;
    picture.scene.camera = whole.scene.camera;
    picture.primitives = std::move(primitives);
    return picture;
  };
  const Picture& whole = preparation_->pictures[shown_];
  Picture picture = bare(whole, optionsOf(whole), primitives_[shown_].front());
  picture.scene.camera = camera_;
  for (std::size_t i = 0; i < whole.panels.size(); ++i)
    picture.panels.push_back(bare(whole.panels[i], whole.panels[i].options, primitives_[shown_][i]));
  return picture;
}

ViewFrame PictureWorker::Drawing::emptyFrame(const ViewRequest& request, const RenderOptions& options,
                                             FrameStage stage) const {
  ViewFrame frame;
  frame.request = request;
  frame.stage = stage;
  frame.size = options.size;
  frame.samples = options.samples;
  frame.camera = camera_;
  frame.pictureSize = optionsOf(preparation_->pictures[shown_]).size;
  frame.bounds = primitives_[shown_].front()->bounds();
  return frame;
}

ViewFrame PictureWorker::Drawing::draw(const ViewRequest& request, const Change& change, FrameStage stage) {
  drawer_->takeStats();  // of a picture that was given up
  Picture picture = live(change);
  ViewFrame frame = emptyFrame(request, picture.options, stage);
  frame.pixels.reserve(std::size_t{4} * static_cast<std::size_t>(frame.size.width) *
                       static_cast<std::size_t>(frame.size.height));
  BufferSink sink(frame.pixels);
  const Clock::time_point start = Clock::now();
  drawer_->drawTo(std::move(picture), sink, "");
  frame.milliseconds = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  frame.stats = drawer_->takeStats();
  report_ = {};
  return frame;
}

// A picture of many rays is shown as it becomes one. Panels are not, but first with one ray.
void PictureWorker::Drawing::drawStill(const ViewRequest& request) {
  const auto asItIs = [](RenderOptions options) { return options; };
  const auto oneRay = [](RenderOptions options) {
    options.samples = 1;
    return options;
  };
  interruptible_ = true;
  const Picture& picture = preparation_->pictures[shown_];
  const RenderOptions& options = optionsOf(picture);
  if (!picture.panels.empty() && options.samples > 1) {
    ViewFrame frame = draw(request, oneRay, FrameStage::refining);
    worker_.publish([&](ViewUpdates& updates) { updates.frame = std::move(frame); });
  }
  const Clock::time_point start = Clock::now();
  Clock::time_point next = start;
  if (picture.panels.empty())
    drawer_->preview = {[&] { return Clock::now() >= next; },
                        [&](int samples, std::span<const std::byte> rows) {
                          ViewFrame frame = emptyFrame(request, options, FrameStage::refining);
                          frame.samples = samples;
                          frame.pixels.assign(rows.begin(), rows.end());
                          const Clock::time_point now = Clock::now();
                          frame.milliseconds = std::chrono::duration<double, std::milli>(now - start).count();
                          worker_.publish([&](ViewUpdates& updates) { updates.frame = std::move(frame); });
                          next = now + kBetweenPreviews;
                        }};
  ViewFrame frame = draw(request, asItIs, FrameStage::full);
  drawer_->preview = {};
  worker_.publish([&](ViewUpdates& updates) { updates.frame = std::move(frame); });
  if (worker_.superseded(number_)) return;
  ViewHits seen = hits(request);
  worker_.publish([&](ViewUpdates& updates) { updates.hits = std::move(seen); });
}

ViewHits PictureWorker::Drawing::hits(const ViewRequest& request) {
  ViewHits hits{request.number, {}, preparation_, shown_, {}};
  Picture picture = live([](RenderOptions options) { return options; });
  if (picture.panels.empty()) {
    hits.image = drawer_->hits(picture);
  } else {
    const ImageSize size = picture.options.size;
    hits.places = placePanels(picture.panels.size(), size, picture.options.divider);
    hits.image.size = size;
    hits.image.id.assign(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height), 0);
    for (std::size_t i = 0; i < hits.places.size(); ++i) {
      const PanelPlace& place = hits.places[i];
      Picture& panel = picture.panels[i];
      panel.options.size = place.picture;
      panel.scene.camera = seenBy(camera_, panel.scene.camera);
      const HitImage own = drawer_->hits(panel);
      for (int y = place.y; y < place.y + place.height; ++y) {
        const int row = size.height - 1 - y, ownRow = place.picture.height - 1 - (y - place.pictureY);
        const auto from = own.id.begin() + static_cast<std::ptrdiff_t>(ownRow) * place.picture.width +
                          (place.x - place.pictureX);
        std::copy_n(from, place.width,
                    hits.image.id.begin() + static_cast<std::ptrdiff_t>(row) * size.width + place.x);
      }
    }
  }
  drawer_->takeStats();
  return hits;
}

void PictureWorker::Drawing::serve(const ViewRequest& request) {
  number_ = request.number;
  interruptible_ = false;
  drawer_->preview = {};
  prepare(request);
  shown_ = std::min(request.shown, preparation_->pictures.size() - 1);
  const Picture& picture = preparation_->pictures[shown_];
  if (primitives_[shown_].empty()) {
    std::vector<std::shared_ptr<const Primitives>> made;
    for (const Picture& panel : picture.panels) made.push_back(drawer_->primitivesOf(panel));
    if (made.empty()) made.push_back(drawer_->primitivesOf(picture));
    primitives_[shown_] = std::move(made);
  }
  camera_ = request.camera ? seenBy(*request.camera, picture.scene.camera) : picture.scene.camera;
  if (!request.moving) {
    drawStill(request);
    return;
  }
  const MovingQuality quality = governor_.quality();
  ViewFrame frame = draw(
      request, [&](RenderOptions o) { return reduced(std::move(o), quality); }, FrameStage::moving);
  governor_.measured(frame.milliseconds - frame.stats.compileMs, request.budgetMs);
  frame.leftOut = cutsOf(picture, quality.cuts);
  worker_.publish([&](ViewUpdates& updates) { updates.frame = std::move(frame); });
}

void PictureWorker::Drawing::save(std::uint64_t document, const std::vector<std::string>& arguments) {
  interruptible_ = false;
  drawer_->preview = {};
  const RenderOptions options = optionsFrom(arguments);
  Preparation made = read(document, options, false);
  for (Picture& picture : made.pictures) {
    const std::string name = picture.output;
    drawer_->draw(std::move(picture));
    worker_.publish([&](ViewUpdates& updates) { updates.messages.push_back("saved " + name); });
  }
  drawer_->takeStats();
  report_ = {};
}

PictureWorker::PictureWorker(const RenderOptions& base, std::function<void()> notify)
    : base_(base), notify_(std::move(notify)), thread_([this] { run(); }) {}

PictureWorker::~PictureWorker() {
  finish();
}

void PictureWorker::finish() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void PictureWorker::show(ViewRequest request) {
  {
    const std::lock_guard lock(mutex_);
    // A picture that is no longer wanted must not hide that its file is to be read again.
    request.reread = request.reread || (next_ && next_->document == request.document && next_->reread);
    next_ = std::move(request);
  }
  wake_.notify_one();
}

void PictureWorker::save(std::uint64_t document, std::vector<std::string> arguments,
                         std::vector<std::string> names) {
  {
    const std::lock_guard lock(mutex_);
    saves_.push_back({document, std::move(arguments), std::move(names)});
  }
  wake_.notify_one();
}

bool PictureWorker::promised(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  return std::any_of(saves_.begin(), saves_.end(), [&](const Save& save) {
    return std::find(save.names.begin(), save.names.end(), name) != save.names.end();
  });
}

ViewUpdates PictureWorker::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(updates_, {});
}

template <typename Change>
void PictureWorker::publish(Change change) {
  {
    const std::lock_guard lock(mutex_);
    change(updates_);
  }
  notify_();
}

bool PictureWorker::superseded(std::uint64_t number) const {
  const std::lock_guard lock(mutex_);
  return stop_ || (next_ && next_->number > number);
}

void PictureWorker::run() {
  Drawing drawing(*this);
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [this] { return stop_ || next_ || !saves_.empty(); });
    if (stop_ && saves_.empty()) return;
    const bool saves = !saves_.empty();
    Save save;
    ViewRequest request;
    if (saves) {
      save = saves_.front();
    } else {
      request = std::move(*std::exchange(next_, std::nullopt));
    }
    lock.unlock();
    std::string failure;
    try {
      if (saves) {
        drawing.save(save.document, save.arguments);
      } else {
        drawing.serve(request);
      }
    } catch (const Superseded&) {
      // The next request is there already.
    } catch (const GraphicsError& error) {
      failure = error.what();
      drawing.renew();
    } catch (const std::bad_alloc&) {
      failure = "not enough memory; draw fewer atoms or make the window smaller";
    } catch (const std::exception& error) {
      failure = error.what();
    }
    if (!failure.empty()) {
      publish([&](ViewUpdates& updates) {
        if (saves) {
          updates.messages.push_back(failure);
        } else {
          updates.failure = {request.number, request.reread, failure};
        }
      });
    }
    lock.lock();
    if (saves) saves_.pop_front();
  }
}

}  // namespace meniscus

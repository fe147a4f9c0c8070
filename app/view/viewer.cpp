#include "app/view/viewer.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "app/measurement.h"
#include "app/output_name.h"
#include "app/view/camera_moves.h"
#include "app/view/overlays.h"
#include "app/view/panels.h"
#include "core/camera_fit.h"

namespace meniscus {
namespace {

// Without a change for so long, a picture stands still and is drawn in full; longer while the mouse is held
// [s].
constexpr double kStill = 0.12, kStillHeld = 0.5;
// From an input to the picture of it [ms]: what the window leaves of it is the frame's.
constexpr double kLongestWait = 45, kLeastBudget = 12;
// The window is drawn so often after something happened: widgets answer to what they see one frame later.
constexpr int kRedraws = 2;

std::string baseName(const std::string& file) {
  return std::filesystem::path(file).filename().string();
}

ImageSize windowSizeFor(const RenderOptions& base) {
  // As wide as a panel more; a screen is seldom higher than that.
  return {std::min(base.size.width, 1600) + kPanelWidth, std::min(base.size.height, 1000)};
}

// For a pattern of names (app/output_name.h).
std::string withoutPlaceholders(const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped.append(c == '{' || c == '}' ? 2 : 1, c);
  return escaped;
}

}  // namespace

Viewer::Viewer(const RenderOptions& base, WindowContext context)
    : base_(base),
      window_("Meniscus (starting)", windowSizeFor(base), context),
      worker_(base, &Window::wake) {
  window_.onKey = [this](int key, bool control, bool shift) { handleKey(key, control, shift); };
  window_.onDrop = [this](const std::vector<std::string>& dropped) {
    for (const std::string& file : dropped) open(file);
  };
  for (const std::string& file : base.files) open(file, base.given);
  for (const std::string& scene : base.scenes) open(scene, base.given, true);
  current_ = 0;
  if (!window_.note().empty()) say(window_.note());
}

void Viewer::open(const std::string& file, const GivenOptions& given, bool isScene) {
  documents_.push_back({nextId_++, std::make_unique<Document>(file, given, isScene), nullptr, nullptr});
  current_ = documents_.size() - 1;
}

void Viewer::showDocument(std::size_t index) {
  if (index < documents_.size()) current_ = index;
  playing = false;
}

void Viewer::closeDocument(std::size_t index) {
  documents_.erase(documents_.begin() + static_cast<std::ptrdiff_t>(index));
  if (current_ >= index && current_ > 0) --current_;
}

void Viewer::run() {
  int redraws = kRedraws;
  while (!window_.closed()) {
    const double wait = redraws > 0 ? 0 : secondsToWait();
    window_.wait(wait);
    if (wait != 0) redraws = kRedraws;
    const bool wasDragging = dragging_;
    takeUpdates();
    advanceModels();
    submit();
    if (window_.minimized()) {
      redraws = 0;
      continue;
    }
    const bool fresh = frame_ && !frame_->pixels.empty();
    if (fresh) {
      texture_.set(frame_->size, frame_->pixels);
      frame_->pixels = {};
    }
    const Clock::time_point start = Clock::now();
    // While the mouse drags, the window only changes with the picture.
    const bool seen = fresh || !(wasDragging && dragging_ && frame_);
    window_.draw([this] { layOut(); }, seen);
    if (seen) latency_.drewWindow(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    if (fresh) {
      latency_.shown(frame_->request.number, frame_->stage == FrameStage::full);
      if (frame_->stage == FrameStage::moving) latency_.drew(frame_->milliseconds);
    }
    submit();
    if (--redraws > 0 && dragging_) redraws = 0;
    if (window_.answersNext()) redraws = kRedraws;
  }
  finishSaving();
}

// What was to be saved is, though the window is closed; what fails then is said where there still is a place.
void Viewer::finishSaving() {
  window_.hide();
  worker_.finish();
  for (const std::string& message : worker_.take().messages) {
    const bool isError = !message.starts_with("saved ");
    say(message, isError);
    if (isError) std::fprintf(stderr, "meniscus: %s\n", message.c_str());
  }
}

double Viewer::secondsToWait() const {
  const auto until = [](Clock::time_point when) {
    return std::max(1e-3, std::chrono::duration<double>(when - Clock::now()).count());
  };
  const bool arrived = frame_ && frame_->request.number == asked_.number;
  if (playing) return arrived ? until(nextModel_) : -1;
  if (asked_.moving) return until(lastChange_ + stillAfter());
  return -1;
}

Viewer::Clock::duration Viewer::stillAfter() const {
  return std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(dragging_ ? kStillHeld : kStill));
}

// Asks for a picture if what is to be seen is not what was asked for last.
void Viewer::submit() {
  if (documents_.empty() || size_.width < 1 || size_.height < 1) return;
  const Open& open = documents_[current_];
  const Document& document = *open.document;
  const bool same = asked_.number > 0 && asked_.document == open.id &&
                    askedRevision_ == document.revision() && askedOneByOne_ == document.oneByOne &&
                    asked_.shown == document.shown && !reread_ && !std::exchange(again_, false);
  ViewRequest request;
  request.arguments = preparationArguments(document, size_);
  const auto sameCamera = [](const std::optional<Camera>& a, const std::optional<Camera>& b) {
    if (!a || !b) return a.has_value() == b.has_value();
    return a->orientation == b->orientation && a->target == b->target && a->distance == b->distance &&
           a->nearest == b->nearest && a->farthest == b->farthest;
  };
  if (same && request.arguments == asked_.arguments && sameCamera(document.camera, asked_.camera)) {
    const bool still = Clock::now() - lastChange_ >= stillAfter();
    if (!(asked_.moving && still && !playing)) return;
    moving_ = false;
  } else {
    lastChange_ = Clock::now();
    wantedPick_.reset();  // in another picture
  }
  request.number = asked_.number + 1;
  request.document = open.id;
  request.camera = document.camera;
  request.shown = document.shown;
  request.moving = moving_ || playing;
  request.budgetMs = std::max(kLeastBudget, kLongestWait - latency_.recentWindowMs());
  request.reread = std::exchange(reread_, false);
  moving_ = false;
  askedRevision_ = document.revision();
  askedOneByOne_ = document.oneByOne;
  latency_.asked(request.number, request.moving);
  asked_ = request;
  hits_.reset();
  hover_.clear();
  worker_.show(std::move(request));
}

void Viewer::takeUpdates() {
  ViewUpdates updates = worker_.take();
  if (updates.preparation) {
    for (Open& open : documents_) {
      if (open.id != updates.document) continue;
      open.options = updates.options;
      if (open.made == updates.preparation) continue;
      open.made = updates.preparation;
      const std::vector<std::string>& unsupported = open.made->unsupported;
      if (!unsupported.empty())
        say(fmt::format("{} (and {} more that are not drawn)", unsupported.front(), unsupported.size() - 1));
      if (&open == &documents_[current_]) updatePicks(document()->picks, shownPicture()->scene);
    }
  }
  if (updates.frame) {
    frame_ = std::move(updates.frame);
    if (frame_->request.number == asked_.number && !documents_.empty())
      documents_[current_].drawnRevision = askedRevision_;
    if (Document* shown = document();
        shown && frame_->request.document == documents_[current_].id && shown->camera) {
      shown->camera->projection = frame_->camera.projection;
      shown->camera->fovY = frame_->camera.fovY;
      shown->camera->zoom = frame_->camera.zoom;
    }
    if (frame_->stage == FrameStage::full) {
      full_ = *frame_;
      full_->pixels = {};
    }
  }
  if (updates.hits && updates.hits->number == asked_.number) {
    hits_ = std::move(updates.hits);
    resolvePick();
  }
  for (const std::string& message : updates.messages) say(message, !message.starts_with("saved "));
  if (updates.failure) takeFailure(*updates.failure);
}

// A change that cannot be drawn is undone; a file that cannot be read is closed.
void Viewer::takeFailure(const ViewFailure& failure) {
  say(failure.message, true);
  if (failure.number != asked_.number || documents_.empty()) return;
  playing = false;
  const Open& open = documents_[current_];
  if (!open.made) {
    closeDocument(current_);
  } else if (failure.reread) {
    again_ = true;  // of what was read before
  } else if (askedRevision_ == open.drawnRevision || !open.document->undo()) {
    failed_ = failure.number;
  }
}

void Viewer::say(const std::string& message, bool isError) {
  message_ = message;
  messageIsError_ = isError;
  messages_.push_back(message);
}

bool Viewer::finished() const {
  return hits_ && hits_->number == asked_.number && frame_ && frame_->request.number == asked_.number;
}

const RenderOptions* Viewer::options() const {
  const Picture* shown = shownPicture();
  if (!shown) return nullptr;
  const Open& open = documents_[current_];
  return open.options ? open.options.get() : &shown->options;
}

const Picture* Viewer::shownPicture() const {
  const Preparation* made = preparation();
  if (!made) return nullptr;
  return &made->pictures[std::min(documents_[current_].document->shown, made->pictures.size() - 1)];
}

const Molecule* Viewer::molecule() const {
  const Picture* shown = shownPicture();
  return !shown || shown->scene.objects.empty() ? nullptr : shown->scene.objects.front().molecule.get();
}

std::optional<Camera> Viewer::camera() const {
  if (documents_.empty()) return std::nullopt;
  if (documents_[current_].document->camera) return documents_[current_].document->camera;
  if (frame_ && frame_->request.document == documents_[current_].id) return frame_->camera;
  return std::nullopt;
}

void Viewer::moveCamera(const Camera& camera) {
  if (!document()) return;
  document()->camera = camera;
  moving_ = true;
}

void Viewer::resetCamera() {
  if (document()) document()->camera.reset();
}

void Viewer::lookAlong(int axis) {
  std::optional<Camera> now = camera();
  const Picture* shown = shownPicture();
  if (!now || !shown) return;
  FitSpheres spheres;
  addFitSpheres(shown->scene.objects, spheres);
  now->orientation = axis < 0 ? principalAxes(spheres, size_.height > size_.width) : lookDownAxis(axis);
  document()->camera = now;
}

void Viewer::toggleOrthographic() {
  if (!document()) return;
  if (document()->has("orthographic")) {
    document()->remove("orthographic");
  } else {
    document()->set("orthographic", "");
  }
}

Viewer::Output Viewer::nextOutput() const {
  const Document& shown = *documents_[current_].document;
  // The pictures of several states tell themselves apart.
  const Preparation* made = preparation();
  const bool states = shown.isScene() && made && made->pictures.size() > 1;
  const std::string stem = withoutPlaceholders(stemOf(shown.file()));
  for (int i = 1;; ++i) {
    Output output{stem + (i == 1 ? "" : fmt::format("-{}", i)) + (states ? "-{state}.png" : ".png"), {}};
    const OutputPattern pattern(output.pattern);
    if (!states) output.names.push_back(pattern.nameFor(shown.file(), {}));
    for (std::size_t k = 0; states && k < made->pictures.size(); ++k)
      output.names.push_back(pattern.nameFor(shown.file(), made->pictures[k].place));
    if (std::none_of(output.names.begin(), output.names.end(), [&](const std::string& name) {
          return std::filesystem::exists(name) || worker_.promised(name);
        }))
      return output;
  }
}

std::vector<std::string> Viewer::argumentsFor(const std::string& output) {
  const Document& shown = *document();
  std::optional<int> model;
  std::optional<Camera> seen = shown.camera;
  // One camera suits all models; a model alone would get its own.
  if (shown.oneByOne && !shown.isScene()) seen = camera();
  if (seen && shown.isScene() && shownPicture()) seen = inPlaceOf(shownPicture()->scene.camera, *seen);
  if (shownPicture() && shown.oneByOne && !shown.isScene()) model = shownPicture()->place.model;
  return renderArguments(shown, seen, size_, output, model);
}

void Viewer::copyCommand() {
  if (!document() || size_.width < 1) return;
  window_.copy(commandLine(argumentsFor(nextOutput().pattern)));
  say("the command is on the clipboard");
}

void Viewer::copyMeasures() {
  if (!document()) return;
  std::string text;
  std::vector<glm::dvec3> points;
  for (const Pick& pick : document()->picks) {
    text += (text.empty() ? "" : " - ") + pick.name;
    points.push_back(pick.position);
  }
  if (points.size() >= 2) text += ": " + measureText(points);
  if (text.empty()) return;
  window_.copy(text);
  say("copied: " + text);
}

void Viewer::save() {
  if (!document() || size_.width < 1) return;
  Output output = nextOutput();
  say("saving " + output.pattern);
  worker_.save(documents_[current_].id, argumentsFor(output.pattern), std::move(output.names));
}

void Viewer::keepMeasure() {
  if (!document()) return;
  const std::optional<std::string> option = document()->measureOption();
  if (!option) {
    say("click two, three or four atoms first; those of copies and of further models are only shown");
    return;
  }
  if (document()->isScene()) {
    say("a scene file has no place for measures; they are shown as long as their atoms are picked");
    return;
  }
  std::vector<std::string> measures = document()->values("measure");
  measures.push_back(*option);
  document()->setAll("measure", measures);
  document()->picks.clear();
}

void Viewer::reread() {
  reread_ = true;
}

void Viewer::showModel(std::size_t index) {
  if (!document()) return;
  document()->shown = index;
  if (const Picture* shown = shownPicture()) updatePicks(document()->picks, shown->scene);
}

void Viewer::advanceModels() {
  const Preparation* made = preparation();
  if (!playing || !document() || !made || made->pictures.size() < 2) return;
  if (Clock::now() < nextModel_ || !frame_ || frame_->request.number != asked_.number) return;
  nextModel_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                  std::chrono::duration<double>(1 / modelsPerSecond));
  showModel((document()->shown + 1) % made->pictures.size());
}

void Viewer::layOut() {
  const ImageSize window = window_.size();
  const double left = panelsShown ? std::min<double>(panelWidth(*this), window.width - 1) : 0;
  area_ = {left, 0, std::max(1.0, window.width - left), std::max<double>(1, window.height)};
  const double scale = window_.pixelsPerUnit();
  size_ = {std::max(1, static_cast<int>(std::lround(area_.width * scale))),
           std::max(1, static_cast<int>(std::lround(area_.height * scale)))};
  const PicturePlace place{area_.x, area_.y, area_.height, scale};

  ImDrawList* background = ImGui::GetBackgroundDrawList();
  const auto at = [](double x, double y) { return ImVec2(static_cast<float>(x), static_cast<float>(y)); };
  const bool shown = frame_ && document() && frame_->request.document == documents_[current_].id;
  if (shown) {
    // A picture of another size, until that of this size is there, keeps its height.
    const double width = area_.height * frame_->pictureSize.width / frame_->pictureSize.height;
    const double x = area_.x + 0.5 * (area_.width - width);
    background->PushClipRect(at(area_.x, area_.y), at(area_.x + area_.width, area_.y + area_.height));
    background->AddImage(reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(texture_.name())),
                         at(x, area_.y), at(x + width, area_.y + area_.height));
    if (const auto now = camera()) {
      for (const Part& part : parts()) {
        const PicturePlace own{area_.x + part.corner.x / scale,
                               area_.y + area_.height - (part.corner.y + part.size.height) / scale,
                               part.size.height / scale, scale};
        drawPicks(document()->picks, *now, part.size, own, contentScale());
        if (document()->has("divider")) break;  // both lie in one place
      }
    }
    background->PopClipRect();
  } else if (!document()) {
    drawInvitation(place);
  }
  handleMouse();
  drawStatus(hover_,
             !document() || shown || !message_.empty() ? message_ : "reading " + baseName(document()->file()),
             messageIsError_, place);
  if (panelsShown) drawPanels(*this, window.height);
  if (budgetShown) drawBudget(*this, budgetShown);
  if (helpShown) drawHelp(helpShown);
  window_.setTitle(document() ? fmt::format("{} - Meniscus{}", baseName(document()->file()),
                                            finished()                 ? ""
                                            : failed_ == asked_.number ? " (failed)"
                                                                       : " (drawing)")
                              : "Meniscus");
}

std::string Viewer::statsAsJson() const {
  const auto json = [](const Latency::Summary& s) {
    return nlohmann::ordered_json{
        {"count", s.count}, {"median", s.median}, {"95_percent", s.share95}, {"most", s.most}};
  };
  nlohmann::ordered_json stats{{"window", window_.api()},
                               {"input_to_picture_ms", json(latency_.moving())},
                               {"still_to_full_ms", json(latency_.full())},
                               {"moving_frame_ms", json(latency_.frames())},
                               {"window_ms", json(latency_.windows())},
                               {"messages", messages_}};
  return stats.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace meniscus

#pragma once
// The viewer: documents, what is known of the picture that is shown, and what the window's input does to
// them. Widgets (panels.h, overlays.h) read it and call its actions; nothing that decides a picture lives in
// them.

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/view/latency.h"
#include "app/view/picture_worker.h"
#include "app/view/session.h"
#include "app/view/window.h"

namespace meniscus {

class Viewer {
 public:
  /// Opens a window whose picture has the options' size, and their files and scenes.
  Viewer(const RenderOptions& base, WindowContext context);
  /// Until the window is closed.
  void run();
  /// What happened, as JSON.
  std::string statsAsJson() const;

  // --- What is shown.
  Document* document() { return documents_.empty() ? nullptr : documents_[current_].document.get(); }
  /// The options of the picture that is shown; nothing before the first.
  const RenderOptions* options() const;
  const Preparation* preparation() const {
    return documents_.empty() ? nullptr : documents_[current_].made.get();
  }
  /// The first molecule of what is shown; nothing before it is read.
  const Molecule* molecule() const;
  const ViewFrame* frame() const { return frame_ ? &*frame_ : nullptr; }
  const ViewFrame* fullFrame() const { return full_ ? &*full_ : nullptr; }
  const Latency& latency() const { return latency_; }
  std::size_t documentCount() const { return documents_.size(); }
  std::size_t current() const { return current_; }
  const std::string& fileOf(std::size_t index) const { return documents_[index].document->file(); }
  std::optional<Camera> camera() const;  ///< nothing before the first picture
  ImageSize pictureSize() const { return size_; }
  std::string windowApi() const { return window_.api(); }
  double contentScale() const { return window_.contentScale(); }
  /// Whether the picture is what render writes, and can be asked what is seen in it.
  bool finished() const;

  // --- Actions.
  void open(const std::string& file, const GivenOptions& given = {}, bool isScene = false);
  void showDocument(std::size_t index);
  void moveCamera(const Camera& camera);
  void resetCamera();
  void lookAlong(int axis);  ///< 0, 1, 2: down x, y, z; -1: the flattest side to the viewer
  void toggleOrthographic();
  void copyCommand();
  void copyMeasures();
  void save();
  void keepMeasure();
  void reread();
  void showModel(std::size_t index);
  void say(const std::string& message, bool isError = false);

  // --- What is open in the window; no part of a picture.
  bool panelsShown = true, helpShown = false, budgetShown = false, playing = false;
  double modelsPerSecond = 4;
  std::string newSelection;  ///< that is being typed

 private:
  using Clock = std::chrono::steady_clock;
  struct Open {
    std::uint64_t id = 0;
    std::unique_ptr<Document> document;
    std::shared_ptr<const Preparation> made;
    std::shared_ptr<const RenderOptions> options;  ///< of all its pictures; nothing = each has its own
    std::uint64_t drawnRevision = 0;               ///< of the document's options, that could be drawn
  };
  /// Where the picture is in the window.
  struct Area {
    double x = 0, y = 0, width = 1, height = 1;
  };

  void layOut();
  void handleMouse();
  void handleDrag(const Camera& camera, glm::dvec2 from, glm::dvec2 to);
  void handleWheel(double steps);
  void handleKey(int key, bool control, bool shift);
  void dragLight(glm::dvec2 by);
  void takeUpdates();
  void takeFailure(const ViewFailure& failure);
  void finishSaving();
  void resolvePick();
  const Picture* shownPicture() const;  ///< nothing before the file is read
  std::uint32_t idAt(glm::dvec2 pixel) const;
  const Scene& sceneAt(glm::dvec2 pixel) const;  ///< of hits_
  std::optional<PlacedAtom> atomAt(glm::dvec2 pixel) const;
  glm::dvec2 cursor() const;  ///< in pixels of the picture
  /// A panel, or the whole picture: its size, and where its lower left corner is.
  struct Part {
    ImageSize size;
    glm::dvec2 corner{0.0};
  };
  std::vector<Part> parts() const;
  Part partAt(glm::dvec2 pixel) const;
  std::optional<double> dividerAt(glm::dvec2 pixel) const;
  void play();
  void advanceModels();
  void submit();
  double secondsToWait() const;
  Clock::duration stillAfter() const;
  void closeDocument(std::size_t index);
  /// Names that no file has and none will have that is still to be written.
  struct Output {
    std::string pattern;             ///< as -o
    std::vector<std::string> names;  ///< that come of it
  };
  Output nextOutput() const;
  std::vector<std::string> argumentsFor(const std::string& output);

  RenderOptions base_;
  Window window_;
  PictureWorker worker_;
  WindowTexture texture_;
  std::vector<Open> documents_;
  std::size_t current_ = 0;
  std::uint64_t nextId_ = 1;

  ImageSize size_{0, 0};  // before anything is laid out
  Area area_;
  std::optional<ViewFrame> frame_, full_;  // the newest, and the newest full one; without pixels
  std::optional<ViewHits> hits_;
  ViewRequest asked_;  // the newest request
  std::uint64_t askedRevision_ = 0;
  bool askedOneByOne_ = false;
  bool moving_ = false;  // the next request is one of several
  bool reread_ = false, again_ = false;
  std::uint64_t failed_ = 0;  ///< a request that cannot be drawn
  Clock::time_point lastChange_ = Clock::now(), nextModel_ = Clock::now();

  bool dragging_ = false, pressed_ = false, onDivider_ = false;
  glm::dvec2 pressedAt_{0.0}, lastCursor_{0.0};
  struct WantedPick {
    glm::dvec2 pixel;
    bool focus = false;
  };
  std::optional<WantedPick> wantedPick_;
  std::string hover_;
  std::string message_;
  bool messageIsError_ = false;
  std::vector<std::string> messages_;  // all of them
  Latency latency_;
};

}  // namespace meniscus

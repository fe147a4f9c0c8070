#pragma once
// Reads files and draws pictures on a thread of its own, with an OpenGL context of its own, by what `meniscus
// render` uses: the window never waits for either, and shows what render would write. Of several requests
// only the last counts; a still picture gives way to the next request within one of its samples.

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/panels.h"
#include "app/picture.h"
#include "core/hit_image.h"
#include "render/render_stats.h"

namespace meniscus {

struct ViewRequest {
  std::uint64_t number = 0;            ///< ascending
  std::uint64_t document = 0;          ///< whose file is shown
  std::vector<std::string> arguments;  ///< preparationArguments()
  std::optional<Camera> camera;        ///< nothing = as the options say
  std::size_t shown = 0;               ///< which of its pictures: a model, a state
  double budgetMs = 35;                ///< of a frame while moving
  bool moving = false;                 ///< soon followed by others: draw what can be drawn in time
  bool reread = false;                 ///< the file may have changed
};

enum class FrameStage : std::uint8_t {
  moving,    ///< reduced to what can be drawn in time
  refining,  ///< whole, with some of its rays
  full       ///< what render draws
};

struct ViewFrame {
  ViewRequest request;
  FrameStage stage = FrameStage::moving;
  ImageSize size;                 ///< of the pixels: smaller than the picture while moving
  std::vector<std::byte> pixels;  ///< RGBA, 8 bits, sRGB, rows from the top
  ImageSize pictureSize;
  Camera camera;
  BoundingSphere bounds;  ///< of all that is drawn
  double milliseconds = 0;
  int samples = 1;
  std::vector<std::string> leftOut;  ///< because of the time it takes
  RenderStats stats;
};

/// What is seen through each pixel of a full picture.
struct ViewHits {
  std::uint64_t number = 0;  ///< of the request
  HitImage image;
  std::shared_ptr<const Preparation> preparation;
  std::size_t shown = 0;
  std::vector<PanelPlace> places;  ///< of its panels, if it has some
};

/// A request that failed; what was shown before still is.
struct ViewFailure {
  std::uint64_t number = 0;  ///< of the request
  bool reread = false;       ///< what failed was to read the file again, or may have been
  std::string message;       ///< one line
};

struct ViewUpdates {
  std::optional<ViewFrame> frame;
  std::optional<ViewHits> hits;
  std::shared_ptr<const Preparation> preparation;  ///< if it or its options are new
  std::shared_ptr<const RenderOptions> options;    ///< of all its pictures; nothing = each has its own
  std::uint64_t document = 0;                      ///< whose
  std::optional<ViewFailure> failure;
  std::vector<std::string> messages;  ///< what became of pictures that were to be saved
};

class PictureWorker {
 public:
  /// The backend and shaders are taken from `base`. `notify` is called from the thread when there is
  /// something to take().
  PictureWorker(const RenderOptions& base, std::function<void()> notify);
  ~PictureWorker();
  PictureWorker(const PictureWorker&) = delete;
  PictureWorker& operator=(const PictureWorker&) = delete;

  void show(ViewRequest request);
  /// Draws and writes as `meniscus render` with these arguments does, of the file as it was read for the
  /// document. `names`: of the files that come of it.
  void save(std::uint64_t document, std::vector<std::string> arguments, std::vector<std::string> names);
  /// Whether a file of this name is still to be written by save().
  bool promised(const std::string& name) const;
  ViewUpdates take();
  /// Writes what is still to be saved, and ends the thread; nothing is drawn after it.
  void finish();

 private:
  class Drawing;
  struct Save {
    std::uint64_t document = 0;
    std::vector<std::string> arguments, names;
  };
  void run();
  template <typename Change>
  void publish(Change change);
  bool superseded(std::uint64_t number) const;

  const RenderOptions base_;
  std::function<void()> notify_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<ViewRequest> next_;
  std::deque<Save> saves_;  // the first may be on its way
  ViewUpdates updates_;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace meniscus

#pragma once
// Draws pictures, one after the other, with one OpenGL context and its compiled shaders, which are made when
// the first picture is ready: what is wrong with an input or an output is said without waiting for them.

#include <filesystem>
#include <functional>
#include <map>
#include <memory>

#include "app/panels.h"
#include "app/picture.h"
#include "app/progress.h"
#include "app/run_report.h"
#include "render/gl/context.h"
#include "render/renderer.h"

namespace meniscus {

/// The effects of a picture with these options, and its light.
RenderSettings renderSettingsOf(const RenderOptions& options);
Lighting lightOf(const RenderOptions& options);

class PictureDrawer {
 public:
  /// The backend, the shaders and what is timed are taken from `options`.
  PictureDrawer(const RenderOptions& options, RunReport& report, Progress& progress)
      : options_(options), report_(report), progress_(progress) {}

  /// Called now and then while a picture is drawn; what it throws ends the picture, of which nothing is left.
  std::function<void()> watch;

  /// Of pictures that drawTo() draws and that have no panels.
  PicturePreview preview;

  /// Writes the picture's files. Throws Error; then nothing is written.
  void draw(Picture picture);
  /// The same, but the picture's rows to `sink` as 8-bit sRGB; progress says `label`.
  void drawTo(Picture picture, RowSink& sink, const std::string& label);
  /// What the rays through the pixels' centres meet of a picture with primitives: atoms' ids.
  HitImage hits(const Picture& picture);
  /// What was done since this was asked last.
  RenderStats takeStats();
  /// What the picture's scene becomes, for several pictures of it.
  std::shared_ptr<const Primitives> primitivesOf(const Picture& picture);
  /// Fills in what the report knows of the context and the renderer.
  void finishReport();

 private:
  using Environments = std::map<std::filesystem::path, std::shared_ptr<const EnvironmentMap>>;

  void readEnvironments(const Picture& picture);
  void exportMesh(Picture& picture);
  PictureReport render(Picture& picture, RowSink& sink, const PixelLayout& layout, const std::string& label);
  PictureReport renderPanels(Picture& picture, RowSink& sink, const std::string& label);
  void renderErrors(const Picture& picture, const PanelPlace& place, PanelCanvas& canvas);
  /// What the rays of a camera meet of a picture with primitives.
  HitImage cast(const Picture& picture, const Camera& camera, ImageSize size, const HitChannels& channels);
  void show(std::shared_ptr<const Primitives> primitives);
  Renderer& renderer();

  const RenderOptions& options_;
  RunReport& report_;
  Progress& progress_;
  Environments environments_;                // of the picture
  std::shared_ptr<const Primitives> shown_;  // what the renderer holds
  std::unique_ptr<Context> context_;
  std::unique_ptr<Renderer> renderer_;
};

}  // namespace meniscus

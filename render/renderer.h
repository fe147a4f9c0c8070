#pragma once
// Draws Primitives as seen from a View. buildFrame() in renderer_frame.cpp reads as the list of passes.

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/hit_image.h"
#include "core/image.h"
#include "core/label_sprite.h"
#include "core/primitives.h"
#include "core/render_settings.h"
#include "core/scene.h"
#include "core/view.h"
#include "render/render_stats.h"

namespace meniscus {

struct RendererOptions {
  std::filesystem::path shaderDir;  ///< read shaders from here instead of those in the binary; empty = binary
  bool timePasses = false;          ///< waits for the GPU after every pass to know its time
  int maxTileSize = 0;  ///< largest side of what is drawn at once [pixels]; 0 = what the driver allows
  /// Whether the processor computes the effects that it can (core/effects/); nothing: if OpenGL runs on it.
  std::optional<bool> effectsOnProcessor = {};
};

/// Channels of a HitImage that are wanted.
struct HitChannels {
  bool distance = true, normal = false, id = true;
};

/// Where rays cross translucent surfaces, in front of what is opaque.
struct SurfaceLayerImage {
  std::array<HitImage, 4> layers;   ///< the first, second, ... crossing
  std::vector<std::uint32_t> rest;  ///< how many more there are, row by row
};

/// Between two samples of a picture that is drawn in one tile without data layers: whether the mean of those
/// so far is `wanted`, and if so that, as the rows of the whole picture from the top.
struct PicturePreview {
  std::function<bool()> wanted;
  std::function<void(int samples, std::span<const std::byte> rows)> show;
};

/// Gets the number of quadrics that copies of units come to.
using CopyGuard = std::function<void(const QuadricCounts&)>;

/// Needs a current OpenGL 4.5 core context for its whole life.
class Renderer {
 public:
  explicit Renderer(const RendererOptions& options = {});
  ~Renderer();

  /// What to draw from now on. Uploads only when a frame needs it. Throws InputError if a number is not
  /// finite.
  void setPrimitives(std::shared_ptr<const Primitives> primitives);

  /// From now on called before copies of units are put into memory one by one (casting from tiles does
  /// without), with how many quadrics that makes. What it throws ends the picture.
  void setCopyGuard(CopyGuard guard);

  /// Labels of the pictures from now on.
  void setLabels(std::vector<LabelSprite> labels, const LabelColors& colors);

  /// Of the pictures from now on; empty functions = none.
  void setPreview(PicturePreview preview);

  /// Draws a picture of view.size and hands its rows to `sink` from the top. What `layout` leaves out is not
  /// computed. `progress` gets the finished share 0..1; what it throws ends the picture.
  void renderPicture(const View& view, const Lighting& lighting, const Background& background,
                     const RenderSettings& settings, const PixelLayout& layout, RowSink& sink,
                     const std::function<void(double)>& progress = {});

  /// Draws what the rays through the pixels' centres meet: no shading, nothing that was not asked for.
  HitImage renderHits(const View& view, HitChannels channels, const SurfaceSettings& surface = {},
                      QuadricMethod quadrics = QuadricMethod::automatic);

  /// Draws the layers of translucent surfaces (`surface.opacity` below 1) alone, up to the largest target of
  /// the driver.
  SurfaceLayerImage renderLayers(const View& view, const SurfaceSettings& surface);

  RenderStats stats() const;
  /// Counts and times start anew.
  void forgetStats();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meniscus

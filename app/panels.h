#pragma once
// Several pictures of one input, seen by one camera, in one: beside each other, or on both sides of a
// divider.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/label_sprite.h"
#include "core/scene.h"
#include "core/view.h"

namespace meniscus {

inline constexpr std::size_t kMostPanels = 4;

/// What a panel has of its own.
struct PanelOptions {
  std::string label;                   ///< empty = none
  std::vector<std::string> arguments;  ///< of `meniscus render`, after those that all panels share
  bool error = false;                  ///< shows how far the second panel is from the first, in false colour
};

/// "[LABEL: ]OPTIONS", the name of a representation, or "error". Throws UsageError.
PanelOptions parsePanel(std::string_view option, std::string_view value);

/// Where a panel is in the whole picture, pixels from its upper left corner.
struct PanelPlace {
  int x = 0, y = 0, width = 1, height = 1;  ///< what is seen
  ImageSize picture;                        ///< the panel's own picture, of which that is a part
  int pictureX = 0, pictureY = 0;           ///< its upper left corner
  bool holds(double atX, double atY) const {
    return atX >= x && atY >= y && atX < x + width && atY < y + height;
  }
};

/// Beside each other (two, three) or two by two, along the longer side, with a line between them; with
/// `divider` (0..1) two pictures of the whole size, the first left of it and the second right of it.
std::vector<PanelPlace> placePanels(std::size_t count, ImageSize whole, std::optional<double> divider);

/// Between a panel's edges and its label [pixels].
int labelMargin(const PanelPlace& place);

/// The viewpoint of one camera (orientation, target, distance, nearest, farthest) and the lens of another.
Camera seenBy(const Camera& viewpoint, Camera lens);

/// A picture under construction: RGBA, 8 bits, rows from the top.
class PanelCanvas {
 public:
  explicit PanelCanvas(ImageSize size);
  /// The part of a panel's picture that is seen.
  void paste(const PanelPlace& place, std::span<const std::byte> picture);
  /// In the upper left corner of a panel.
  void write(const PanelPlace& place, const LabelSprite& label, const LabelColors& colors);
  /// At a place in a panel, pixels from its upper left corner.
  void write(const PanelPlace& place, const LabelSprite& label, const LabelColors& colors, int left, int top);
  /// A small picture of `width` by `height` pixels there, RGBA, 8 bits, rows from the top.
  void paste(const PanelPlace& place, std::span<const std::byte> picture, int width, int height, int left,
             int top);
  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::byte* at(int x, int y);
  ImageSize size_;
  std::vector<std::byte> bytes_;
};

}  // namespace meniscus

#pragma once
// How far what one panel shows is from what another shows, in false colour.

#include <cstddef>
#include <string>
#include <vector>

#include "app/panels.h"
#include "app/render_options.h"
#include "core/hit_image.h"
#include "core/scene.h"

namespace meniscus {

/// Ends of the scale [Å], which is logarithmic; what is nearer or farther has the colour of the end.
inline constexpr double kLeastError = 1e-6, kMostError = 1;
/// Of pixels in which only the first, or only the second shows something.
inline constexpr Rgb kMissedColor = 0xFF00C8, kFalseColor = 0xFF6A00;

/// Of a distance [Å] between what two panels show: viridis (van der Walt and Smith, CC0), which also those
/// read who tell few colours apart.
Rgb errorColor(double distance);

struct ErrorPicture {
  std::vector<std::byte> pixels;          ///< RGBA, 8 bits, rows from the top
  std::size_t missed = 0, falseHits = 0;  ///< pixels
  double distanceP99 = 0, largest = 0;    ///< [Å] along the rays, of pixels in which both show something
  /// In words, a line each.
  std::vector<std::string> summary() const;
};

/// Hits of the same rays, `size` pixels each: of `picture`, against those of `truth`.
ErrorPicture drawErrors(const HitImage& picture, const HitImage& truth, const Background& background);

/// The scale, `width` by `height` pixels, small on the left: RGBA, 8 bits, rows from the top.
std::vector<std::byte> drawErrorScale(int width, int height);

/// The picture in its panel, with its summary below the label and the scale along the lower edge.
void drawErrorPanel(const ErrorPicture& errors, const RenderOptions& options, const PanelPlace& place,
                    PanelCanvas& canvas);

}  // namespace meniscus

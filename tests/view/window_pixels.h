#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace meniscus::test {

/// What a window shows.
struct WindowPixels {
  int width = 0, height = 0;
  std::vector<std::uint32_t> rgb;  ///< 0xRRGGBB, rows from the top
  bool operator==(const WindowPixels&) const = default;
  /// From `left` to the right edge.
  WindowPixels rightOf(int left) const;
};

/// Asks the display for them; empty where there is no such display. The window has to be within the screen,
/// whose pixels have 24 bits.
WindowPixels pixelsOf(const std::string& display, unsigned long window);

}  // namespace meniscus::test

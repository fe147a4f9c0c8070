#pragma once
// A picture's G-buffer in main memory, as effects read it that the processor computes where OpenGL itself
// runs on the processor: vectors of pixels there take a fraction of the time that shaders do.

#include <cstdint>
#include <span>
#include <vector>

#include "core/shared_math.h"

namespace meniscus::effects {

/// A rectangle of the target, rows from the bottom, in the formats of render/gbuffer.h.
struct SurfacePlanes {
  f32::ViewBlock view{};  ///< of the target
  int x = 0, y = 0;       ///< the rectangle's lower left corner in the target
  int width = 0, height = 0;
  /// Each with room for another kMostLanes beyond the last pixel.
  std::span<const float> depth;           ///< 0 = background
  std::span<const std::uint32_t> albedo;  ///< bytes R, G, B; empty where nothing is shaded
  std::span<const std::uint32_t> normal;  ///< octahedral, 16 bits each, x in the lower
  std::span<const std::uint32_t> id;      ///< empty where no effect asks for it

  /// Index of a row's first pixel.
  std::size_t rowStart(int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width);
  }
  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

inline constexpr std::size_t kMostLanes = 16;

/// A share of 0..1 for each pixel, as R16 textures store it.
using Shares = std::vector<std::uint16_t>;

}  // namespace meniscus::effects

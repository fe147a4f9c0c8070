#pragma once
// Deferred shading and the mean of samples: shaders/post/shade.frag and resolve.frag for vectors of pixels.

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "core/effects/surface_planes.h"
#include "core/image.h"

namespace meniscus::effects {

/// ShadeUniforms of shaders/include/lighting.glsl, in the layout std140.
struct ShadeBlock {
  glm::vec4 key, fill, ambient, backdrop, fog, line, unsharp;
  std::array<glm::vec4, 256> linear;
};

/// What other passes found out of each pixel of the planes (render/post/shade.h); those that are empty take
/// no part.
struct LightPlanes {
  std::span<const std::uint16_t> visibility;  ///< share of the key light that arrives
  std::span<const std::uint32_t> occlusion;   ///< what is hidden of the sky, and the sky: 16 bits each
  std::span<const float> difference;          ///< in depth from the surroundings
  std::span<const std::uint16_t> lines;       ///< share of the pixel that is line
  std::span<const float> traced;          ///< 4 per pixel: light of mirrors and glass, share left of the rest
  std::span<const std::uint16_t> labels;  ///< 4 per pixel: premultiplied, over everything
};

/// Premultiplied linear light of samples, added up, of a rectangle of the target.
struct LightSum {
  int x = 0, y = 0, width = 0, height = 0;
  std::vector<float> red, green, blue, alpha;

  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// Adds a sample to the sum; the first replaces what is there. Every sample's planes are of one rectangle.
void addLight(const SurfacePlanes& planes, const ShadeBlock& block, const LightPlanes& light, bool first,
              LightSum& sum);

/// Where a picture's pixels go.
struct PictureRows {
  int x = 0, y = 0, width = 0, height = 0;  ///< a rectangle of the target
  PixelFormat format = PixelFormat::rgba8;
  std::byte* first = nullptr;  ///< of the lowest row
  std::size_t rowBytes = 0;    ///< from a row to the one above it
};

/// The mean of the samples over the backdrop; it covers what lies outside of the sum's rectangle, too.
void writePicture(const LightSum& sum, int samples, const glm::vec4& backdrop, const PictureRows& out);

/// The same of one sample that nothing is added to.
void shadePicture(const SurfacePlanes& planes, const ShadeBlock& block, const LightPlanes& light,
                  const PictureRows& out);

}  // namespace meniscus::effects

#pragma once
// How much of the key light reaches each pixel: shaders/include/shadow.glsl for vectors of pixels.

#include <array>
#include <glm/vec4.hpp>
#include <span>

#include "core/effects/surface_planes.h"
#include "core/render_settings.h"

namespace meniscus::effects {

/// ShadowUniforms of shaders/include/shadow.glsl, in the layout std140.
struct ShadowFilter {
  glm::vec4 rowX, rowY, rowZ, map, filter;
  std::array<std::uint32_t, kMaxShadowSamples> offsets;
};

/// map: the shadow map's heights, rows from the bottom; soft: over the filter's disc, otherwise between the
/// four nearest texels. visibility: 0 on the background.
void lookUpShadow(const SurfacePlanes& planes, const ShadowFilter& filter, std::span<const float> map,
                  bool soft, Shares& visibility);

}  // namespace meniscus::effects

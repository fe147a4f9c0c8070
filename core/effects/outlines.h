#pragma once
// Silhouettes, creases and lines between groups of atoms: shaders/post/silhouette.frag and
// silhouette_line.frag for vectors of pixels.

#include <glm/vec4.hpp>
#include <span>

#include "core/effects/surface_planes.h"

namespace meniscus::effects {

/// SilhouetteUniforms of shaders/include/outline.glsl, in the layout std140.
struct OutlineBlock {
  glm::vec4 step, crease;
};

struct OutlineGroups {
  bool differ = false;                  ///< whether lines go between groups at all
  std::span<const std::uint32_t> byId;  ///< empty = every id for itself
};

/// lines: share of each pixel that is line.
void drawOutlines(const SurfacePlanes& planes, const OutlineBlock& block, const OutlineGroups& groups,
                  bool creases, Shares& lines);

}  // namespace meniscus::effects

#pragma once
// A View in the form in which shaders take it.

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/shared_math.h"
#include "core/view.h"

namespace meniscus {

/// Part of a picture that is drawn at once: pixel coordinates of its lower left corner, and size.
struct Tile {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const Tile&) const = default;
};

/// primitivesOrigin: Primitives::origin; sampleShift: sampleOffset(). Numbers are split so that hi + lo
/// carries at least the double's first 36 bits.
f32::ViewBlock makeViewBlock(const View& view, const glm::dvec3& primitivesOrigin, const Tile& tile,
                             glm::vec2 sampleShift);

}  // namespace meniscus

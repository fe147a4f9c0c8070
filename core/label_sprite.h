#pragma once
// Labels as pictures of text, at the size in which they are shown.

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/scene.h"

namespace meniscus {

/// How a pixel of a label is covered, 0..255: by its letters, and by the seam around them.
struct LabelTexel {
  std::uint8_t text = 0, seam = 0;
};

struct LabelSprite {
  Label label;  ///< where it is
  int width = 0, height = 0;
  std::vector<LabelTexel> texels;  ///< rows from the top
};

struct LabelColors {
  Rgb text = 0x000000, seam = 0xFFFFFF;
};

}  // namespace meniscus

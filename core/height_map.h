#pragma once
// Balls seen from above as the highest points of texels, a vector of texels at a time.

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "core/primitives.h"

namespace meniscus {

/// Heights above a far plane, in slabs by what a primitive's centre lies in, rows from the bottom.
struct HeightMap {
  int width = 0, height = 0, slabs = 1;
  float texel = 0;       ///< side [Å]
  float perSlab = 0;     ///< slabs per Å
  float perStep = 0;     ///< units of a height per Å
  glm::mat3 turn{1.0f};  ///< from a primitive's coordinates to texels, texels, Å above the far plane
  glm::vec3 shift{0.0f};
  std::uint16_t* heights = nullptr;  ///< 0 = nothing there; with room for another kBeyond

  static constexpr std::size_t kBeyond = 16;

  std::uint16_t* slabOf(float z) const;
};

/// Texels whose centres lie within `reach` of a place, of so many.
struct TexelRange {
  int first, last;
  TexelRange(float place, float reach, int size);
};

/// The same bits by every instruction set.
void raiseBalls(const HeightMap& map, std::span<const SpherePrimitive> balls);

}  // namespace meniscus

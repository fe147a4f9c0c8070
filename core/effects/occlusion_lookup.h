#pragma once
// What is hidden of the sky: shaders/post/occlusion.frag and occlusion_gather.frag for vectors of pixels.

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "core/effects/surface_planes.h"
#include "core/occlusion_maps.h"

namespace meniscus::effects {

/// A direction as shaders/include/occlusion.glsl takes it.
struct OcclusionDirection {
  /// Camera's view space -> texels, texels, height above the map's far plane [Å].
  glm::vec4 rowX, rowY, rowZ;
  glm::ivec4 map;  ///< first texel, width, height, slabs
};

/// Side of the block of pixels that share the directions of a frame.
inline constexpr int kOcclusionBlock = 4;
/// How far a pixel looks where they do [pixels].
inline constexpr int kOcclusionReach = kOcclusionBlock - 1;

/// Which part of the directions a pixel of a block looks along, of so many parts, a power of two.
int occlusionPartOf(glm::ivec2 inBlock, int parts);

/// What a frame's pixels look along, and what they see there.
struct OcclusionLook {
  glm::vec4 slab{0.0f}, fade{0.0f};            ///< as in shaders/include/occlusion.glsl
  std::vector<OcclusionDirection> directions;  ///< part after part
  int parts = 1;        ///< into which the pixels of a block divide them; 1 = each takes all
  glm::ivec2 phase{0};  ///< place of the target's corner in its block
  std::span<const OcclusionTexel> texels;
};

/// occlusion: of each pixel what is hidden of the sky, and the sky, in one unit, as RG16 textures store it
/// (both 0 on the background). Which neighbours share their directions depends on the target alone.
void lookUpOcclusion(const SurfacePlanes& planes, const OcclusionLook& look,
                     std::vector<std::uint32_t>& occlusion);

}  // namespace meniscus::effects

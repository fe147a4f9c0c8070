#pragma once
// Depth blurred minus depth: shaders/post/depth_unsharp*.frag on the processor.

#include <array>
#include <glm/vec4.hpp>
#include <vector>

#include "core/effects/surface_planes.h"

namespace meniscus::effects {

inline constexpr std::size_t kMostUnsharpTaps = 20;

/// DepthUnsharpUniforms of shaders/include/depth_unsharp.glsl, in the layout std140.
struct DepthUnsharpBlock {
  glm::ivec4 grid;  ///< picture's pixel at the target's corner; side of a block [pixels]; taps
  std::array<float, kMostUnsharpTaps> taps;  ///< half a Gaussian, from its middle
};

/// difference: how much nearer than its surroundings each pixel lies, as a share of the scene's depth range;
/// 0 on the background.
void unsharpDepth(const SurfacePlanes& planes, const DepthUnsharpBlock& block,
                  std::vector<float>& difference);

}  // namespace meniscus::effects

#pragma once
// Depth as a share of the scene's depth range: nearness() of shaders/include/scene_depth.glsl.

#include "core/shared_math.h"

namespace meniscus::effects {

/// Of a value d of the depth buffer, 0 on the far plane, 1 on the near plane: d factor / (d + added) in
/// perspective, d factor otherwise.
struct Nearness {
  bool perspective;
  float factor, added;

  explicit Nearness(const f32::ViewBlock& view) : perspective(view.scale.z > 0.5f), added(view.depthMap.x) {
    const float range = view.depth.z - view.depth.w;
    factor = perspective ? (view.depth.x - view.depth.w) / range : 1 / (view.depthMap.x * range);
  }
};

}  // namespace meniscus::effects

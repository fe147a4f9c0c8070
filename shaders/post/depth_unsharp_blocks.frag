#version 450 core
// Sum of what is nearer than the far plane, and number, of a block's surface pixels, as shares of the block.
#include "include/view.glsl"
#include "include/scene_depth.glsl"
#include "include/depth_unsharp.glsl"

layout(binding = 0) uniform sampler2D tDepth;

layout(location = 0) out vec2 oSum;

void main() {
  ivec2 corner = (ivec2(gl_FragCoord.xy) + firstBlock()) * uGrid.z - uGrid.xy;
  ivec2 low = max(corner, ivec2(0));
  ivec2 high = min(corner + uGrid.z, textureSize(tDepth, 0));
  vec2 sum = vec2(0.0);
  for (int y = low.y; y < high.y; ++y) {
    for (int x = low.x; x < high.x; ++x) {
      float depth = texelFetch(tDepth, ivec2(x, y), 0).r;
      if (depth > 0.0) sum += vec2(nearness(depth), 1.0);
    }
  }
  oSum = sum / float(uGrid.z * uGrid.z);
}

#version 450 core
// flags: VERTICAL
// One direction of the Gaussian. What lies outside the picture or shows the background has no weight.
#include "include/depth_unsharp.glsl"

layout(binding = 0) uniform sampler2D tBlocks;

layout(location = 0) out vec2 oSum;

void main() {
#ifdef VERTICAL
  const ivec2 along = ivec2(0, 1);
#else
  const ivec2 along = ivec2(1, 0);
#endif
  ivec2 at = ivec2(gl_FragCoord.xy);
  ivec2 size = textureSize(tBlocks, 0);
  int place = at.x * along.x + at.y * along.y;
  int last = (size.x * along.x + size.y * along.y) - 1;
  oSum = texelFetch(tBlocks, at, 0).xy * uTaps[0].x;
  for (int i = 1; i < uGrid.w; ++i) {
    float weight = uTaps[i >> 2][i & 3];
    if (place >= i) oSum += texelFetch(tBlocks, at - i * along, 0).xy * weight;
    if (place + i <= last) oSum += texelFetch(tBlocks, at + i * along, 0).xy * weight;
  }
}

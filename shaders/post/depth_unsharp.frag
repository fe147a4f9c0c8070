#version 450 core
// Luft, Colditz, Deussen 2006: depth blurred minus depth. > 0: the pixel lies in front of its surroundings.
#include "include/view.glsl"
#include "include/scene_depth.glsl"
#include "include/depth_unsharp.glsl"

layout(binding = 0) uniform sampler2D tDepth;
layout(binding = 1) uniform sampler2D tBlurred;

layout(location = 0) out float oDifference;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float depth = texelFetch(tDepth, at, 0).r;
  // Between the centres of four blocks.
  vec2 place = (vec2(at + uGrid.xy) + 0.5) / float(uGrid.z) - 0.5;
  vec2 corner = floor(place);
  vec2 share = place - corner;
  ivec2 block = ivec2(corner) - firstBlock();
  ivec2 last = textureSize(tBlurred, 0) - 1;
  ivec2 low = clamp(block, ivec2(0), last);
  ivec2 high = clamp(block + 1, ivec2(0), last);
  vec2 below =
      mix(texelFetch(tBlurred, low, 0).xy, texelFetch(tBlurred, ivec2(high.x, low.y), 0).xy, share.x);
  vec2 above =
      mix(texelFetch(tBlurred, ivec2(low.x, high.y), 0).xy, texelFetch(tBlurred, high, 0).xy, share.x);
  vec2 sum = mix(below, above, share.y);
  oDifference = sum.y > 0.0 ? nearness(depth) - sum.x / sum.y : 0.0;
}

#version 450 core
// flags: UP
// Each pixel of a block of 4 x 4 looks along its own share of the directions (render/post/occlusion.h). Here
// a pixel takes them all, from as many of its neighbours as show the same surface: across, then UP. The
// weights fall off linearly over four pixels, so that each share counts the same and comes, on average, from
// the pixel itself: what changes evenly over a surface keeps its value, and the blocks leave no pattern.
//
// The same surface is what lies near the pixel's tangent plane (include/outline.glsl).
#include "include/view.glsl"
#include "shared/octahedral.glsl"
#include "include/occlusion.glsl"

layout(binding = 0) uniform sampler2D tDepth;
layout(binding = 1) uniform sampler2D tNormal;
layout(binding = 2) uniform sampler2D tSums;  // parts beside each other; UP: the sums of rows

layout(location = 0) out vec2 oOcclusion;  // what is hidden of the sky, and the sky

const int kReach = 3;

vec2 sumAt(ivec2 at) {
#ifndef UP
  ivec2 place = at + uParts.zw;
  at = (place & 3) * uParts.xy + (place >> 2);
#endif
  return texelFetch(tSums, at, 0).rg;
}

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  float depth = texelFetch(tDepth, here, 0).r;
  vec3 normal = decodeNormal(texelFetch(tNormal, here, 0).xy);
  // Depth values of a plane are linear on the screen: what has the value d, `away` pixels from here, lies
  // pixel sizes from the tangent plane: dot(normal.xy, away) + perDepth * (d - depth).
  vec2 slope = (gl_FragCoord.xy + uView.tile.xy - uView.center.xy) * uView.scale.x;
  float perspective = isPerspective(uView) ? 1.0 : 0.0;
  float facing = normal.z - perspective * dot(normal.xy, slope);
  float perDepth = facing / (uView.scale.x * (uView.depthMap.x + perspective * depth));
#ifdef UP
  const ivec2 along = ivec2(0, 1);
  float perPixel = normal.y;
  int low = max(-kReach, -here.y), high = min(kReach, textureSize(tDepth, 0).y - 1 - here.y);
#else
  const ivec2 along = ivec2(1, 0);
  float perPixel = normal.x;
  int low = max(-kReach, -here.x), high = min(kReach, textureSize(tDepth, 0).x - 1 - here.x);
#endif
  vec2 sum = vec2(0.0);
  for (int i = low; i <= high; ++i) {
    ivec2 at = here + i * along;
    float distance = abs(perPixel * float(i) + perDepth * (texelFetch(tDepth, at, 0).r - depth));
    sum += clamp(1.5 - distance, 0.0, 1.0) * float(kReach + 1 - abs(i)) * sumAt(at);
  }
  oOcclusion = sum / float((kReach + 1) * (kReach + 1));
}

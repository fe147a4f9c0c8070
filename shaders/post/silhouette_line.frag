#version 450 core
// Lines of a given width along the borders that post/silhouette.frag found, on the side of the surface in
// front: a line changes no outline, and it has its surface's coverage.
#include "include/view.glsl"
#include "shared/octahedral.glsl"
#include "include/outline.glsl"

layout(binding = 2) uniform sampler2D tBorders;

layout(location = 0) out float oLine;  // share of the pixel that is line

// offset: the pixel that has the borders, as seen from this one.
float coverage(uint borders, vec2 offset) {
  // Distances from this pixel's centre to the borders' middles: across the border and along it. From the
  // middles, because from the nearest points a slanting edge, which is stairs, would be too wide by 20 %.
  vec4 across = vec4(offset.x, -offset.x, offset.y, -offset.y) + 0.5;
  vec4 along = offset.yyxx;
  vec4 width = 0.5 * uCrease.z * vec4(uvec4(borders, borders >> 2, borders >> 4, borders >> 6) & 3u);
  vec4 share = mix(vec4(0.0), width + 0.5 - sqrt(across * across + along * along),
                   greaterThan(min(width, across), vec4(0.0)));
  return clamp(max(max(share.x, share.y), max(share.z, share.w)), 0.0, 1.0);
}

uint bordersAt(ivec2 at) {
  return uint(texelFetch(tBorders, at, 0).r * 65535.0 + 0.5);
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float depth = texelFetch(tDepth, at, 0).r;
  Surface here = surfaceAt(at, depth);
  float line = coverage(bordersAt(at), vec2(0.0));
  int reach = int(uCrease.w);
  ivec2 low = max(at - reach, ivec2(0)) - at;
  ivec2 high = min(at + reach, textureSize(tBorders, 0) - 1) - at;
  // llvmpipe runs a loop for as long as any of its pixels does, but both sides of an `if`: where no border is
  // near, which is nearly everywhere, the second loop ends at once.
  uint any = 0u;
  for (int y = low.y; y <= high.y; ++y) {
    for (int x = low.x; x <= high.x; ++x) any |= bordersAt(at + ivec2(x, y));
  }
  if (any == 0u) high.y = low.y - 1;
  for (int y = low.y; y <= high.y; ++y) {
    for (int x = low.x; x <= high.x; ++x) {
      ivec2 offset = ivec2(x, y);
      uint borders = bordersAt(at + offset);
      if (borders == 0u) continue;
      float share = coverage(borders, vec2(offset));
      if (share <= line) continue;
      Surface there = surfaceAt(at + offset, texelFetch(tDepth, at + offset, 0).r);
      if (!isApart(here, there, length(vec2(offset)))) line = share;  // else it is another surface's line
    }
  }
  oLine = line;
}

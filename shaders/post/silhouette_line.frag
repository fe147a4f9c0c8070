#version 450 core
// Lines of a given width along the borders that post/silhouette.frag found, on the side of the surface in
// front: a line changes no outline, and it has its surface's coverage.
#include "include/view.glsl"
#include "shared/octahedral.glsl"
#include "include/outline.glsl"

layout(binding = 2) uniform sampler2D tBorders;

layout(location = 0) out float oLine;  // share of the pixel that is line

// Squares of the least distances to borders with a whole line (x) and half a line (y).
const float kFar = 1e6;

// offset: the pixel that has the borders, as seen from this one.
vec2 nearest(uint borders, vec2 offset) {
  // Distances from this pixel's centre to the borders' middles: across the border and along it. From the
  // middles, because from the nearest points a slanting edge, which is stairs, would be too wide by 20 %.
  vec4 across = vec4(offset.x, -offset.x, offset.y, -offset.y) + 0.5;
  vec4 square = across * across + (offset * offset).yyxx;
  square = mix(vec4(kFar), square, greaterThan(across, vec4(0.0)));
  uvec4 kind = uvec4(borders, borders >> 2, borders >> 4, borders >> 6) & 3u;
  vec4 whole = mix(vec4(kFar), square, equal(kind, uvec4(2u)));
  vec4 half_ = mix(vec4(kFar), square, equal(kind, uvec4(1u)));
  return vec2(min(min(whole.x, whole.y), min(whole.z, whole.w)),
              min(min(half_.x, half_.y), min(half_.z, half_.w)));
}

uint bordersAt(ivec2 at) {
  return uint(texelFetch(tBorders, at, 0).r * 65535.0 + 0.5);
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  Surface here = surfaceAt(at, texelFetch(tDepth, at, 0).r);
  int reach = int(uCrease.w);
  ivec2 low = max(at - reach, ivec2(0)) - at;
  ivec2 high = min(at + reach, textureSize(tBorders, 0) - 1) - at;
  vec2 square = vec2(kFar);
  for (int y = low.y; y <= high.y; ++y) {
    for (int x = low.x; x <= high.x; ++x) {
      vec2 offset = vec2(x, y);
      vec2 there = nearest(bordersAt(at + ivec2(x, y)), offset);
      // Else it is another surface's line.
      Surface other = surfaceAt(at + ivec2(x, y), texelFetch(tDepth, at + ivec2(x, y), 0).r);
      bool same = !isApart(here, other, length(offset));
      square = min(square, mix(vec2(kFar), there, bvec2(same)));
    }
  }
  vec2 width = uCrease.z * vec2(1.0, 0.5);
  vec2 share = width + 0.5 - sqrt(square);
  oLine = clamp(max(share.x, share.y), 0.0, 1.0);
}

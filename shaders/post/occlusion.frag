#version 450 core
// How much of the ambient light reaches a point: what its tangent plane leaves of the sky, weighted by the
// cosine to the normal, less the directions in which something lies above it (core/occlusion_maps.h).
//
// A texel's height is compared with the tangent plane at that very texel's centre: a convex surface lies
// below its tangent plane, so it cannot occlude itself. Where the plane falls away the point's own height
// counts instead, or what lies beneath a steep wall would occlude it.
#include "include/view.glsl"
#include "shared/octahedral.glsl"
#include "include/occlusion.glsl"

layout(binding = 0) uniform sampler2D tDepth;
layout(binding = 1) uniform sampler2D tNormal;

// Row after row of 2^kWidthBits. A texel holds the heights of four slabs; in the upper 16 bits those of the
// texel to the right (OcclusionTexel).
layout(binding = 2) uniform usampler2D tHeights;
const int kWidthBits = 12;

layout(location = 0) out vec2 oOcclusion;  // what is hidden of the sky, and the sky: added up

uvec4 heightsAt(int index) {
  return texelFetch(tHeights, ivec2(index & ((1 << kWidthBits) - 1), index >> kWidthBits), 0);
}

// The lowest of four heights that is above a threshold; beyond all heights if none is.
int lowestAbove(ivec4 heights, int threshold) {
  ivec4 above = mix(ivec4(0x7FFFFFFF), heights, greaterThan(heights, ivec4(threshold)));
  return min(min(above.x, above.y), min(above.z, above.w));
}

// The share of light from one direction that is kept away. at: texels, texels, height [Å]; n: normal in the
// map's axes, z towards the sky, x and y times a texel's size.
float occlusionAlong(Direction d, vec3 at, vec3 n, float texel) {
  vec2 place = clamp(at.xy - 0.5, vec2(0.0), vec2(d.map.yz) - 1.0);
  ivec2 corner = ivec2(min(place, vec2(max(d.map.yz - 2, ivec2(0)))));
  vec2 f = place - vec2(corner);
  int pair = clamp(int((at.z - uSlab.y) * uSlab.x), 0, d.map.w - 1) >> 1;
  int index = d.map.x + (pair * d.map.z + corner.y) * d.map.y + corner.x;
  uvec4 low = heightsAt(index);
  uvec4 high = heightsAt(index + (corner.y + 1 < d.map.z ? d.map.y : 0));

  // The tangent plane over the four texels: lower left, lower right, upper left, upper right.
  float steep = 1.0 / max(n.z, 1e-3);
  vec2 slope = -n.xy * steep;  // per texel
  vec4 rise = dot(slope, vec2(corner) + 0.5 - at.xy) + vec4(0.0, slope.x, slope.y, slope.x + slope.y);
  // A stored normal is off by up to 6e-5 rad (16-bit octahedral).
  vec4 threshold = at.z + max(rise, 0.0) + uFade.w * steep + 1e-4 * texel * steep * steep;
  ivec4 least = ivec4(min(threshold * uSlab.w, 1e5));
  ivec4 height = ivec4(lowestAbove(ivec4(low & 0xFFFFu), least.x), lowestAbove(ivec4(low >> 16), least.y),
                       lowestAbove(ivec4(high & 0xFFFFu), least.z), lowestAbove(ivec4(high >> 16), least.w));
  // The nearest occluder counts the most.
  vec4 hidden = clamp(uFade.x + uFade.y * at.z - uSlab.z * vec4(height), 0.0, 1.0);
  return mix(mix(hidden.x, hidden.y, f.x), mix(hidden.z, hidden.w, f.x), f.y);
}

vec2 occlusionFrom(Direction d, vec4 point, vec3 normal) {
  float cosine = dot(d.rowZ.xyz, normal);
  if (cosine <= 0.0) return vec2(0.0);
  // The rows give texels: times a texel's size twice, a slope comes out in Å per texel.
  float square = 1.0 / dot(d.rowX.xyz, d.rowX.xyz);
  vec3 n = vec3(vec2(dot(d.rowX.xyz, normal), dot(d.rowY.xyz, normal)) * square, cosine);
  vec3 at = vec3(dot(d.rowX, point), dot(d.rowY, point), dot(d.rowZ, point));
  return cosine * vec2(occlusionAlong(d, at, n, sqrt(square)), 1.0);
}

void main() {
  ivec2 here = uPart.xy + uPart.z * ivec2(gl_FragCoord.xy);
  float depth = texelFetch(tDepth, here, 0).r;
  vec4 p = vec4(viewPoint(uView, vec2(here) + 0.5 + uView.tile.xy, depth), 1.0);
  vec3 n = decodeNormal(texelFetch(tNormal, here, 0).xy);
  vec2 sum = occlusionFrom(uDirections[0], p, n);
  sum += occlusionFrom(uDirections[1], p, n);
  sum += occlusionFrom(uDirections[2], p, n);
  sum += occlusionFrom(uDirections[3], p, n);
  oOcclusion = uFade.z * sum;
}

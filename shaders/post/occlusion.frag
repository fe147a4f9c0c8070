#version 450 core
// How much of the ambient light reaches a point: what its tangent plane leaves of the sky, weighted by the
// cosine to the normal, less the directions in which something lies above it (core/occlusion_maps.h).
//
// A texel's height is compared with the tangent plane at that very texel's centre: a convex surface lies
// below its tangent plane, so it cannot occlude itself. Where the plane falls away the point's own height
// counts instead, or what lies beneath a steep wall would occlude it.
#include "include/view.glsl"
#include "shared/octahedral.glsl"

layout(binding = 0) uniform sampler2D tDepth;
layout(binding = 1) uniform sampler2D tNormal;

// Eight at a time, each named by a constant: indexed by a variable, their numbers are fetched per pixel on
// llvmpipe, which takes longer than all else here.
struct Direction {
  vec4 rowX, rowY, rowZ;  // camera's view space -> texels, texels, height above the map's far plane [Å]
  ivec4 map;              // first texel, width, height, slabs
};
layout(std140, binding = 1) uniform OcclusionUniforms {
  vec4 uSlab;  // 1 / slab height; reach; radius (0 = unlimited); unit of the stored heights [Å]
  vec4 uFade;  // how much an occluder counts: x - y * distance; z: weight of a direction; w: rounding [Å]
  Direction uDirections[8];
};
// Heights, row after row of 2^kWidthBits; in the upper 16 bits that of the texel to the right.
layout(binding = 2) uniform usampler2D tHeights;
const int kWidthBits = 12;

layout(location = 0) out vec2 oOcclusion;  // what is hidden of the sky, and the sky: added up

// The heights of the four texels at and right of, and above, an index: lower left, lower right, upper left,
// upper right.
vec4 heightsAt(int index, int above) {
  const int mask = (1 << kWidthBits) - 1;
  uint low = texelFetch(tHeights, ivec2(index & mask, index >> kWidthBits), 0).r;
  index += above;
  uint high = texelFetch(tHeights, ivec2(index & mask, index >> kWidthBits), 0).r;
  return vec4(uvec4(low & 0xFFFFu, low >> 16, high & 0xFFFFu, high >> 16)) * uSlab.w;
}

// The share of light from one direction that is kept away. at: texels, texels, height [Å]; n: normal in the
// map's axes, z towards the sky, x and y times a texel's size.
float occlusionAlong(Direction d, vec3 at, vec3 n, float texel) {
  vec2 place = clamp(at.xy - 0.5, vec2(0.0), vec2(d.map.yz) - 1.0);
  ivec2 corner = ivec2(min(place, vec2(max(d.map.yz - 2, ivec2(0)))));
  vec2 f = place - vec2(corner);
  int first = d.map.x + corner.y * d.map.y + corner.x;
  int above = corner.y + 1 < d.map.z ? d.map.y : 0;

  // The tangent plane over the four texels.
  float steep = max(n.z, 1e-3);
  vec2 slope = -n.xy / steep;  // per texel
  vec4 rise = dot(slope, vec2(corner) + 0.5 - at.xy) + vec4(0.0, slope.x, slope.y, slope.x + slope.y);
  // A stored normal is off by up to 6e-5 rad (16-bit octahedral).
  vec4 threshold = at.z + max(rise, 0.0) + uFade.w / steep + 1e-4 * texel / (steep * steep);

  bool limited = uSlab.z > 0.0;
  int last = d.map.w - 1;
  int k0 = limited ? clamp(int((at.z - uSlab.y) * uSlab.x), 0, last) : 0;
  int k1 = limited ? clamp(int((at.z + uSlab.z) * uSlab.x), 0, last) : last;
  vec4 hidden = vec4(0.0);
  for (int k = k0; k <= k1; ++k) {
    vec4 height = heightsAt(first + k * d.map.y * d.map.z, above);
    vec4 counts = clamp(uFade.x - uFade.y * (height - at.z), 0.0, 1.0);
    hidden = max(hidden, mix(vec4(0.0), counts, greaterThan(height, threshold)));
  }
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
  ivec2 here = ivec2(gl_FragCoord.xy);
  float depth = texelFetch(tDepth, here, 0).r;
  if (depth <= 0.0) discard;
  vec4 p = vec4(viewPoint(uView, gl_FragCoord.xy + uView.tile.xy, depth), 1.0);
  vec3 n = decodeNormal(texelFetch(tNormal, here, 0).xy);
  vec2 sum = occlusionFrom(uDirections[0], p, n);
  sum += occlusionFrom(uDirections[1], p, n);
  sum += occlusionFrom(uDirections[2], p, n);
  sum += occlusionFrom(uDirections[3], p, n);
  sum += occlusionFrom(uDirections[4], p, n);
  sum += occlusionFrom(uDirections[5], p, n);
  sum += occlusionFrom(uDirections[6], p, n);
  sum += occlusionFrom(uDirections[7], p, n);
  oOcclusion = uFade.z * sum;
}

#version 450 core
// flags: SOFT
// How much of the key light reaches a point: percentage-closer filtering of a shadow map (Reeves et al.
// 1987). Sigg et al. 2006, §4: a few probes decide whether all samples are needed.
//
// The map's texels hold exact heights of ray-cast surfaces. Each is compared with the tangent plane of the
// shaded point at that very texel's centre: a convex surface lies below its tangent plane, so it cannot
// shadow itself, and the bias has to cover rounding only.
#include "include/view.glsl"
#include "shared/octahedral.glsl"

layout(binding = 0) uniform sampler2D tDepth;
layout(binding = 1) uniform sampler2D tNormal;
layout(binding = 2) uniform sampler2D tMap;  // height above the map's far plane / uMap.z

const int kMaxSamples = 256;
layout(std140, binding = 1) uniform ShadowUniforms {
  vec4 uRowX, uRowY, uRowZ;  // camera's view space -> map: texels, texels, height above the far plane [Å]
  vec4 uMap;  // x, y: size [texels]; z: height of the near plane above the far plane [Å]; w: texel size [Å]
  vec4 uFilter;                    // x: radius [texels]; y: samples; z: probes; w: 0
  vec4 uOffsets[kMaxSamples / 2];  // in the unit disc, two to a vec4
};

layout(location = 0) out float oVisibility;

struct Receiver {
  vec2 at;       // texels
  float height;  // [Å]
  vec2 slope;    // of the tangent plane [Å per texel]
  float slack;   // what rounding can amount to per texel of distance [Å], and at none
  float slack0;
};

// 1 where the light reaches the plane over a texel.
float litAt(Receiver r, ivec2 texel) {
  if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, ivec2(uMap.xy)))) return 1.0;
  vec2 away = vec2(texel) + 0.5 - r.at;
  float plane = r.height + dot(r.slope, away);
  float bias = r.slack0 + r.slack * length(away);
  return texelFetch(tMap, texel, 0).r * uMap.z > plane + bias ? 0.0 : 1.0;
}

// The four texels around a place, weighted by nearness.
float litAround(Receiver r, vec2 place) {
  vec2 corner = floor(place - 0.5);
  vec2 f = place - 0.5 - corner;
  ivec2 t = ivec2(corner);
  float low = mix(litAt(r, t), litAt(r, t + ivec2(1, 0)), f.x);
  float high = mix(litAt(r, t + ivec2(0, 1)), litAt(r, t + ivec2(1, 1)), f.x);
  return mix(low, high, f.y);
}

vec2 offsetOf(int i) {
  vec4 pair = uOffsets[i >> 1];
  return (i & 1) == 0 ? pair.xy : pair.zw;
}

float visibility(Receiver r) {
#ifdef SOFT
  int count = int(uFilter.y);
  int probes = min(int(uFilter.z), count);
  float sum = 0.0;
  int taken = 0;
  for (; taken < probes; ++taken) sum += litAt(r, ivec2(floor(r.at + uFilter.x * offsetOf(taken))));
  if (probes > 0 && (sum == 0.0 || sum == float(probes))) return sum / float(probes);
  for (; taken < count; ++taken) sum += litAt(r, ivec2(floor(r.at + uFilter.x * offsetOf(taken))));
  return sum / float(count);
#else
  return litAround(r, r.at);
#endif
}

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  float depth = texelFetch(tDepth, here, 0).r;
  oVisibility = 1.0;
  if (depth <= 0.0) return;
  vec3 point = viewPoint(uView, gl_FragCoord.xy + uView.tile.xy, depth);
  vec3 normal = decodeNormal(texelFetch(tNormal, here, 0).xy);
  vec3 n = vec3(dot(uRowX.xyz, normal), dot(uRowY.xyz, normal), dot(uRowZ.xyz, normal));
  n = vec3(n.xy * uMap.w, n.z);  // rows x and y are per texel
  if (n.z <= 0.0) {
    oVisibility = 0.0;
    return;
  }
  float steep = max(n.z, 0.03);
  Receiver r;
  r.at = vec2(dot(uRowX, vec4(point, 1.0)), dot(uRowY, vec4(point, 1.0)));
  r.height = dot(uRowZ, vec4(point, 1.0));
  r.slope = -n.xy / steep * uMap.w;
  // The stored normal is off by up to 6e-5 rad (16-bit octahedral), positions by some roundings of the
  // scene's size.
  float turned = uMap.w / (steep * steep);
  r.slack = 6e-5 * turned;
  r.slack0 = 2e-6 * uMap.z / steep;
  oVisibility = visibility(r);
}

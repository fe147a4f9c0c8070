// Percentage-closer filtering of a shadow map. Needs include/view.glsl; SOFT: over a disc, otherwise between
// the four nearest texels.
//
// The map's texels hold exact heights of ray-cast surfaces. Each is compared with the tangent plane of the
// shaded point at that very texel's centre: a convex surface lies below its tangent plane, so it cannot
// shadow itself. What counts is the distance above the plane, not along the light, so that nothing is divided
// by the cosine of a grazing light and the bias has to cover rounding only.

layout(binding = 2) uniform sampler2D tMap;  // height above the map's far plane / uMap.z

const int kMaxSamples = 256;
layout(std140, binding = 1) uniform ShadowUniforms {
  vec4 uRowX, uRowY, uRowZ;  // camera's view space -> map: texels, texels, height above the far plane [Å]
  vec4 uMap;  // x, y: size [texels]; z: height of the near plane above the far plane [Å]; w: texel size [Å]
  vec4 uFilter;                    // x: radius [texels]; y: samples; z: probes; w: 0
  vec4 uOffsets[kMaxSamples / 2];  // in the unit disc, two to a vec4
};

// Error of a stored normal [rad]: 16-bit octahedral.
const float kNormalError = 6e-5;
// Error of positions, as a share of the scene's size: some roundings of float32.
const float kPositionError = 2e-6;

struct Receiver {
  vec2 at;       // texels
  float height;  // [Å]
  vec3 normal;   // x, y: unit normal times the size of a texel; z: along the light, > 0
};

// 1 where the light reaches the tangent plane over a texel.
float litAt(Receiver r, ivec2 texel) {
  if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, ivec2(uMap.xy)))) return 1.0;
  float height = texelFetch(tMap, texel, 0).r * uMap.z;
  vec2 away = vec2(texel) + 0.5 - r.at;
  float rise = height - r.height;
  float above = dot(r.normal, vec3(away, rise));
  float bias = kPositionError * uMap.z + kNormalError * (uMap.w * (abs(away.x) + abs(away.y)) + abs(rise));
  return height > 0.0 && above > bias ? 0.0 : 1.0;  // 0: nothing there
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

// Share of the key light that reaches a surface point; both in view space, normal: unit.
float keyLightAt(vec3 point, vec3 normal) {
  vec3 n = vec3(dot(uRowX.xyz, normal), dot(uRowY.xyz, normal), dot(uRowZ.xyz, normal));
  if (n.z <= 0.0) return 0.0;
  Receiver r;
  r.at = vec2(dot(uRowX, vec4(point, 1.0)), dot(uRowY, vec4(point, 1.0)));
  r.height = dot(uRowZ, vec4(point, 1.0));
  r.normal = vec3(n.xy * uMap.w * uMap.w, n.z);  // rows x and y are per texel
  return visibility(r);
}

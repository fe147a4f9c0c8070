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
  vec4 uFilter;  // x: radius [texels]; y: samples; z: probes, a multiple of 4 or y; w: 0
  uvec4 uOffsets[kMaxSamples /
                 4];  // in the unit disc, as packSnorm2x16: llvmpipe fetches each number per pixel
};

// Error of a stored normal [rad]: 16-bit octahedral.
const float kNormalError = 6e-5;
// Error of positions, as a share of the scene's size: some roundings of float32.
const float kPositionError = 2e-6;

struct Receiver {
  vec2 at;       // texels
  float height;  // what the map would hold of it
  vec3 needed;   // by how much a texel must be above it to be above its tangent plane, in the map's unit: z
                // for the rounding, and by x and y per texel away; before division by the cosine to the light
  vec2 factor;  // by which to divide: for what is above, for what is below
};

// normal: unit, in the map's axes, z > 0; height: [Å].
Receiver makeReceiver(vec2 at, float height, vec3 normal, float reach) {
  Receiver r;
  r.at = at;
  r.height = height / uMap.z;
  float perTexel = uMap.w / uMap.z;
  r.needed = vec3(-normal.xy * perTexel, kPositionError + 2.0 * kNormalError * perTexel * reach);
  r.factor = 1.0 / vec2(max(normal.z - kNormalError, 1e-9), normal.z + kNormalError);
  return r;
}

// 1 where the light reaches the tangent plane over a texel.
float litAt(Receiver r, ivec2 texel) {
  float height = texelFetch(tMap, clamp(texel, ivec2(0), ivec2(uMap.xy) - 1), 0).r;
  float needed = dot(r.needed, vec3(vec2(texel) + 0.5 - r.at, 1.0));
  float least = r.height + max(needed * r.factor.x, needed * r.factor.y);
  return height > max(least, 0.0) ? 0.0 : 1.0;  // 0: nothing there
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

float litBy(Receiver r, uint offset) {
  return litAt(r, ivec2(floor(r.at + uFilter.x * unpackSnorm2x16(offset))));
}

// How many of the samples from `first`, a multiple of 4, up to `end` see the light.
float litSamples(Receiver r, int first, int end) {
  float sum = 0.0;
  for (int i = first; i < end; i += 4) {
    uvec4 offsets = uOffsets[i >> 2];
    vec4 lit = vec4(litBy(r, offsets.x), litBy(r, offsets.y), litBy(r, offsets.z), litBy(r, offsets.w));
    sum += dot(lit, vec4(lessThan(i + ivec4(0, 1, 2, 3), ivec4(end))));
  }
  return sum;
}

float visibility(Receiver r) {
#ifdef SOFT
  int count = int(uFilter.y);
  int probes = int(uFilter.z);
  float sum = litSamples(r, 0, probes);
  bool agree = probes > 0 && (sum == 0.0 || sum == float(probes));
  sum += litSamples(r, probes, agree ? 0 : count);
  return sum / float(agree ? probes : count);
#else
  return litAround(r, r.at);
#endif
}

// Share of the key light that reaches a surface point; both in view space, normal: unit.
float keyLightAt(vec3 point, vec3 normal) {
  // Rows x and y are per texel.
  vec3 n = vec3(vec2(dot(uRowX.xyz, normal), dot(uRowY.xyz, normal)) * uMap.w, dot(uRowZ.xyz, normal));
  vec3 at = vec3(dot(uRowX, vec4(point, 1.0)), dot(uRowY, vec4(point, 1.0)), dot(uRowZ, vec4(point, 1.0)));
  float lit = visibility(makeReceiver(at.xy, at.z, n, uFilter.x + 1.0));
  return n.z > 0.0 ? lit : 0.0;
}

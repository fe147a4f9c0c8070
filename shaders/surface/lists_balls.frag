#version 450 core
// flags: CORES INSIDE CUBIC
// Szécsi and Illés 2012, §5. CORES: lays down the fronts of the spheres in which one ball alone reaches the
// level, with CUBIC of its cubics. INSIDE: takes them away again where a ray begins in a ball, since it may
// look for an exit, which no core hides. Neither: gathers the balls that the ray meets in front of them. The
// same program counts first and gathers then, so that it decides alike.
#include "include/view.glsl"
#include "include/ball_ray.glsl"
#include "include/lists.glsl"
#if defined(CORES) && defined(CUBIC)
#include "shared/metaball.glsl"
#include "include/field.glsl"
#endif

layout(location = 0) flat in vec4 vPixel;
layout(location = 1) flat in vec4 vPlace;
layout(location = 2) flat in vec4 vEye;
layout(location = 3) flat in uint vBall;
layout(location = 4) flat in vec2 vShare;

#if defined(CORES)
layout(depth_greater) out float gl_FragDepth;
#elif !defined(INSIDE)
layout(early_fragment_tests) in;
#include "include/lists_nodes.glsl"
layout(std430, binding = 3) restrict buffer Gathered {
  uint uGathered;  // nodes that were asked for
};
layout(binding = 0) uniform sampler2D tCores;
layout(location = 0) out float oCount;
layout(location = 1) uniform int uGather;  // 0: only count
#endif

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  SceneRay ray = sceneRay(vec2(texel + uRegion.xy) + 0.5 + uView.tile.xy);
  BallProjection ball;
  ball.pixel = vPixel;
  ball.place = vPlace;
  ball.eye = vEye;
  BallRay b = ballOnRay(ball, ray);
  Split start = startOf(ray);

#if defined(CORES)
  float square = vEye.w - dot(b.nearest, b.nearest);
  if (!(square > 0.0)) discard;
  float halfChord = sqrt(square);
#ifdef CUBIC
  // x^2 (3 - 2 x) times the peak reaches the level.
  float peak = vShare.x * kernelAt(clamp(b.halfChord2 * vShare.y, 0.0, 1.0));
  float x = 0.5 - sin(asin(clamp(1.0 - 2.0 * uField.x / peak, -1.0, 1.0)) / 3.0);
  halfChord = sqrt(b.halfChord2) * (1.0 - x);
#endif
  if (!(placeBetween(start, b.middle) > halfChord)) discard;
  gl_FragDepth = max(depthOfPlace((b.middle.hi - halfChord) + b.middle.lo), gl_FragCoord.z);
#else
  if (!(b.halfChord2 > 0.0)) discard;
  float halfChord = sqrt(b.halfChord2), middle = placeBetween(start, b.middle);
  if (!(middle + halfChord > 0.0)) discard;
#if defined(INSIDE)
  if (middle > halfChord) discard;
#else
  const float kSlack = 1e-6;  // of what rounding does to either
  float enters = depthOfPlace((b.middle.hi - halfChord) + b.middle.lo);
  if (enters > texelFetch(tCores, texel, 0).r + kSlack) discard;
  if (uGather != 0) {
    uint node = atomicAdd(uGathered, 1u);
    if (node < uint(uLists.y)) {
      uint next = atomicExchange(uHeads[pixelOf(texel)], node + 1u);
      uNodes[node] = uvec2(vBall, next);
    }
  }
  oCount = 1.0;
#endif
#endif
}

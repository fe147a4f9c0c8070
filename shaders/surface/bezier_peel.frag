#version 450 core
// flags: CORES VISIBLE
// Depth peeling of effective spheres (Kanamori et al. 2008, §4.1): of the places at which the ray enters or
// leaves a ball, the first after the pixel's last one. In order of (place, ball, entry before exit): of equal
// depths the depth test keeps the one drawn first, and balls are drawn in order. CORES: the front of the
// kernel spheres (§5.2). VISIBLE: marks the balls that are not hidden behind them or behind what is drawn
// already.
#include "include/view.glsl"
#include "include/ball_ray.glsl"
#include "include/bezier.glsl"

layout(location = 0) flat in vec4 vPixel;
layout(location = 1) flat in vec4 vPlace;
layout(location = 2) flat in vec4 vEye;
layout(location = 3) flat in uvec2 vIndex;

#if defined(VISIBLE)
layout(binding = 0) uniform sampler2D tCores;
layout(binding = 1) uniform sampler2D tDepth;
layout(std430, binding = 3) writeonly restrict buffer Seen {
  uint uSeen[];
};
#elif !defined(CORES)
layout(binding = 0) uniform usampler2D tLastStep;
layout(binding = 1) uniform usampler2D tLastKey;
layout(location = 0) out uint oKey;
#endif

bool isAfter(uint step, uint key, uint lastStep, uint lastKey) {
  return step > lastStep || (step == lastStep && key > lastKey);
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
#if !defined(CORES) && !defined(VISIBLE)
  uint lastStep = texelFetch(tLastStep, texel, 0).r;
  if (lastStep == kFinished) discard;
#endif
  SceneRay ray = sceneRay(vec2(texel + uRegion.xy) + 0.5 + uView.tile.xy);
  BallProjection ball;
  ball.pixel = vPixel;
  ball.place = vPlace;
  ball.eye = vEye;
  BallRay b = ballOnRay(ball, ray);
  uint start = firstStep(ray);

#if defined(CORES)
  float square = vEye.w - dot(b.nearest, b.nearest);
  if (!(square > 0.0)) discard;
  uint front = stepAt(b.middle, -sqrt(square));
  if (front <= start) discard;
  gl_FragDepth = uintBitsToFloat(front);
#else
  if (!(b.halfChord2 > 0.0)) discard;
  float halfChord = sqrt(b.halfChord2);
  uint leaves = stepAt(b.middle, halfChord);
  if (leaves <= start) discard;
  uint enters = max(stepAt(b.middle, -halfChord), start);
#if defined(VISIBLE)
  uint slack = uint(1e-5 * sqrt(vPlace.y) * uSteps.y) + 16u;  // of what rounding does to either
  uint cores = floatBitsToUint(texelFetch(tCores, texel, 0).r) + slack;
  if (enters > cores) discard;
  if (enters > hiddenFrom(ray, texelFetch(tDepth, texel + uRegion.xy, 0).r)) discard;
  uSeen[vIndex.y] = 1u;
#else
  uint lastKey = texelFetch(tLastKey, texel, 0).r;
  uint key = 2u * vIndex.x + 2u;
  uint step = enters;
  if (!isAfter(step, key, lastStep, lastKey)) {
    step = leaves;
    ++key;
    if (!isAfter(step, key, lastStep, lastKey)) discard;
  }
  gl_FragDepth = uintBitsToFloat(step);
  oKey = key;
#endif
#endif
}

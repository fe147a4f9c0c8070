#version 450 core
// flags: CORES
// Before the hulls. With CORES: the front of what one ball alone holds inside, behind which no surface is
// seen by a ray that begins outside. Without: the field where the ray begins,
// term by term, of the balls there.
#include "include/view.glsl"
#include "include/ball_ray.glsl"
#include "shared/metaball.glsl"
#include "include/surface_point.glsl"
#include "include/newton.glsl"

layout(location = 0) flat in vec4 vPixel;
layout(location = 1) flat in vec4 vPlace;
layout(location = 2) flat in vec4 vEye;
layout(location = 4) flat in vec2 vHull;

#ifdef CORES
layout(binding = 0) uniform sampler2D tNear;
#else
layout(location = 0) out float oField;
#endif

void main() {
  vec2 target = gl_FragCoord.xy + uArea.xy;
  SceneRay ray = sceneRay(target + uView.tile.xy);
  BallProjection ball;
  ball.pixel = vPixel;
  ball.place = vPlace;
  ball.eye = vEye;
  BallRay b = ballOnRay(ball, ray);
  float begin = placeBetween(b.middle, startOf(ray));
#ifdef CORES
  if (uTerms.z != 0 && texelFetch(tNear, ivec2(gl_FragCoord.xy), 0).x > uField.x) discard;
  float square = vEye.w - dot(b.nearest, b.nearest);
  if (!(square > 0.0)) discard;
  float front = -sqrt(square);
  if (!(front > begin)) discard;
  front *= 0.5;  // where the field is above the level by more than its rounding
  gl_FragDepth = depthValue(uView, heightOf(ray, addSplit(b.middle, makeSplit(front, 0.0))));
#else
  float w = (b.halfChord2 - begin * begin) / vPlace.y;
  if (!(w > 0.0)) discard;
  oField = vHull.y * kernelAt(w);
#endif
}

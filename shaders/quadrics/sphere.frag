#version 450 core
// flags: ALBEDO NORMAL ID DISTANCE
// Ray against sphere, in the sphere's own coordinates.
#include "include/view.glsl"
#include "shared/quadrics.glsl"
#include "include/gbuffer.glsl"
#include "include/quadric_fragment.glsl"

layout(location = 0) flat in vec4 vPixel;
layout(location = 1) flat in vec4 vView;
layout(location = 2) flat in vec2 vDepth;
layout(location = 3) flat in uvec2 vColorId;
#ifdef DISTANCE
layout(location = 4) flat in vec2 vRange;
#endif

void main() {
  vec2 pixel = gl_FragCoord.xy + uView.tile.xy;
  vec3 direction = rayDirection(uView, pixel);
  vec3 point = rayPoint(uView, pixel, vPixel.xy, vPixel.zw, vView.xyz, vDepth.x, vDepth.y > 0.5);
  SurfacePoint s;
  if (!visibleEnd(sphereChord(point, direction, vView.w), vView.z, s)) discard;
  float distance = 0.0;
#ifdef DISTANCE
  distance = rayDistance(uView, vView.xyz, makeSplit(vRange.x, vRange.y), s.position);
#endif
  writeSurface(depthValue(uView, s.z), s.normal, vColorId.x, vColorId.y, distance);
}

#version 450 core
// flags: ALBEDO NORMAL ID DISTANCE
// Ray against ellipsoid, in the ellipsoid's own coordinates.
#include "include/view.glsl"
#include "shared/quadrics.glsl"
#include "include/gbuffer.glsl"
#include "include/quadric_fragment.glsl"

layout(location = 0) flat in vec4 vPixel;
layout(location = 1) flat in vec4 vView;
layout(location = 2) flat in vec4 vAxisA;
layout(location = 3) flat in vec4 vAxisB;
layout(location = 4) flat in vec2 vDepth;
layout(location = 5) flat in uvec2 vColorId;
#ifdef DISTANCE
layout(location = 6) flat in vec2 vRange;
#endif

void main() {
  vec2 pixel = gl_FragCoord.xy + uView.tile.xy;
  vec3 direction = rayDirection(uView, pixel);
  vec3 point = rayPoint(uView, pixel, vPixel.xy, vPixel.zw, vView.xyz, vDepth.x, vDepth.y > 0.5);
  Chord chord = ellipsoidChord(point, direction, vAxisA.xyz, vAxisB.xyz, cross(vAxisA.xyz, vAxisB.xyz),
                               vec3(vAxisA.w, vAxisB.w, vView.w));
  SurfacePoint s;
  if (!visibleEnd(chord, vView.z, s)) discard;
  float distance = 0.0;
#ifdef DISTANCE
  distance = rayDistance(uView, vView.xyz, makeSplit(vRange.x, vRange.y), s.position);
#endif
  writeSurface(depthValue(uView, s.z), s.normal, vColorId.x, vColorId.y, distance);
}

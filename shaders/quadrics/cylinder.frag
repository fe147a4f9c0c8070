#version 450 core
// flags: ALBEDO NORMAL ID DISTANCE
// Ray against capped cylinder, in the cylinder's own coordinates; each half takes its atom's colour and id.
#include "include/view.glsl"
#include "shared/quadrics.glsl"
#include "include/gbuffer.glsl"
#include "include/quadric_fragment.glsl"

layout(location = 0) flat in vec4 vPixel;
layout(location = 1) flat in vec4 vView;
layout(location = 2) flat in vec4 vAxis;
layout(location = 3) flat in vec2 vDepth;
layout(location = 4) flat in uvec4 vColorsIds;
#ifdef DISTANCE
layout(location = 5) flat in vec2 vRange;
#endif

void main() {
  vec2 pixel = gl_FragCoord.xy + uView.tile.xy;
  vec3 direction = rayDirection(uView, pixel);
  vec3 point = rayPoint(uView, pixel, vPixel.xy, vPixel.zw, vView.xyz, vDepth.x, vDepth.y > 0.5);
  SurfacePoint s;
  if (!visibleEnd(cylinderChord(point, direction, vAxis.xyz, vAxis.w, vView.w), vView.z, s)) discard;
  float distance = 0.0;
#ifdef DISTANCE
  distance = rayDistance(uView, vView.xyz, makeSplit(vRange.x, vRange.y), s.position);
#endif
  bool second = dot(s.position, vAxis.xyz) > 0.0;
  writeSurface(depthValue(uView, s.z), normalize(s.normal), second ? vColorsIds.y : vColorsIds.x,
               second ? vColorsIds.w : vColorsIds.z, distance);
}

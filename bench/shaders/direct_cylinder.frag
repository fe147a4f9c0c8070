#version 450 core
// flags: SHADOW SOFT ENCODE_SRGB
// As quadrics/cylinder.frag, shaded at once.
#include "include/view.glsl"
#include "shared/quadrics.glsl"
#include "include/quadric_fragment.glsl"
#include "bench/direct.glsl"

layout(location = 0) flat in vec4 vPixel;
layout(location = 1) flat in vec4 vView;
layout(location = 2) flat in vec4 vAxis;
layout(location = 3) flat in vec2 vDepth;
layout(location = 4) flat in uvec4 vColorsIds;

void main() {
  vec2 pixel = gl_FragCoord.xy + uView.tile.xy;
  vec3 direction = rayDirection(uView, pixel);
  vec3 point = rayPoint(uView, pixel, vPixel.xy, vPixel.zw, vView.xyz, vDepth.x, vDepth.y > 0.5);
  SurfacePoint s;
  if (!visibleEnd(cylinderChord(point, direction, vAxis.xyz, vAxis.w, vView.w), vView.z, s)) discard;
  bool second = dot(s.position, vAxis.xyz) > 0.0;
  writeShaded(vView.xyz + s.position, direction, normalize(s.normal), second ? vColorsIds.y : vColorsIds.x);
}

#version 450 core
// flags: SOFT
// How much of the key light reaches a point: percentage-closer filtering of a shadow map (Reeves et al.
// 1987). Sigg et al. 2006, §4: a few probes decide whether all samples are needed.
#include "include/view.glsl"
#include "shared/octahedral.glsl"
#include "include/shadow.glsl"

layout(binding = 0) uniform sampler2D tDepth;
layout(binding = 1) uniform sampler2D tNormal;

layout(location = 0) out float oVisibility;

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  float depth = texelFetch(tDepth, here, 0).r;
  vec3 point = viewPoint(uView, gl_FragCoord.xy + uView.tile.xy, depth);
  oVisibility = keyLightAt(point, decodeNormal(texelFetch(tNormal, here, 0).xy));
}

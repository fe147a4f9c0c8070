#version 450 core
// What is drawn already hides what lies behind it, as cores do.
#include "include/view.glsl"
#include "include/ball_ray.glsl"
#include "include/lists.glsl"

layout(binding = 0) uniform sampler2D tDepth;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  float depth = texelFetch(tDepth, texel + uRegion.xy, 0).r;
  if (!(depth > 0.0)) discard;
  SceneRay ray = sceneRay(vec2(texel + uRegion.xy) + 0.5 + uView.tile.xy);
  float place = placeOfDepth(ray, depth);
  gl_FragDepth = depthOfPlace(place + slackOfDepth(place));
}

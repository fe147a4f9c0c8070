#version 450 core
// flags: ALBEDO NORMAL ID DISTANCE TILES
// What the surface is like where it was found (Szécsi and Illés 2012, §5, shading: from the balls of the
// pixel's list).
#define LIST_ACCESS readonly
#include "include/view.glsl"
#include "include/ball_ray.glsl"
#include "shared/metaball.glsl"
#include "include/field.glsl"
#include "include/lists.glsl"
#include "include/lists_nodes.glsl"
#include "include/lists_surface.glsl"
#include "include/gbuffer.glsl"

layout(binding = 0) uniform sampler2D tPlace;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy) - uRegion.xy;
  uint head = uHeads[pixelOf(texel)];
  if ((head & kHit) == 0u) discard;
  SceneRay ray = sceneRay(gl_FragCoord.xy + uView.tile.xy);
  vec2 stored = texelFetch(tPlace, texel, 0).rg;
  Split place = makeSplit(stored.x, stored.y);
  uint node = head & kFirstNode;
  FieldSurface s = surfaceAt(node, ray, place);
  writeSurface(depthValue(uView, heightOf(ray, place)), normalTowards(s, ray, (head & kInside) != 0u),
               blendedColor(s), max(s.id, 1u), distanceAlong(ray, place));
}

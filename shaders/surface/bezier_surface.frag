#version 450 core
// flags: ALBEDO NORMAL ID DISTANCE
// What the surface is like where it was found (Kanamori et al. 2008, Figure 4, step 4).
#define LIST_ACCESS readonly
#include "include/view.glsl"
#include "include/ball_ray.glsl"
#include "shared/metaball.glsl"
#include "include/field.glsl"
#include "include/bezier.glsl"
#include "include/bezier_lists.glsl"
#include "include/gbuffer.glsl"

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy) - uRegion.xy;
  uint status = uLists[slot(texel, kStatus)];
  if ((status & kHit) == 0u) discard;
  SceneRay ray = sceneRay(gl_FragCoord.xy + uView.tile.xy);
  Split place = placeOf(uLists[slot(texel, kPlace)]);
  place = addSplit(place, makeSplit(uintBitsToFloat(uLists[slot(texel, kOffset)]), 0.0));
  FieldSurface s = emptyFieldSurface();
  uint ids = status & kCount;
  for (uint i = 0u; i < ids; ++i) addToSurface(s, uBalls[uLists[slot(texel, kIds + int(i))]], ray, place);
  writeSurface(depthValue(uView, heightOf(ray, place)), normalTowards(s, ray, (status & kInside) != 0u),
               blendedColor(s), max(s.id, 1u), distanceAlong(ray, place));
}

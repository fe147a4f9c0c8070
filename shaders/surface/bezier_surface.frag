#version 450 core
// flags: ALBEDO NORMAL ID DISTANCE WALKED
// What the surface is like where it was found (Kanamori et al. 2008, Figure 4, step 4). WALKED: some of
// the pixels kept no list (bezier_walk.frag).
#define LIST_ACCESS readonly
#include "include/view.glsl"
#include "include/ball_ray.glsl"
#include "shared/metaball.glsl"
#include "include/field.glsl"
#include "include/bezier.glsl"
#include "include/bezier_lists.glsl"
#include "include/gbuffer.glsl"
#ifdef WALKED
#include "include/bezier_balls.glsl"

// The balls that the ray is in behind a step.
void addWalked(inout FieldSurface s, uint step, SceneRay ray, Split place, uint from) {
  for (uint i = from; uCellBalls[i].begins <= step; ++i) {
    Chord chord = chordOf(uCellBalls[i].ball, ray);
    if (chord.enters > step || chord.leaves <= step) continue;
    addToSurface(s, uBalls[uCellBalls[i].ball], ray, chord.ray, placeBetween(chord.ray.middle, place));
  }
}
#endif

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy) - uRegion.xy;
  uint status = uLists[slot(texel, kStatus)];
  if ((status & kHit) == 0u) discard;
  SceneRay ray = sceneRay(gl_FragCoord.xy + uView.tile.xy);
  uint step = uLists[slot(texel, kPlace)];
  Split place = placeOf(step);
  place = addSplit(place, makeSplit(uintBitsToFloat(uLists[slot(texel, kOffset)]), 0.0));
  FieldSurface s = emptyFieldSurface();
  uint ids = status & kCount;
  for (uint i = 0u; i < ids; ++i) addToSurface(s, uBalls[uLists[slot(texel, kIds + int(i))]], ray, place);
#ifdef WALKED
  if ((status & kWalked) != 0u && ids == 0u) addWalked(s, step, ray, place, uLists[slot(texel, kFrom)]);
#endif
  writeSurface(depthValue(uView, heightOf(ray, place)), normalTowards(s, ray, (status & kInside) != 0u),
               blendedColor(s), max(s.id, 1u), distanceAlong(ray, place));
}

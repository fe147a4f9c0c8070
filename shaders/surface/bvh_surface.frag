#version 450 core
// flags: ALBEDO NORMAL ID DISTANCE
// What the surface is like where a ray has met it, from the members of its cell.
#include "include/view.glsl"
#include "include/ball_ray.glsl"
#include "shared/metaball.glsl"
#include "include/field.glsl"
#include "include/bvh.glsl"
#include "include/gbuffer.glsl"

layout(binding = 4) uniform usampler2D tHits;

void main() {
  uvec4 hit = texelFetch(tHits, ivec2(gl_FragCoord.xy) - uRegion.xy, 0);
  if ((hit.w & kHit) == 0u) discard;
  SceneRay ray = sceneRay(gl_FragCoord.xy + uView.tile.xy);
  Split place = makeSplit(uintBitsToFloat(hit.y), uintBitsToFloat(hit.z));
  Node leaf = fetchNode(hit.x);
  FieldSurface s = emptyFieldSurface();
  float most = -1e30;
  uint nearest = 0u;
  for (uint k = 0u; k < leaf.count; ++k) {
    uint index = memberAt(leaf.first + k);
    Ball ball = fetchBall(index);
    BallRay b = ballOnRay(ball.projection, ray);
    float along = placeBetween(b.middle, place);
    float w = (b.halfChord2 - along * along) * ball.inverseR2;
    if (w > most) {
      most = w;
      nearest = index;
    }
    if (!(w > 0.0)) continue;
    ball.color = uBalls[index].color;
    ball.id = uBalls[index].id;
    addToSurface(s, ball, ray, b, along);
  }
  if (s.id == 0u) addToSurface(s, uBalls[nearest], ray, place);  // rounding: its very end
  writeSurface(depthValue(uView, heightOf(ray, place)), normalTowards(s, ray, (hit.w & kInsideOut) != 0u),
               blendedColor(s), max(s.id, 1u), distanceAlong(ray, place));
}

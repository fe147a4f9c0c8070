#version 450 core
// flags: ALBEDO NORMAL ID DISTANCE
// What the surface is like where a hull's search has found it, and counts of what became of the pixels. Where
// no iteration converged and one ended without its tolerance, the pixel is magenta if that is asked for.
#include "include/view.glsl"
#include "include/ball_ray.glsl"
#include "shared/metaball.glsl"
#include "include/surface_point.glsl"
#include "include/newton.glsl"
#include "include/newton_balls.glsl"
#include "include/sums.glsl"
#include "include/gbuffer.glsl"

layout(binding = 3) uniform sampler2D tProjected;
layout(binding = 4) uniform usampler2D tStatus;
layout(binding = 5) uniform usampler2D tRank;
layout(binding = 6) uniform sampler2D tAt;
layout(binding = 7) uniform sampler2D tNear;
layout(binding = 8) uniform usampler2D tFailures;
// Of each ball by rank: start of its list of others; how many are smaller, how many there are; the first of
// those that may be active.
layout(binding = 9) uniform usampler2D tLists;

void count(ivec2 texel, uint status, bool found) {
  int at = sumsOf(texel);
  uint iterations = status >> kStatusBits;
  atomicAdd(uSums[at].pixels, 1u);
  atomicAdd(uSums[at].iterations, iterations);
  atomicMax(uSums[at].mostIterations, iterations);
  if ((status & kGrazing) != 0u) atomicAdd(uSums[at].grazing, 1u);
  if ((status & kFailed) != 0u && !found) atomicAdd(uSums[at].unfinished, 1u);
  if (found) atomicAdd(uSums[at].hits, 1u);
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy - uArea.xy);
  uint status = texelFetch(tStatus, texel, 0).x;
  if ((status & kTouched) == 0u) discard;
  uint rank = texelFetch(tRank, texel, 0).x;
  bool found = rank != 0u;
  count(texel, status, found);
  SceneRay ray = sceneRay(gl_FragCoord.xy + uView.tile.xy);
  if (!found) {
    if (uTerms.w == 0 || (status & kFailed) == 0u) discard;
    float depth = uintBitsToFloat(texelFetch(tFailures, texel, 0).x);
    Split failed = makeSplit(placeOfDepth(ray, depth), 0.0);
    writeSurface(depth, -ray.direction, 0xFF00FFu, 1u, distanceAlong(ray, failed));
    return;
  }
  --rank;
  BallRay b = ballOnRay(fetchProjection(tProjected, rank), ray);
  float along = texelFetch(tAt, texel, 0).x;
  uvec4 lists = texelFetch(tLists, ballTexel(rank, 1u), 0);
  Line line;
  line.center = centerOf(rank);
  line.nearest = toModel(b.nearest);
  line.direction = toModel(ray.direction);
  line.rank = rank;
  line.first = lists.x;
  line.from = lists.w;
  line.to = lists.z;
  line.sign = 1.0;
  FieldSurface s = emptyFieldSurface();
  Met all;
  all.count = -1;
  int balls = activeCount(line, all);
  for (int i = 0; i < balls; ++i) {
    Other o = activeBall(line, all, i);
    vec3 v = o.base + along * line.direction;
    float w = max(1.0 - dot(v, v) * o.inverseR2, 0.0);
    s.outward += o.coefficient * kernelSlopeAt(w) * o.inverseR2 * v;
    addShareToSurface(s, o.coefficient * kernelAt(w), o.color, o.id);
  }
  s.outward = toView(s.outward);
  Split at = addSplit(b.middle, makeSplit(along, 0.0));
  bool inside = uTerms.z != 0 && texelFetch(tNear, texel, 0).x > uField.x;
  writeSurface(depthValue(uView, heightOf(ray, at)), normalTowards(s, ray, inside), blendedColor(s),
               max(s.id, 1u), distanceAlong(ray, at));
}

#version 450 core
// flags: KERNEL_POWER KERNEL_QUARTIC CUBIC LAYERS TILES
// Ray casting of a pixel's list (Szécsi and Illés 2012, §6): separators are kept in order in a local array;
// those that no ball still to come can precede are safe, and are taken out one by one, each changing the
// running polynomial, which says whether the piece up to the next can cross the surface at all. Where it can,
// an exact piece is summed up anew from the balls that the ray is in; cubics are solved as they are. Places
// are relative to the first ball of the pixel, the running polynomial to the last separator.
#include "include/view.glsl"
#include "include/ball_ray.glsl"
#include "shared/metaball.glsl"
#include "shared/octahedral.glsl"
#include "include/field.glsl"
#include "include/lists.glsl"
#include "include/lists_nodes.glsl"
#include "include/lists_order.glsl"
#include "include/lists_roots.glsl"
#include "include/lists_pieces.glsl"
#include "include/lists_surface.glsl"
#ifdef LAYERS
#include "include/lists_layers.glsl"
#endif
#include "include/lists_trace.glsl"

layout(binding = 0) uniform sampler2D tCores;

// In order, in a ring: new ones lie at its far end, and few have to be moved.
const int kRing = 64;
Separator gRing[kRing];
int gFirst = 0, gCount = 0;

Separator separatorAt(int i) {
  return gRing[(gFirst + i) & (kRing - 1)];
}

void insertSeparator(Separator s) {
  int i = gCount;
  while (i > 0 && separatorAt(i - 1).x > s.x) {
    gRing[(gFirst + i) & (kRing - 1)] = separatorAt(i - 1);
    --i;
  }
  gRing[(gFirst + i) & (kRing - 1)] = s;
  ++gCount;
}

// The separators of a ball; false if the array has no room for them, or float32 no digits.
bool takeBall(uint index, SceneRay ray, Split base, float begin) {
  Ball ball = fetchBall(index);
  BallRay b = ballOnRay(ball.projection, ray);
  float middle = placeBetween(base, b.middle), halfChord = sqrt(max(b.halfChord2, 0.0));
  if (!(b.halfChord2 > 0.0) || middle + halfChord <= begin) return true;
  if (gCount + kSeparatorsOfBall > uLists.x) return false;
  if (abs(middle) * sqrt(ball.inverseR2) > uSettings.z) return false;
  float strength = strengthOf(ball, b.halfChord2);
  insertSeparator(Separator(middle - halfChord, halfChord, strength, ball.inverseR2));
#ifdef CUBIC
  insertSeparator(Separator(middle, 0.0, strength, halfChord));
  insertSeparator(Separator(middle + halfChord, -halfChord, strength, ball.inverseR2));
#else
  insertSeparator(Separator(middle + halfChord, -halfChord, -strength, ball.inverseR2));
#endif
  return true;
}

#ifndef CUBIC
// The balls that the ray is in between two places that no separator lies between.
Polygon sumExactly(float from, float to, out float leastR2) {
  Polygon sum = constantPolygon(-uField.x);
  leastR2 = 1e30;
  for (int i = 0; i < gCount; ++i) {
    Separator s = separatorAt(i);
    if (!isLeft(s) || s.x + 2.0 * s.y > 0.5 * (from + to)) continue;
    addExactly(sum, activeOf(s), from, to - from);
    leastR2 = min(leastR2, 1.0 / s.w);
  }
  return sum;
}
#endif

#ifdef RUNNING
Polygon gRunning;
float gAt;       // the place that it is relative to
float gTrust;    // beyond it rounding may have spoiled it
float gWeight;   // what its terms are of the size of
float gLeastR2;  // of the balls that changed it

void clearRunning() {
  gRunning = constantPolygon(0.0);
  gTrust = 1e30;
  gWeight = 0.0;
  gLeastR2 = 1e30;
}

// Terms grow with the power of the distance from where they were added: a support away they are still right
// to a few roundings of the field.
void trustFor(Separator s, float now) {
  if (s.y == 0.0) return;
  gTrust = min(gTrust, now + inversesqrt(s.w));
  gLeastR2 = min(gLeastR2, 1.0 / s.w);
}

void moveRunning(float now) {
  if (now > gAt) shiftPowers(gRunning, now - gAt);
  gAt = now;
}

void renewRunning(float now, float to) {
  clearRunning();
  gAt = now;
  for (int i = 0; i < gCount; ++i) {
    Separator s = separatorAt(i);
    if (!isLeft(s) || s.x + 2.0 * s.y > 0.5 * (now + to)) continue;
    addActive(gRunning, activeOf(s), now, 0.5 * (now + to));
    trustFor(s, now);
    gWeight += abs(s.z);
  }
}

void changeRunning(Separator s, float now) {
  moveRunning(now);
  addChange(gRunning, s, now);
  trustFor(s, now);
  if (s.y > 0.0) gWeight += abs(s.z);
}

Polygon runningBetween(float now, float to) {
  moveRunning(now);
  if (to > gTrust) renewRunning(now, to);
  return bernsteinOf(gRunning, to - now);
}

#ifndef CUBIC
// Whether the field surely keeps its sign.
bool keepsSign(float now, float to, bool inside) {
  vec2 range = rangeOf(runningBetween(now, to)) - uField.x;
  float margin = 2e-5 * gWeight + 1e-6 * uField.x;
  return inside ? range.x > margin : range.y < -margin;
}
#endif
#else
// The same from each ball's largest share.
bool keepsSign(float now, float to, bool inside) {
  if (inside) return false;
  float most = -uField.x;
  for (int i = 0; i < gCount; ++i) {
    Separator s = separatorAt(i);
    if (!isLeft(s) || s.x + 2.0 * s.y > 0.5 * (now + to)) continue;
    Active a = activeOf(s);
    float along = clamp(a.middle, now, to) - a.middle;
    float w = clamp((a.halfChord * a.halfChord - along * along) * a.inverseR2, 0.0, 1.0);
    most += max(a.strength, 0.0) * kernelAt(w) * 1.00001;
  }
  return most < 0.0;
}
#endif

Split placeAt(Split base, float now) {
  return addSplit(base, makeSplit(now, 0.0));
}

// Crossings between two places that no separator lies between; true if nothing more is to be found.
bool search(inout Trace trace, int within, float now, float to, ivec2 texel, uint head, SceneRay ray,
            Split base) {
  if (within == 0) {
    trace.known = true;
    if (!trace.inside) return false;
    return crossAt(trace, texel, head, ray, placeAt(base, now));  // rounding: the last ball's very end
  }
  ++trace.pieces;
#ifndef CUBIC
  if (trace.known && keepsSign(now, to, trace.inside)) return false;
#endif
  bool crossedHere = false;
  for (int i = 0; i <= kMostDegree && to > now; ++i) {
    float leastR2, at;
#ifdef CUBIC
    Polygon sum = runningBetween(now, to);
    for (int k = 0; k <= kMostDegree; ++k) sum.c[k] -= uField.x;
    leastR2 = gLeastR2;
#else
    Polygon sum = sumExactly(now, to, leastR2);
#endif
    if (!findCrossing(trace, sum, to - now, leastR2, crossedHere, at)) return false;
    now += at * (to - now);
    if (crossAt(trace, texel, head, ray, placeAt(base, now))) return true;
    crossedHere = true;
  }
  return false;
}

// false: this array or these digits do not suffice.
bool castList(inout Trace trace, ivec2 texel, ivec2 targetTexel, uint head, SceneRay ray) {
  Split start = startOf(ray);
  uint node = head;
  uvec2 ball = nodeAt(node);
  BallRay first = ballOnRay(fetchBall(ball.x).projection, ray);
  Split base = addSplit(first.middle, makeSplit(-sqrt(max(first.halfChord2, 0.0)), 0.0));
  if (placeBetween(start, base) < 0.0) base = start;
  float now = placeBetween(base, start), begin = now;
  float slant = slantOf(ray), hidden = hiddenFrom(texelFetch(tCores, texel, 0).r, base);
  float unsafe = firstPlace(ball.x, slant) - base.hi - 1e-6 * abs(base.hi);
  int within = 0;
#ifdef RUNNING
  clearRunning();
  gAt = now;
#endif
  while (true) {
    while (node != 0u && (gCount == 0 || separatorAt(0).x > unsafe)) {
      if (!takeBall(ball.x, ray, base, begin)) return false;
      ++trace.taken;
      node = ball.y;
      if (node == 0u) break;
      ball = nodeAt(node);
      unsafe = firstPlace(ball.x, slant) - base.hi - 1e-6 * abs(base.hi);
    }
    if (gCount == 0) break;
    Separator s = separatorAt(0);
    if (s.x > now) {
      if (search(trace, within, now, s.x, targetTexel, head, ray, base)) return true;
      now = s.x;
      if (now > hidden) return true;
    }
#ifdef RUNNING
    changeRunning(s, now);
#endif
    gFirst = (gFirst + 1) & (kRing - 1);
    --gCount;
    if (s.y != 0.0) within += isLeft(s) ? -1 : 1;
#ifdef RUNNING
    if (within == 0) clearRunning();
#endif
  }
  if (trace.inside) crossAt(trace, targetTexel, head, ray, placeAt(base, now));
  return true;
}

void main() {
#ifdef LAYERS
  ivec2 targetTexel = ivec2(gl_FragCoord.xy), texel = targetTexel - uRegion.xy;
  beginLayers(targetTexel);
#else
  ivec2 texel = ivec2(gl_FragCoord.xy), targetTexel = texel + uRegion.xy;
  oPlace = vec2(0.0);
#endif
  int pixel = pixelOf(texel);
#ifdef TILES
  uint head = nodeOfTile(targetTexel);
#else
  uint head = uHeads[pixel];
#endif
  if (head != 0u) {
    bool moved;
    head = orderedList(head, moved);
    SceneRay ray = sceneRay(vec2(targetTexel) + 0.5 + uView.tile.xy);
    Trace trace = freshTrace();
    bool answered = castList(trace, texel, targetTexel, head, ray);
    uint flags = 0u;
    if (moved) atomicAdd(uSums[sumsOf(texel)].unordered, 1u);
    if (answered && !loopsAreEnded(uLists.w)) {
      count(texel, trace, true);
#ifndef LAYERS
      flags = gFlags;
#endif
    } else {
      flags = kUnanswered;
      atomicAdd(uUnanswered, 1u);
      atomicAdd(uSums[sumsOf(texel)].overflow, 1u);
#ifdef LAYERS
      beginLayers(targetTexel);
#endif
    }
    uHeads[pixel] = head | flags;
  }
#ifdef LAYERS
  endLayers();
#endif
}

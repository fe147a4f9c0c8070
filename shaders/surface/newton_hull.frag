#version 450 core
// flags: KERNEL_POWER KERNEL_QUARTIC TERMS PLAIN
// The surface within one ball's hull; the depth test decides between hulls. PLAIN: as the poster has it,
// Newton's method from where the ray enters the hull. Without: each place of the ray is looked after by the
// smallest ball around it, so that all that is active there is at least as large as what lengths are relative
// to, and the first root of its stretches is found for certain.
#include "include/view.glsl"
#include "include/ball_ray.glsl"
#include "shared/metaball.glsl"
#include "include/surface_point.glsl"
#include "include/kernel.glsl"
#include "include/core.glsl"
#include "include/newton.glsl"
#include "include/newton_balls.glsl"
#include "include/newton_field.glsl"
#include "include/newton_roots.glsl"
#include "include/sums.glsl"

layout(location = 0) flat in vec4 vPixel;
layout(location = 1) flat in vec4 vPlace;
layout(location = 2) flat in vec4 vEye;
layout(location = 3) flat in vec4 vCenter;
layout(location = 4) flat in vec2 vHull;
layout(location = 5) flat in uvec4 vLists;

layout(binding = 3) uniform sampler2D tProjected;  // four texels a ball, by rank (field.glsl's Ball)
layout(binding = 4) uniform sampler2D tLimit;      // depth of what hides all behind it
layout(binding = 5) uniform sampler2D tNear;       // the field where the ray begins

layout(depth_less) out float gl_FragDepth;
layout(location = 0) out uint oRank;  // plus one; 0 is the background
layout(location = 1) out float oAt;   // where on the ray, relative to its ball
layout(r32ui, binding = 0) restrict uniform uimage2D uStatus;
#ifdef PLAIN
layout(r32ui, binding = 1) restrict uniform uimage2D uFailures;  // bits of the nearest depth
#endif

#ifdef PLAIN
Found newton(Line line, float from, float to, float support, inout Effort effort, out bool failed) {
  Met met = ballsMet(line, from, to);
  ++effort.pieces;
  float at = from, enough = uSolver.x * support;
  for (int i = 0; i < uTerms.y; ++i) {
    ++effort.iterations;
    Value v = valueAt(line, met, at);
    float step = -v.f / v.slope;
    if (!(abs(step) < 1e30)) break;
    at += step;
    if (abs(step) <= enough) {
      failed = false;
      return Found(at >= from - enough && at <= to + enough, at);
    }
  }
  failed = at >= from && at <= to;
  return Found(false, at);
}
#else
// Where the ray is in one of the smaller balls, relative to the hull's; the same numbers as in its own hull.
vec2 chordOf(uint rank, SceneRay ray, Split middle) {
  BallRay b = ballOnRay(fetchProjection(tProjected, rank), ray);
  if (!(b.halfChord2 > 0.0)) return vec2(1.0, -1.0);
  float halfChord = sqrt(b.halfChord2), place = placeBetween(middle, b.middle);
  return vec2(place - halfChord, place + halfChord);
}

const int kMostChords = 32;
struct Chords {
  vec2 ends[kMostChords];
  int count;  // -1: too many to be kept
};

Chords smallerChords(SceneRay ray, Split middle, float from, float to) {
  Chords chords;
  chords.count = 0;
  for (uint k = 0u; k < vLists.z; ++k) {
    vec2 c = chordOf(otherRank(vLists.y + k), ray, middle);
    if (!(c.y > from && c.x < to && c.x < c.y)) continue;
    if (chords.count == kMostChords) {
      chords.count = -1;
      break;
    }
    chords.ends[chords.count++] = c;
    if (c.x <= from && c.y >= to) break;  // all of it
  }
  return chords;
}

// The next stretch after `from` that no smaller ball holds; empty at `to`.
vec2 nextStretch(Chords chords, SceneRay ray, Split middle, float from, float to) {
  int count = chords.count >= 0 ? chords.count : int(vLists.z);
  float end = to;
  for (int pass = 0; pass <= count; ++pass) {
    bool moved = false;
    end = to;
    for (int k = 0; k < count; ++k) {
      vec2 c = chords.count >= 0 ? chords.ends[k] : chordOf(otherRank(vLists.y + uint(k)), ray, middle);
      if (!(c.x < c.y)) continue;
      if (c.x <= from && c.y > from) {
        from = c.y;
        moved = true;
      } else if (c.x > from) {
        end = min(end, c.x);
      }
    }
    if (!moved || from >= to) break;
  }
  return vec2(min(from, to), end);
}
#endif

void mark(ivec2 texel, uint bits) {
  if ((imageLoad(uStatus, texel).x & bits) != bits) imageAtomicOr(uStatus, texel, bits);
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  SceneRay ray = sceneRay(gl_FragCoord.xy + uArea.xy + uView.tile.xy);
  BallProjection ball;
  ball.pixel = vPixel;
  ball.place = vPlace;
  ball.eye = vEye;
  BallRay b = ballOnRay(ball, ray);
  float begin = placeBetween(b.middle, startOf(ray));
  float halfChord = sqrt(max(b.halfChord2, 0.0));
  if (!(b.halfChord2 > 0.0 && halfChord > begin)) discard;
  mark(texel, kTouched);
#ifdef PLAIN
  float square = vHull.x - dot(b.nearest, b.nearest);
  if (!(square > 0.0)) discard;
  halfChord = sqrt(square);
#endif
  float from = max(-halfChord, begin), to = halfChord;
  bool inside = uTerms.z != 0 && texelFetch(tNear, texel, 0).x > uField.x;
#ifndef PLAIN
  float depth = texelFetch(tLimit, texel, 0).x;
  if (depth > 0.0) {
    float place = placeOfDepth(ray, depth);
    to = min(to, placeBetween(b.middle, makeSplit(place, slackOfDepth(place))));
  }
#endif
  if (!(from < to)) discard;

  Line line;
  line.center = vCenter.xyz;
  line.nearest = toModel(b.nearest);
  line.direction = toModel(ray.direction);
  line.rank = vLists.x;
  line.first = vLists.y;
  line.to = vLists.w;
  line.sign = inside ? -1.0 : 1.0;
  float support = sqrt(vPlace.y);
  Effort effort = Effort(0, 0, false, false);
  Found found = Found(false, 0.0);
#ifdef PLAIN
  line.from = 0u;
  bool failed = false;
  found = newton(line, from, to, support, effort, failed);
  effort.unfinished = failed;
#else
  line.from = vLists.z;
  Chords chords = smallerChords(ray, b.middle, from, to);
  for (uint i = 0u; i <= vLists.z; ++i) {
    vec2 stretch = nextStretch(chords, ray, b.middle, from, to);
    if (!(stretch.x < stretch.y)) break;
    found = firstRoot(line, stretch.x, stretch.y, support, vEye.w, effort);
    if (found.hit) break;
    from = stretch.y;
  }
#endif
  if (effort.iterations > 0) {
    imageAtomicAdd(uStatus, texel, uint(effort.iterations) << kStatusBits);
    atomicAdd(uSums[sumsOf(texel)].pieces, uint(effort.pieces));
  }
  uint bits = (effort.unfinished ? kFailed : 0u) | (effort.grazing ? kGrazing : 0u);
  if (bits != 0u) mark(texel, bits);
  Split at = addSplit(b.middle, makeSplit(found.at, 0.0));
#ifdef PLAIN
  if (effort.unfinished) {
    float failedDepth = clamp(depthValue(uView, heightOf(ray, at)), 1e-30, 1.0);
    imageAtomicMax(uFailures, texel, floatBitsToUint(failedDepth));
  }
#endif
  if (!found.hit) discard;
  gl_FragDepth = min(max(depthValue(uView, heightOf(ray, at)), 1e-30), gl_FragCoord.z);
  oRank = vLists.x + 1u;
  oAt = found.at;
}

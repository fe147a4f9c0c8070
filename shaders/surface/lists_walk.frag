#version 450 core
// flags: KERNEL_POWER KERNEL_QUARTIC CUBIC LAYERS TILES
// Ray casting of a pixel's list without an array, where lists_cast.frag's is too short or its places have too
// few digits: for each piece the list is walked from the first ball that the ray has not left to the first
// that cannot begin before the piece's end. Everything is relative to the beginning of the piece, itself a
// pair of floats. Each time it is drawn a pixel goes on for some pieces, so that no driver loses its
// patience.
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

// Of each pixel of the region: its place, hi and lo; the node of the first ball it has not left, 0 = it has
// not begun; 1 if it is known whether it is inside, + 2 if it is.
layout(std430, binding = 6) restrict buffer States {
  uvec4 uStates[];
};

const float kFar = 1e30;

// Nodes that a pixel looks at each time, about: as a group of 16 they stay below 65,535 (include/loops.glsl).
const int kMostLooks = 3500;
int gLooks = 0;

// Places from `now` on of a ball; those that are closer than rounding count as passed.
struct Span {
  bool met, entered, left;
  float middle, halfChord;
};

Span spanOf(Ball ball, SceneRay ray, Split now) {
  BallRay b = ballOnRay(ball.projection, ray);
  Span s;
  s.met = b.halfChord2 > 0.0;
  s.halfChord = sqrt(max(b.halfChord2, 0.0));
  s.middle = placeBetween(now, b.middle);
  float rounding = 1e-6 * s.halfChord;
  s.entered = s.middle - s.halfChord <= rounding;
  s.left = s.middle + s.halfChord <= rounding;
  return s;
}

struct Piece {
  float size;  // kFar: there is none
  int within;
  uint first;  // node of the first ball that has not been left
  uint alone;  // a ball that the ray is in
};

Piece pieceFrom(uint from, Split now, float slant, SceneRay ray) {
  Piece piece = Piece(kFar, 0, from, 0u);
  bool passing = true;
  for (uint node = from; node != 0u;) {
    uvec2 n = nodeAt(node);
    ++gLooks;
    if (firstPlace(n.x, slant) - now.hi - 1e-6 * abs(now.hi) > piece.size) break;
    Span s = spanOf(fetchBall(n.x), ray, now);
    if (s.met && !s.left) {
      passing = false;
      if (!s.entered) {
        piece.size = min(piece.size, s.middle - s.halfChord);
      } else {
        ++piece.within;
        piece.alone = n.x;
        piece.size = min(piece.size, s.middle + s.halfChord);
#ifdef CUBIC
        if (s.middle > 1e-6 * s.halfChord) piece.size = min(piece.size, s.middle);
#endif
      }
    }
    node = n.y;
    if (passing) piece.first = node;
  }
  return piece;
}

Polygon sumExactly(Piece piece, Split now, float slant, SceneRay ray, float from, out float leastR2) {
  Polygon sum = constantPolygon(-uField.x);
  leastR2 = kFar;
  for (uint node = piece.first; node != 0u;) {
    uvec2 n = nodeAt(node);
    ++gLooks;
    if (firstPlace(n.x, slant) - now.hi - 1e-6 * abs(now.hi) > piece.size) break;
    Ball ball = fetchBall(n.x);
    Span s = spanOf(ball, ray, now);
    if (s.met && s.entered && !s.left) {
      float strength = strengthOf(ball, s.halfChord * s.halfChord);
#if defined(KERNEL_POWER) && !defined(CUBIC)
      gLooks += 2 * kMostDegree + int(uField.y * uField.y);  // loops of powerPiece()
#endif
      addExactly(sum, Active(s.middle, s.halfChord, strength, ball.inverseR2), from, piece.size - from);
      leastR2 = min(leastR2, ball.projection.place.y);
    }
    node = n.y;
  }
  return sum;
}

#ifndef CUBIC
// Of a ball alone. true: its core is crossed at `at`, between `from` and `size`.
bool meetCore(inout Trace trace, Ball ball, SceneRay ray, Split now, float from, float size, out float at) {
  BallRay b = ballOnRay(ball.projection, ray);
  vec2 ends = coreEnds(placeBetween(now, b.middle), halfCoreChord(ball.projection.eye.w, b.nearest));
  bool within = isInCore(ends, from);
  ++trace.looked;
  if (!trace.known) {
    trace.known = true;
    trace.inside = within;
  }
  at = from;
  if (from == 0.0 && within != trace.inside) return true;  // rounding opens no cracks between pieces
  at = trace.inside ? ends.y : ends.x;
  return at >= from && at < size;
}
#endif

bool search(inout Trace trace, Piece piece, Split now, float slant, ivec2 texel, uint head, SceneRay ray) {
  if (piece.within == 0) {
    trace.known = true;
    if (!trace.inside) return false;
    return crossAt(trace, texel, head, ray, now);  // rounding: the last ball's very end
  }
  ++trace.pieces;
  float from = 0.0;
  for (int i = 0; i <= kMostDegree && piece.size > from; ++i) {
    float at;
#ifndef CUBIC
    if (piece.within == 1) {
      if (!meetCore(trace, fetchBall(piece.alone), ray, now, from, piece.size, at)) return false;
      from = at;
    } else
#endif
    {
      float leastR2;
      Polygon sum = sumExactly(piece, now, slant, ray, from, leastR2);
      if (!findCrossing(trace, sum, piece.size - from, leastR2, i > 0, at)) return false;
      from += at * (piece.size - from);
    }
    if (crossAt(trace, texel, head, ray, addSplit(now, makeSplit(from, 0.0)))) return true;
  }
  return false;
}

// true: that is all. Otherwise `state` says where to go on.
bool walk(inout Trace trace, ivec2 texel, ivec2 targetTexel, uint head, SceneRay ray, inout uvec4 state) {
  Split now = makeSplit(uintBitsToFloat(state.x), uintBitsToFloat(state.y));
  uint first = state.z;
  float slant = slantOf(ray), cores = texelFetch(tCores, texel, 0).r;
  while (gLooks < kMostLooks) {
    Piece piece = pieceFrom(first, now, slant, ray);
    first = piece.first;
    trace.taken = max(trace.taken, uint(piece.within));
    if (!(piece.size < kFar)) {
      if (trace.inside) crossAt(trace, targetTexel, head, ray, now);
      return true;
    }
    int before = trace.effort.iterations;
    if (search(trace, piece, now, slant, targetTexel, head, ray)) return true;
    gLooks += (trace.effort.iterations - before) * kMostDegree;
    now = addSplit(now, makeSplit(piece.size, 0.0));
    if (hiddenFrom(cores, now) < 0.0) return true;
  }
  state = uvec4(floatBitsToUint(now.hi), floatBitsToUint(now.lo), first,
                (trace.known ? 1u : 0u) + (trace.inside ? 2u : 0u));
  return false;
}

void main() {
#ifdef LAYERS
  ivec2 targetTexel = ivec2(gl_FragCoord.xy), texel = targetTexel - uRegion.xy;
#else
  ivec2 texel = ivec2(gl_FragCoord.xy), targetTexel = texel + uRegion.xy;
  oPlace = vec2(0.0);
#endif
  int pixel = pixelOf(texel);
  uint head = uHeads[pixel];
  if ((head & kUnanswered) == 0u) discard;
  head &= kFirstNode;
  SceneRay ray = sceneRay(vec2(targetTexel) + 0.5 + uView.tile.xy);
  Trace trace = freshTrace();
  uvec4 state = uStates[pixel];
  if (state.z == 0u) {
    bool moved;
    head = orderedList(head, moved);
    Split start = startOf(ray);
    state = uvec4(floatBitsToUint(start.hi), floatBitsToUint(start.lo), head, 0u);
  }
  trace.known = (state.w & 1u) != 0u;
  trace.inside = (state.w & 2u) != 0u;
#ifdef LAYERS
  beginLayers(targetTexel);
#endif
  bool finished = walk(trace, texel, targetTexel, head, ray, state);
  uint flags = kUnanswered;
  if (finished) {
#ifdef LAYERS
    flags = 0u;
#else
    flags = gFlags;
#endif
  } else {
    atomicAdd(uUnanswered, 1u);
  }
#ifdef LAYERS
  endLayers();
#endif
  if (loopsAreEnded(uLists.w)) atomicAdd(uExhausted, 1u);
  uHeads[pixel] = head | flags;
  uStates[pixel] = state;
  count(texel, trace, finished);
}

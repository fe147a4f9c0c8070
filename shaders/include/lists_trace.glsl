// What both ways through a list share (lists_cast.frag, lists_walk.frag): their results and what they count.
// Needs the other include/lists_*.glsl.
#define MORE_SUMS uint looked, taken, unordered, longest;
#include "include/sums.glsl"
#include "include/loops.glsl"

layout(std430, binding = 4) restrict buffer Control {
  uint uUnanswered;  // pixels to be done again, or to be gone on with
  uint uExhausted;   // pixels for which the driver ended a loop
};

struct Trace {
  bool known;    // whether F > 0 where the ray begins
  bool inside;   // F > 0
  uint crossed;  // how often
  Effort effort;
  uint pieces;  // between separators, within balls
  uint looked;  // of those, for which the roots of a polynomial were looked for
  uint taken;   // balls
};

Trace freshTrace() {
  return Trace(false, false, 0u, Effort(0, false, false), 0u, 0u, 0u);
}

// Bernstein coefficients of F on an interval, whose first is at the beginning. true: it crosses the surface,
// at `at` of the interval's length.
bool findCrossing(inout Trace trace, Polygon sum, float size, float leastR2, bool crossedHere, out float at) {
  ++trace.looked;
  if (!trace.known) {
    trace.known = true;
    trace.inside = sum.c[0] > 0.0;
  }
  if (trace.inside) {
    for (int k = 0; k <= fieldDegree(); ++k) sum.c[k] = -sum.c[k];
  }
  if (crossedHere) sum.c[0] = min(sum.c[0], 0.0);  // it is zero
  // Float32 resolves 1e-7 of the interval.
  at = firstRoot(sum, max(uSettings.y * sqrt(leastR2) / size, 5e-7), trace.effort);
  return at <= 1.0;
}

#ifdef LAYERS
bool crossAt(inout Trace trace, ivec2 texel, uint head, SceneRay ray, Split place) {
  addCrossing(texel, head, ray, place, trace.inside);
  trace.inside = !trace.inside;
  ++trace.crossed;
  return false;
}
#else
layout(location = 0) out vec2 oPlace;
uint gFlags = 0u;

// Whether that is all there is to find.
bool crossAt(inout Trace trace, ivec2 texel, uint head, SceneRay ray, Split place) {
  oPlace = vec2(place.hi, place.lo);
  gFlags = kHit | (trace.inside ? kInside : 0u);
  ++trace.crossed;
  return true;
}
#endif

void count(ivec2 texel, Trace trace, bool finished) {
  int at = sumsOf(texel);
  if (finished) atomicAdd(uSums[at].pixels, 1u);
  atomicAdd(uSums[at].pieces, trace.pieces);
  atomicAdd(uSums[at].looked, trace.looked);
  atomicAdd(uSums[at].taken, trace.taken);
  atomicMax(uSums[at].longest, trace.taken);
  if (trace.crossed > 0u) atomicAdd(uSums[at].hits, trace.crossed);
  if (trace.effort.iterations > 0) {
    atomicAdd(uSums[at].iterations, uint(trace.effort.iterations));
    atomicMax(uSums[at].mostIterations, uint(trace.effort.iterations));
  }
  if (trace.effort.grazing) atomicAdd(uSums[at].grazing, 1u);
  if (trace.effort.unfinished) atomicAdd(uSums[at].unfinished, 1u);
}

// A place behind which nothing counts, from `from`.
float hiddenFrom(float cores, Split from) {
  if (!(cores < 1.0)) return 1e30;
  return (cores + 1e-6 - 0.5) / uSettings.x - from.hi;
}

#version 450 core
// flags: KERNEL_POWER KERNEL_QUARTIC PLAIN
// Goes on along the rays of pixels whose list was too short, or whose layers too many, without a list: from
// place to place, and at each through all balls of the cell that reach it. The balls that the ray is in
// between two events are those that are entered before and left after it: the pieces are the same that
// bezier_step.frag would search with a longer list. Where many balls begin or end close together, though,
// bounds of the field show that no surface lies among them, and all of these events are passed at once. A
// long way is taken in several draws.
#include "include/view.glsl"
#include "include/ball_ray.glsl"
#include "shared/metaball.glsl"
#include "include/field.glsl"
#include "include/kernel.glsl"
#include "include/bernstein.glsl"
#include "include/bezier.glsl"
#include "include/bezier_lists.glsl"
#include "include/bezier_pixel.glsl"
#include "include/bezier_balls.glsl"
#include "include/loops.glsl"

layout(binding = 4) uniform sampler2D tDepth;

// Balls after which a pixel waits for the next draw: none may take long, or the driver ends it.
#ifdef KERNEL_POWER
const uint kMostTurns = 64u;  // each has loops of its own
#else
const uint kMostTurns = 4096u;
#endif
const uint kMostPassed = 8192u;  // balls left behind in one look
const uint kLongestReach = 0x08000000u;
// The first reach, as a share of a radius: many balls that begin within that are as good as coincident.
const float kFirstReach = 1.0 / 64.0;

// Of the field on a stretch of the ray.
struct Bounds {
  float low, high;
  float size;  // of the sums' terms, without regard to signs
  float terms;
};

// w on [0, size] is between these, whatever rounding did: places are right to a rounding of the stretch.
vec2 rangeOfW(BallRay b, float middle, float inverseR2, float size) {
  float nearest = max(max(-middle, middle - size), 0.0);
  float farthest = max(abs(middle), abs(middle - size));
  vec2 w = (b.halfChord2 - vec2(farthest * farthest, nearest * nearest)) * inverseR2;
  float slack = 4e-6 * (1.0 + size * sqrt(inverseR2));
  return clamp(w + vec2(-slack, slack), 0.0, 1.0);
}

void addBounds(inout Bounds bounds, vec2 share, BallRay b, float middle, float size) {
  vec2 w = rangeOfW(b, middle, share.y, size);
  vec2 ends = share.x * vec2(kernelOf(w.x), kernelOf(w.y));
  bounds.low += min(ends.x, ends.y);
  bounds.high += max(ends.x, ends.y);
  bounds.size += abs(ends.y);
  bounds.terms += 1.0;
}

// What a look is for, beside what there is at the stretch's end.
const int kArrive = 0;  // nothing else
const int kSearch = 1;  // the field on the stretch, which has no events within
const int kBound = 2;   // bounds of the field on it

struct Look {
  bool ended;   // it ended early: so many balls are passed that the rest is left to the next draw
  uint next;    // the first event after the stretch, or kNoEvent
  uint count;   // of balls that the ray is in at its end
  uint only;    // one of them
  uint left;    // a ball that is left there
  float least;  // R^2 of the smallest ball that the ray is in at its beginning
  Polygon sum;
  Bounds bounds;
};

// At all balls that the ray meets on [at, to] and until the next event.
Look look(int what, uint at, uint to, SceneRay ray, inout uint from, inout uint turns) {
  Look l;
  l.ended = false;
  l.next = kNoEvent;
  l.count = 0u;
  l.only = 0u;
  l.left = 0u;
  l.least = 1e30;
  l.sum = constantPolygon(-uField.x);
  l.bounds = Bounds(0.0, 0.0, 0.0, 0.0);
  Split start = placeOf(at);
  float size = float(to - at) * uSteps.x;
  uint first = from, i = from;
  for (;; ++i) {
    CellBall entry = uCellBalls[i];
    if (entry.begins > l.next) break;
    Chord chord = chordOf(entry.ball, ray);
    if (chord.leaves <= at) {
      if (i == from) ++from;
      if (from - first < kMostPassed) continue;
      l.ended = true;
      break;
    }
    bool entered = chord.enters <= at;
    if (entered) l.least = min(l.least, chord.radius2);
    if (what == kSearch && entered) {
      vec2 share = fetchShare(entry.ball);
      float middle = placeBetween(start, chord.ray.middle);
      addShare(l.sum, windowOn(middle, chord.ray.halfChord2, share.y, 0.0, size), share.x);
    }
    if (what == kBound && chord.enters < to)
      addBounds(l.bounds, fetchShare(entry.ball), chord.ray, placeBetween(start, chord.ray.middle), size);
    if (chord.leaves > to) {
      bool isIn = chord.enters <= to;
      l.next = min(l.next, isIn ? chord.leaves : chord.enters);
      l.count += isIn ? 1u : 0u;
      l.only = isIn ? entry.ball : l.only;
    } else if (chord.leaves == to) {
      l.left = entry.ball;
    }
  }
  turns += i - first + 1u;
  return l;
}

// Whether there is certainly no surface where the field is within the bounds.
bool isSettled(Bounds bounds, inout uint status) {
  float error = bounds.size * (1e-5 + 1e-6 * bounds.terms) + 1e-5 * abs(uField.x);
  bool below = bounds.high + error < uField.x;
  bool above = bounds.low - error > uField.x;
  if ((status & (kInside | kOutside)) == 0u) status |= above ? kInside : below ? kOutside : 0u;
  return (status & kInside) != 0u ? above : below;
}

// Where on its ray a pixel is, and what there is.
struct Walk {
  uint at, from, reach;
  uint turns, looks;
  Look here;
};

// Passes many events at once if it is certain that there is no surface among them.
bool jump(SceneRay ray, inout Walk w, inout Pixel p) {
  if (w.reach <= w.here.next - w.at) return false;
  uint to = min(w.at + w.reach, kNoEvent - 1u);
  Look there = look(kBound, w.at, to, ray, w.from, w.turns);
  ++w.looks;
  if (there.ended || !isSettled(there.bounds, p.status)) {
    w.reach /= 8u;
    return false;
  }
  w.at = to;
  w.here = there;
  return true;
}

// The surface before the next event, which is taken in if there is none.
Found search(ivec2 texel, SceneRay ray, inout Walk w, inout Pixel p) {
  uint to = w.here.next, count = w.here.count;
  Look there;
  if (count > 1u) {
    there = look(kSearch, w.at, to, ray, w.from, w.turns);
  } else {
    there = look(kArrive, w.at, to, ray, w.from, w.turns);
  }
  ++w.looks;
  if (there.ended) return kNothing;
  Found found = kNothing;
  if (count == 0u) {
    p.status |= kOutside;
  } else {
    Split start = placeOf(w.at);
    float size = float(to - w.at) * uSteps.x;
    int before = p.effort.iterations;
    found = count == 1u ? meetCore(fetchBall(w.here.only), ray, start, size, p.status)
                        : meetSum(there.sum, there.least, size, p.status, p.effort);
    notePiece(p, before);
  }
  if (found.hit) return found;
  w.at = to;
  w.here = there;
  if (there.count > 0u || (p.status & kInside) == 0u) return kNothing;
  uLists[slot(texel, kIds)] = there.left;  // rounding: the exit lies on the last ball's very end
  ++p.status;
  return Found(true, 0.0);
}

// Until the surface is found, there is none, or this draw has done enough: true if the pixel is finished.
bool walk(ivec2 texel, SceneRay ray, inout Walk w, inout Pixel p) {
  uint hidden = hiddenFrom(ray, texelFetch(tDepth, texel + uRegion.xy, 0).r);
  w.here = look(kArrive, w.at, w.at, ray, w.from, w.turns);
  ++w.looks;
  if (w.here.ended) return false;
  atomicMax(uSums[sumsOf(texel)].longest, w.here.count);
  if (w.reach == 0u)
    w.reach = uint(clamp(sqrt(w.here.least) * kFirstReach * uSteps.y, 1.0, float(kLongestReach)));
  for (;;) {
    if (w.here.next >= kNoEvent) return true;
    uint before = w.at, turns = w.turns;
    if (!jump(ray, w, p)) {
      Found found = search(texel, ray, w, p);
      if (found.hit) {
        storeHit(texel, p, w.at, found.offset);
        return true;
      }
    }
    if (w.at == before) return false;  // it ended early
    if (w.at > hidden) return true;    // the rest is hidden by what is drawn already
    atomicMax(uSums[sumsOf(texel)].longest, w.here.count);
    w.reach = min(2u * w.reach, kLongestReach);
    uint spent = w.turns - turns;
    if ((p.status & kCareful) != 0u || w.turns + 2u * spent > kMostTurns) return false;
  }
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  Pixel p = loadPixel(texel);
  if ((p.status & (kWalks | kWalked)) != kWalks) discard;
  SceneRay ray = sceneRay(vec2(texel + uRegion.xy) + 0.5 + uView.tile.xy);
  uint unchanged = p.status;
  Walk w;
  w.at = uLists[slot(texel, kPlace)];
  w.reach = uLists[slot(texel, kReach)];
  w.from = max(uLists[slot(texel, kFrom)], uint(vCell.y));
  w.turns = 0u;
  w.looks = 0u;
  bool finished = walk(texel, ray, w, p);
  if (loopsAreEnded(uList.z)) {  // nothing that was found can be relied on
    bool again = (unchanged & kCareful) == 0u;
    uLists[slot(texel, kStatus)] = unchanged | (again ? kCareful : kWalked);
    if (again) {
      stay(texel);
    } else {
      atomicAdd(uExhausted, 1u);
    }
    return;
  }
  atomicAdd(uSums[sumsOf(texel)].looks, w.looks);
  if (finished) {
    p.status |= kWalked;
    atomicAdd(uSums[sumsOf(texel)].walked, 1u);
    count(texel, p);
  } else {
    uLists[slot(texel, kPlace)] = w.at;
    uLists[slot(texel, kReach)] = w.reach;
    stay(texel);
  }
  if ((p.status & kCount) == 0u) uLists[slot(texel, kFrom)] = w.from;
  storePixel(texel, p);
}

#version 450 core
// flags: KERNEL_POWER KERNEL_QUARTIC PLAIN
// After each layer that is peeled (Kanamori et al. 2008, §4.2 and Figure 6): looks for the surface between
// the pixel's last event and the new one, and adds the ball that is entered to its list or takes out the one
// that is left.
#include "include/view.glsl"
#include "include/ball_ray.glsl"
#include "shared/metaball.glsl"
#include "include/field.glsl"
#include "include/bernstein.glsl"
#include "include/bezier.glsl"
#include "include/bezier_lists.glsl"

layout(binding = 0) uniform usampler2D tLastStep;
layout(binding = 1) uniform usampler2D tLastKey;
layout(binding = 2) uniform sampler2D tEvent;
layout(binding = 3) uniform usampler2D tEventKey;
layout(binding = 4) uniform sampler2D tDepth;

// The step and the key that become the pixel's last.
layout(location = 0) out uint oLastStep;
layout(location = 1) out uint oLastKey;

layout(std430, binding = 2) restrict buffer Control {
  uint uOverflow;    // pixels whose list was too short
  uint uBox[4];      // around them: least x, y, largest x, y
  uint uProgress[];  // of each cell: the last layer that left a pixel unfinished
};
layout(std430, binding = 4) restrict buffer Spilled {
  uint uSpilled[];  // of each pixel of the target: 1 if its list was too short
};

const int kSums = 64;
struct Sums {
  uint pixels, pieces, iterations, mostIterations, overflow, grazing, unfinished, events;
  uint solved, mostInPiece, hits, longest;
};
layout(std430, binding = 5) restrict buffer Statistics {
  Sums uSums[kSums];  // spread out, so that pixels seldom wait for each other
};

layout(location = 0) uniform ivec2 uCellLayer;  // which cell this is, and which layer

struct Found {
  bool hit;
  float offset;
};

const Found kNothing = Found(false, 0.0);

// Of a ball alone the surface is its core, a sphere (§3.1, "single case").
Found meetCore(Ball ball, SceneRay ray, Split start, float size, inout uint status) {
  BallRay b = ballOnRay(ball.projection, ray);
  float square = ball.projection.eye.w - dot(b.nearest, b.nearest);
  float halfChord = sqrt(max(square, 0.0));
  float middle = placeBetween(start, b.middle);
  float low = middle - halfChord, high = middle + halfChord;
  bool within = square > 0.0 && low < 0.0 && high > 0.0;
  if ((status & (kInside | kOutside)) == 0u) status |= within ? kInside : kOutside;
  if ((status & kInside) != 0u) {
    if (!within) return Found(true, 0.0);
    return high < size ? Found(true, high) : kNothing;
  }
  if (square > 0.0 && high > 0.0 && low < size) return Found(true, max(low, 0.0));
  return kNothing;
}

Found meetSum(ivec2 texel, uint count, SceneRay ray, Split start, float size, inout uint status,
              inout Effort effort) {
  Polygon sum = constantPolygon(-uField.x);
  float least = 1e30;
  for (uint i = 0u; i < count; ++i) {
    Ball ball = uBalls[uLists[slot(texel, kIds + int(i))]];
    BallRay b = ballOnRay(ball.projection, ray);
    float middle = placeBetween(start, b.middle);
    addShare(sum, windowOn(middle, b.halfChord2, ball.inverseR2, 0.0, size), ball.coefficient);
    least = min(least, ball.projection.place.y);
  }
  if ((status & (kInside | kOutside)) == 0u) status |= sum.c[0] > 0.0 ? kInside : kOutside;
  if ((status & kInside) != 0u) {
    for (int k = 0; k <= fieldDegree(); ++k) sum.c[k] = -sum.c[k];
  }
  // Float32 resolves 1e-7 of the interval.
  float root = firstRoot(sum, max(uSteps.z * sqrt(least) / size, 5e-7), effort);
  return root <= 1.0 ? Found(true, root * size) : kNothing;
}

void count(uint status, uint pieces, uint solved, Effort effort, uint mostInPiece) {
  int at = int(gl_FragCoord.x) / 8 + 13 * (int(gl_FragCoord.y) / 8) & (kSums - 1);
  atomicAdd(uSums[at].pixels, 1u);
  atomicAdd(uSums[at].pieces, pieces);
  atomicAdd(uSums[at].iterations, uint(effort.iterations));
  atomicMax(uSums[at].mostIterations, uint(effort.iterations));
  atomicAdd(uSums[at].events, uint(uCellLayer.y));
  atomicAdd(uSums[at].solved, solved);
  atomicMax(uSums[at].mostInPiece, mostInPiece);
  if ((status & kHit) != 0u) atomicAdd(uSums[at].hits, 1u);
  if ((status & kGrazing) != 0u) atomicAdd(uSums[at].grazing, 1u);
  if ((status & kUnfinished) != 0u) atomicAdd(uSums[at].unfinished, 1u);
}

// The list after an event; false if it is too short.
bool updateList(ivec2 texel, uint key, inout uint status) {
  uint index = key / 2u - 1u;
  uint ids = status & kCount;
  if ((key & 1u) == 0u) {
    if (int(ids) >= uList.x) return false;
    uLists[slot(texel, kIds + int(ids))] = index;
    ++status;
    atomicMax(uSums[int(gl_FragCoord.x) / 8 + 13 * (int(gl_FragCoord.y) / 8) & (kSums - 1)].longest,
              ids + 1u);
    return true;
  }
  for (uint i = 0u; i < ids; ++i) {
    if (uLists[slot(texel, kIds + int(i))] != index) continue;
    uLists[slot(texel, kIds + int(i))] = uLists[slot(texel, kIds + int(ids) - 1)];
    --status;
    break;
  }
  return true;
}

void spill(ivec2 texel) {
  atomicAdd(uOverflow, 1u);
  atomicMin(uBox[0], uint(texel.x));
  atomicMin(uBox[1], uint(texel.y));
  atomicMax(uBox[2], uint(texel.x));
  atomicMax(uBox[3], uint(texel.y));
  ivec2 at = texel + uRegion.xy;
  uSpilled[at.y * uList.w + at.x] = 1u;
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  uint lastStep = texelFetch(tLastStep, texel, 0).r;
  if (lastStep == kFinished) discard;
  uint lastKey = texelFetch(tLastKey, texel, 0).r;
  uint step = floatBitsToUint(texelFetch(tEvent, texel, 0).r);
  uint key = texelFetch(tEventKey, texel, 0).r;
  SceneRay ray = sceneRay(vec2(texel + uRegion.xy) + 0.5 + uView.tile.xy);

  bool fresh = lastKey == 0u;
  uint status = 0u, pieces = 0u, solved = 0u, mostInPiece = 0u;
  Effort effort = Effort(0, false, false);
  bool finished = step >= kNoEvent;
  if (fresh) {
    lastStep = firstStep(ray);
    ivec2 at = texel + uRegion.xy;
    if (uList.z != 0) {
      if (uSpilled[at.y * uList.w + at.x] == 0u) finished = true;
      uSpilled[at.y * uList.w + at.x] = 0u;
    }
  } else {
    status = uLists[slot(texel, kStatus)];
    uint effortWord = uLists[slot(texel, kEffort)], solvedWord = uLists[slot(texel, kSolved)];
    pieces = effortWord >> 16;
    effort.iterations = int(effortWord & 0xFFFFu);
    mostInPiece = solvedWord >> 16;
    solved = solvedWord & 0xFFFFu;
  }

  Found found = kNothing;
  if (!finished && step > lastStep) {
    Split start = placeOf(lastStep);
    float size = float(step - lastStep) * uSteps.x;
    uint ids = status & kCount;
    int before = effort.iterations;
    if (ids == 0u) {
      if ((status & (kInside | kOutside)) == 0u) status |= kOutside;
      if ((status & kInside) != 0u) {  // rounding: the exit lies on the last ball's very end
        found.hit = true;
        uLists[slot(texel, kIds)] = lastKey / 2u - 1u;
        ++status;
      }
    } else if (ids == 1u) {
      found = meetCore(uBalls[uLists[slot(texel, kIds)]], ray, start, size, status);
    } else {
      found = meetSum(texel, ids, ray, start, size, status, effort);
    }
    int spent = effort.iterations - before;
    if (ids > 0u) pieces = min(pieces + 1u, 0xFFFFu);
    if (spent > 0) solved = min(solved + 1u, 0xFFFFu);
    mostInPiece = max(mostInPiece, uint(spent));
    if (effort.grazing) status |= kGrazing;
    if (effort.unfinished) status |= kUnfinished;
    effort.iterations = min(effort.iterations, 0xFFFF);
  }
  if (found.hit) {
    status |= kHit;
    uLists[slot(texel, kPlace)] = lastStep;
    uLists[slot(texel, kOffset)] = floatBitsToUint(found.offset);
    finished = true;
  } else if (!finished) {
    if (step > lastStep && step > hiddenFrom(ray, texelFetch(tDepth, texel + uRegion.xy, 0).r)) {
      finished = true;  // the rest is hidden by what is drawn already
    } else if (!updateList(texel, key, status)) {
      finished = true;
      spill(texel);
      status |= kSpilled;
      if (uList.y == 0) {  // as the paper does (§7): what enters is taken for the surface
        status |= kHit;
        uLists[slot(texel, kPlace)] = step;
        uLists[slot(texel, kOffset)] = 0u;
      }
    }
  }
  uLists[slot(texel, kStatus)] = status;
  uLists[slot(texel, kEffort)] = pieces << 16 | uint(effort.iterations);
  uLists[slot(texel, kSolved)] = mostInPiece << 16 | solved;
  if (finished) {
    bool repaired = (status & kSpilled) != 0u && uList.y != 0;
    if (!(fresh && step >= kNoEvent) && !(fresh && uList.z != 0) && !repaired)
      count(status, pieces, solved, effort, mostInPiece);
    if ((status & kSpilled) != 0u && uList.z == 0) atomicAdd(uSums[0].overflow, 1u);
    oLastStep = kFinished;
    oLastKey = key;
  } else {
    uProgress[uCellLayer.x] = uint(uCellLayer.y);
    oLastStep = step;
    oLastKey = key;
  }
}

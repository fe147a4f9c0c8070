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
#define MORE_SUMS uint events, solved, mostInPiece, longest;
#include "include/sums.glsl"

layout(binding = 0) uniform usampler2D tLastStep;
layout(binding = 1) uniform usampler2D tLastKey;
layout(binding = 2) uniform sampler2D tEvent;
layout(binding = 3) uniform usampler2D tEventKey;
layout(binding = 4) uniform sampler2D tDepth;

// The step and the key that become the pixel's last.
layout(location = 0) out uint oLastStep;
layout(location = 1) out uint oLastKey;

struct Cell {
  uint unfinished;  // the last layer after which a pixel was not finished
  uint waiting;     // the last layer in which a pixel waited for balls that were not drawn
  uint least;       // the least of the pixels' last events, in layers that measure it
};
layout(std430, binding = 2) restrict buffer Control {
  uint uOverflow;  // pixels whose list was too short
  uint uBox[4];    // around them: least x, y, largest x, y
  Cell uCells[];
};
layout(std430, binding = 4) restrict buffer Spilled {
  uint uSpilled[];  // of each pixel of the target: 1 if its list was too short
};

layout(std430, binding = 6) writeonly restrict buffer Blocks {
  uint uBlocks[];  // of each 8 x 8 pixels of the region: the last layer after which one was not finished
};

layout(location = 0) flat in ivec2 vCell;
layout(location = 1) uniform ivec2 uLayer;  // which; 1 if uCells[].least is wanted

struct Found {
  bool hit;
  float offset;
};

const Found kNothing = Found(false, 0.0);

// §3.1, "single case".
Found meetCore(Ball ball, SceneRay ray, Split start, float size, inout uint status) {
  BallRay b = ballOnRay(ball.projection, ray);
  vec2 ends = coreEnds(placeBetween(start, b.middle), halfCoreChord(ball.projection.eye.w, b.nearest));
  if ((status & (kInside | kOutside)) == 0u) status |= isInCore(ends, 0.0) ? kInside : kOutside;
  float at = crossCore(ends, 0.0, size, (status & kInside) != 0u);
  return at < kNone ? Found(true, at) : kNothing;
}

Found meetSum(ivec2 texel, uint count, SceneRay ray, Split start, float size, inout uint status,
              inout Effort effort) {
  Polygon sum = constantPolygon(-uField.x);
  float least = 1e30;
  for (uint i = 0u; i < count; ++i) {
    Ball ball = fetchBall(uLists[slot(texel, kIds + int(i))]);
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

// What a pixel remembers from layer to layer.
struct Pixel {
  uint status;
  uint events, pieces, solved, mostInPiece;
  Effort effort;
};

Pixel freshPixel() {
  return Pixel(0u, 0u, 0u, 0u, 0u, Effort(0, false, false));
}

Pixel loadPixel(ivec2 texel) {
  Pixel p = freshPixel();
  p.status = uLists[slot(texel, kStatus)];
  p.events = uLists[slot(texel, kPlace)];
  uint effort = uLists[slot(texel, kEffort)], solved = uLists[slot(texel, kSolved)];
  p.pieces = effort >> 16;
  p.effort.iterations = int(effort & 0xFFFFu);
  p.mostInPiece = solved >> 16;
  p.solved = solved & 0xFFFFu;
  return p;
}

void storePixel(ivec2 texel, Pixel p) {
  uLists[slot(texel, kStatus)] = p.status;
  if ((p.status & kHit) == 0u) uLists[slot(texel, kPlace)] = p.events;
  uLists[slot(texel, kEffort)] = p.pieces << 16 | uint(p.effort.iterations);
  uLists[slot(texel, kSolved)] = p.mostInPiece << 16 | p.solved;
}

void storeHit(ivec2 texel, inout Pixel p, uint step, float offset) {
  p.status |= kHit;
  uLists[slot(texel, kPlace)] = step;
  uLists[slot(texel, kOffset)] = floatBitsToUint(offset);
}

// A pixel counts once it is finished; one that is going to be repaired, then.
void count(ivec2 texel, Pixel p) {
  int at = sumsOf(texel);
  if ((p.status & kSpilled) != 0u) {
    if (uList.z == 0) atomicAdd(uSums[at].overflow, 1u);
    if (uList.y != 0) return;
  }
  atomicAdd(uSums[at].pixels, 1u);
  atomicAdd(uSums[at].events, p.events);
  atomicAdd(uSums[at].pieces, p.pieces);
  atomicAdd(uSums[at].iterations, uint(p.effort.iterations));
  atomicMax(uSums[at].mostIterations, uint(p.effort.iterations));
  atomicAdd(uSums[at].solved, p.solved);
  atomicMax(uSums[at].mostInPiece, p.mostInPiece);
  if ((p.status & kHit) != 0u) atomicAdd(uSums[at].hits, 1u);
  if ((p.status & kGrazing) != 0u) atomicAdd(uSums[at].grazing, 1u);
  if ((p.status & kUnfinished) != 0u) atomicAdd(uSums[at].unfinished, 1u);
}

// The list after an event; false if it is too short.
bool updateList(ivec2 texel, uint key, inout uint status) {
  uint index = key / 2u - 1u;
  uint ids = status & kCount;
  if ((key & 1u) == 0u) {
    if (int(ids) >= uList.x) return false;
    uLists[slot(texel, kIds + int(ids))] = index;
    ++status;
    atomicMax(uSums[sumsOf(texel)].longest, ids + 1u);
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

// Whether this pixel is among those to be done again.
bool isToBeRepaired(ivec2 texel) {
  ivec2 at = texel + uRegion.xy;
  bool spilled = uSpilled[at.y * uList.w + at.x] != 0u;
  uSpilled[at.y * uList.w + at.x] = 0u;
  return spilled;
}

// The surface between two events.
Found search(ivec2 texel, SceneRay ray, uint lastStep, uint lastKey, uint step, inout Pixel p) {
  uint ids = p.status & kCount;
  if (ids == 0u) {
    if ((p.status & kInside) == 0u) {
      p.status |= kOutside;
      return kNothing;
    }
    uLists[slot(texel, kIds)] = lastKey / 2u - 1u;  // rounding: the exit lies on the last ball's very end
    ++p.status;
    return Found(true, 0.0);
  }
  Split start = placeOf(lastStep);
  float size = float(step - lastStep) * uSteps.x;
  int before = p.effort.iterations;
  Found found = ids == 1u ? meetCore(fetchBall(uLists[slot(texel, kIds)]), ray, start, size, p.status)
                          : meetSum(texel, ids, ray, start, size, p.status, p.effort);
  int spent = p.effort.iterations - before;
  p.pieces = min(p.pieces + 1u, 0xFFFFu);
  if (spent > 0) p.solved = min(p.solved + 1u, 0xFFFFu);
  p.mostInPiece = max(p.mostInPiece, uint(spent));
  p.effort.iterations = min(p.effort.iterations, 0xFFFF);
  if (p.effort.grazing) p.status |= kGrazing;
  if (p.effort.unfinished) p.status |= kUnfinished;
  return found;
}

// Takes in the next event; true if that was the last.
bool advance(ivec2 texel, SceneRay ray, uint lastStep, uint lastKey, uint step, uint key, inout Pixel p) {
  if (step >= kNoEvent) return true;
  ++p.events;
  if (step > lastStep) {
    Found found = search(texel, ray, lastStep, lastKey, step, p);
    if (found.hit) {
      storeHit(texel, p, lastStep, found.offset);
      return true;
    }
    // The rest is hidden by what is drawn already.
    if (step > hiddenFrom(ray, texelFetch(tDepth, texel + uRegion.xy, 0).r)) return true;
  }
  if (updateList(texel, key, p.status)) return false;
  spill(texel);
  p.status |= kSpilled;
  // As the paper does (§7): what enters is taken for the surface.
  if (uList.y == 0) storeHit(texel, p, step, 0.0);
  return true;
}

// There is more to do for this pixel. Whoever writes, writes the same.
void stay(ivec2 texel) {
  uCells[vCell.x].unfinished = uint(uLayer.x);
  uBlocks[(texel.y / 8) * ((uRegion.z + 7) / 8) + texel.x / 8] = uint(uLayer.x);
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  uint lastStep = texelFetch(tLastStep, texel, 0).r;
  if (lastStep == kFinished) discard;
  uint lastKey = texelFetch(tLastKey, texel, 0).r;
  uint step = floatBitsToUint(texelFetch(tEvent, texel, 0).r);
  uint key = texelFetch(tEventKey, texel, 0).r;
  bool fresh = lastKey == 0u;

  oLastStep = lastStep;
  oLastKey = lastKey;
  if (fresh && uList.z != 0 && !isToBeRepaired(texel)) {
    uLists[slot(texel, kStatus)] = 0u;
    oLastStep = kFinished;
    return;
  }
  if (step >= uint(vCell.y)) {  // a ball that was not drawn may come before
    if (fresh && uList.z != 0) uSpilled[(texel.y + uRegion.y) * uList.w + texel.x + uRegion.x] = 1u;
    stay(texel);
    uCells[vCell.x].waiting = uint(uLayer.x);
    if (uLayer.y != 0) atomicMin(uCells[vCell.x].least, lastStep);
    return;
  }
  SceneRay ray = sceneRay(vec2(texel + uRegion.xy) + 0.5 + uView.tile.xy);
  Pixel p = freshPixel();
  if (fresh) {
    lastStep = firstStep(ray);
  } else {
    p = loadPixel(texel);
  }
  bool finished = advance(texel, ray, lastStep, lastKey, step, key, p);
  storePixel(texel, p);
  if (finished) {
    if (p.events > 0u) count(texel, p);
    oLastStep = kFinished;
    return;
  }
  stay(texel);
  if (uLayer.y != 0) atomicMin(uCells[vCell.x].least, step);
  oLastStep = step;
  oLastKey = key;
}

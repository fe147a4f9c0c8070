// What the method "bezier" remembers of a pixel from draw to draw, and what it tells the processor of a cell.
// Needs include/field.glsl, bernstein.glsl, bezier.glsl, bezier_lists.glsl.
#define MORE_SUMS uint events, solved, mostInPiece, longest, walked, looks;
#include "include/sums.glsl"

struct Cell {
  uint unfinished;  // the last layer after which a pixel was not finished
  uint waiting;     // the last layer in which a pixel waited for balls that were not drawn
  uint least;       // the least of the pixels' last events, in layers that measure it
  uint walks;       // 1 if a pixel keeps no list any more
};
layout(std430, binding = 2) restrict buffer Control {
  uint uExhausted;  // pixels for which the driver ended a loop
  Cell uCells[];
};
layout(std430, binding = 6) writeonly restrict buffer Blocks {
  uint uBlocks[];  // of each 8 x 8 pixels of the region: the last layer after which one was not finished
};

layout(location = 0) flat in ivec2 vCell;   // which; what else the draw needs to know of it
layout(location = 1) uniform ivec2 uLayer;  // which; 1 if uCells[].least is wanted

// There is more to do for this pixel. Whoever writes, writes the same.
void stay(ivec2 texel) {
  uCells[vCell.x].unfinished = uint(uLayer.x);
  uBlocks[(texel.y / 8) * ((uRegion.z + 7) / 8) + texel.x / 8] = uint(uLayer.x);
}

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

// All but the events.
void storePixel(ivec2 texel, Pixel p) {
  uLists[slot(texel, kStatus)] = p.status;
  uLists[slot(texel, kEffort)] = p.pieces << 16 | uint(p.effort.iterations);
  uLists[slot(texel, kSolved)] = p.mostInPiece << 16 | p.solved;
}

void storeHit(ivec2 texel, inout Pixel p, uint step, float offset) {
  p.status |= kHit;
  uLists[slot(texel, kPlace)] = step;
  uLists[slot(texel, kOffset)] = floatBitsToUint(offset);
}

// Of a pixel that is finished.
void count(ivec2 texel, Pixel p) {
  int at = sumsOf(texel);
  atomicAdd(uSums[at].pixels, 1u);
  atomicAdd(uSums[at].pieces, p.pieces);
  atomicAdd(uSums[at].iterations, uint(p.effort.iterations));
  atomicMax(uSums[at].mostIterations, uint(p.effort.iterations));
  atomicAdd(uSums[at].solved, p.solved);
  atomicMax(uSums[at].mostInPiece, p.mostInPiece);
  if ((p.status & kHit) != 0u) atomicAdd(uSums[at].hits, 1u);
  if ((p.status & kGrazing) != 0u) atomicAdd(uSums[at].grazing, 1u);
  if ((p.status & kUnfinished) != 0u) atomicAdd(uSums[at].unfinished, 1u);
}

struct Found {
  bool hit;
  float offset;
};

const Found kNothing = Found(false, 0.0);

// Where a ball alone reaches the level: §3.1, "single case".
Found meetCore(Ball ball, SceneRay ray, Split start, float size, inout uint status) {
  BallRay b = ballOnRay(ball.projection, ray);
  vec2 ends = coreEnds(placeBetween(start, b.middle), halfCoreChord(ball.projection.eye.w, b.nearest));
  if ((status & (kInside | kOutside)) == 0u) status |= isInCore(ends, 0.0) ? kInside : kOutside;
  float at = crossCore(ends, 0.0, size, (status & kInside) != 0u);
  return at < kNone ? Found(true, at) : kNothing;
}

// Of a sum of shares less the level; least: the smallest R^2 of them.
Found meetSum(Polygon sum, float least, float size, inout uint status, inout Effort effort) {
  if ((status & (kInside | kOutside)) == 0u) status |= sum.c[0] > 0.0 ? kInside : kOutside;
  if ((status & kInside) != 0u) {
    for (int k = 0; k <= fieldDegree(); ++k) sum.c[k] = -sum.c[k];
  }
  // Float32 resolves 1e-7 of the interval.
  float root = firstRoot(sum, max(uSteps.z * sqrt(least) / size, 5e-7), effort);
  return root <= 1.0 ? Found(true, root * size) : kNothing;
}

// A piece was searched, when there had been `before` iterations.
void notePiece(inout Pixel p, int before) {
  int spent = p.effort.iterations - before;
  p.pieces = min(p.pieces + 1u, 0xFFFFu);
  if (spent > 0) p.solved = min(p.solved + 1u, 0xFFFFu);
  p.mostInPiece = max(p.mostInPiece, uint(spent));
  p.effort.iterations = min(p.effort.iterations, 0xFFFF);
  if (p.effort.grazing) p.status |= kGrazing;
  if (p.effort.unfinished) p.status |= kUnfinished;
}

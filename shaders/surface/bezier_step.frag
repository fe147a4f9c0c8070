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
#include "include/bezier_pixel.glsl"
#include "include/loops.glsl"

layout(binding = 0) uniform usampler2D tLastStep;
layout(binding = 1) uniform usampler2D tLastKey;
layout(binding = 2) uniform sampler2D tEvent;
layout(binding = 3) uniform usampler2D tEventKey;
layout(binding = 4) uniform sampler2D tDepth;

// The step and the key that become the pixel's last.
layout(location = 0) out uint oLastStep;
layout(location = 1) out uint oLastKey;

Found meetList(ivec2 texel, uint count, SceneRay ray, Split start, float size, inout Pixel p) {
  Polygon sum = constantPolygon(-uField.x);
  float least = 1e30;
  for (uint i = 0u; i < count; ++i) {
    Ball ball = fetchBall(uLists[slot(texel, kIds + int(i))]);
    BallRay b = ballOnRay(ball.projection, ray);
    float middle = placeBetween(start, b.middle);
    addShare(sum, windowOn(middle, b.halfChord2, ball.inverseR2, 0.0, size), ball.coefficient);
    least = min(least, ball.projection.place.y);
  }
  return meetSum(sum, least, size, p.status, p.effort);
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
                          : meetList(texel, ids, ray, start, size, p);
  notePiece(p, before);
  return found;
}

// From this step on bezier_walk.frag goes on without a list.
void leaveList(ivec2 texel, uint step, inout Pixel p) {
  p.status = p.status & ~kCount | kWalks;
  uLists[slot(texel, kPlace)] = step;
  uLists[slot(texel, kReach)] = 0u;
  uLists[slot(texel, kFrom)] = 0u;
  uCells[vCell.x].walks = 1u;
}

// The list is too short for what enters at a step.
void spill(ivec2 texel, uint step, inout Pixel p) {
  atomicAdd(uSums[sumsOf(texel)].overflow, 1u);
  if (uList.y == 0) {
    storeHit(texel, p, step, 0.0);  // as the paper does (§7): what enters is taken for the surface
  } else {
    leaveList(texel, step, p);
  }
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
  spill(texel, step, p);
  return true;
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  uint lastStep = texelFetch(tLastStep, texel, 0).r;
  if (lastStep == kFinished) discard;
  uint lastKey = texelFetch(tLastKey, texel, 0).r;
  uint step = floatBitsToUint(texelFetch(tEvent, texel, 0).r);
  uint key = texelFetch(tEventKey, texel, 0).r;

  oLastStep = lastStep;
  oLastKey = lastKey;
  bool last = uList.y != 0 && uLayer.x >= uList.y;
  if (step >= uint(vCell.y) && !last) {  // a ball that was not drawn may come before
    stay(texel);
    uCells[vCell.x].waiting = uint(uLayer.x);
    if (uLayer.y != 0) atomicMin(uCells[vCell.x].least, lastStep);
    return;
  }
  SceneRay ray = sceneRay(vec2(texel + uRegion.xy) + 0.5 + uView.tile.xy);
  Pixel p = freshPixel();
  if (lastKey == 0u) {
    lastStep = firstStep(ray);
  } else {
    p = loadPixel(texel);
  }
  bool known = step < uint(vCell.y);
  bool finished = known && advance(texel, ray, lastStep, lastKey, step, key, p);
  if (last && !finished) {
    leaveList(texel, known ? step : lastStep, p);
    finished = true;
  }
  storePixel(texel, p);
#ifdef KERNEL_POWER
  if (loopsAreEnded(uList.z)) atomicAdd(uExhausted, 1u);  // the kernel has loops for each ball of the list
#endif
  if (finished) {
    bool walks = (p.status & kWalks) != 0u;
    if (p.events > 0u) atomicAdd(uSums[sumsOf(texel)].events, p.events);
    if (p.events > 0u && !walks) count(texel, p);
    oLastStep = kFinished;
    return;
  }
  uLists[slot(texel, kPlace)] = p.events;
  stay(texel);
  if (uLayer.y != 0) atomicMin(uCells[vCell.x].least, step);
  oLastStep = step;
  oLastKey = key;
}

#version 450 core
// flags: KERNEL_POWER KERNEL_QUARTIC PAPER
// A ray's way through a fitted tree of metaballs, nearest cells first (Gourmel et al. 2010, §5.2), and the
// search for the surface in the cells: by default the first root, isolated for certain between entries and
// exits of supports; PAPER: the paper's, between the projections of the centres on the ray (§3). What does
// not fit into the shader's arrays, or takes more steps than the driver allows, is left to the processor.
//
// Boxes are met in float32, and are that much larger (core/bvh/field_tree.h); balls are relative to the place
// where the ray enters their cell.
#include "include/view.glsl"
#include "include/ball_ray.glsl"
#include "shared/metaball.glsl"
#include "include/field.glsl"
#include "include/bernstein.glsl"
#include "include/bvh.glsl"
#include "include/loops.glsl"
#define MORE_SUMS uint nodes, leaves, balls;
#include "include/sums.glsl"

layout(binding = 4) uniform sampler2D tDepth;  // what hides

layout(location = 0) out uvec4 oHit;  // leaf; place, hi and lo; flags

layout(std430, binding = 4) restrict buffer Control {
  uint uUnanswered;  // pixels
};

const int kMostDepth = 64;
const int kMostChords = 64;

struct WorldRay {
  vec3 base, inverse;  // in model axes; places on the ray are measured from the base
};

WorldRay worldRay(SceneRay ray) {
  precise vec2 off = (ray.pixel - uView.center.xy) - uView.center.zw;
  precise vec2 aside = off * uView.scale.x + off * uView.scale.y;
  if (isPerspective(uView)) aside = aside * uPlane.y + aside * uPlane.z;
  vec3 d = ray.direction;
  vec3 direction = d.x * uTurn[0].xyz + d.y * uTurn[1].xyz + d.z * uTurn[2].xyz;
  // No division by zero: a ray along an axis stays within what it passes.
  direction = mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
  return WorldRay(uBase.xyz + aside.x * uTurn[0].xyz + aside.y * uTurn[1].xyz, 1.0 / direction);
}

// The part of [from, to] within a box.
vec2 clipTo(WorldRay ray, Node node, float from, float to) {
  vec3 a = (node.low - ray.base) * ray.inverse, b = (node.high - ray.base) * ray.inverse;
  vec3 enter = min(a, b), leave = max(a, b);
  return vec2(max(max(enter.x, enter.y), max(enter.z, from)), min(min(leave.x, leave.y), min(leave.z, to)));
}

Split startOf(SceneRay ray) {
  precise float below = uPlane.x - uView.depth.z;
  return twoProduct(below, ray.stretch);
}

struct Ray {
  SceneRay scene;
  WorldRay world;
  float sign_;  // -1: F < 0 is looked for
};

// Balls of a cell that the ray passes: place nearest to the centre, relative to the cell's; R^2 less the
// squared distance; coefficient; 1 / R^2. Arrays are global: as parameters they would be copied.
vec4 gChords[kMostChords];
vec2 gEnds[kMostChords];    // within the cell
float gCores[kMostChords];  // halves of the chords in the balls' cores
int gChordCount;
bool gOverflow = false;

void findChords(Node leaf, Ray ray, Split base, float length_) {
  gChordCount = 0;
  for (uint k = 0u; k < leaf.count; ++k) {
    Ball ball = fetchBall(memberAt(leaf.first + k));
    BallRay b = ballOnRay(ball.projection, ray.scene);
    if (!(b.halfChord2 > 0.0)) continue;
    float middle = placeBetween(base, b.middle), halfChord = sqrt(b.halfChord2);
    vec2 ends = vec2(max(middle - halfChord, 0.0), min(middle + halfChord, length_));
    if (!(ends.x < ends.y)) continue;
    if (gChordCount == kMostChords) {
      gOverflow = true;
      break;
    }
    gChords[gChordCount] = vec4(middle, b.halfChord2, ball.coefficient, ball.inverseR2);
    gEnds[gChordCount] = ends;
    gCores[gChordCount] = halfCoreChord(ball.projection.eye.w, b.nearest);
    ++gChordCount;
  }
}

float chordShare(vec4 chord, float at) {
  float x = at - chord.x;
  return chord.z * kernelAt(clamp((chord.y - x * x) * chord.w, 0.0, 1.0));
}

// Of the sign that is looked for.
float fieldAt(Ray ray, float at) {
  float sum = -uField.x;
  for (int i = 0; i < gChordCount; ++i) sum += chordShare(gChords[i], at);
  return ray.sign_ * sum;
}

#ifdef PAPER
// From at(low) <= 0 to at(high) > 0: repeated linear interpolation, the weight halved of an end that stays.
float interpolate(Ray ray, float low, float atLow, float high, float atHigh, float width,
                  inout Effort effort) {
  int side = 0;
  for (int i = 0; i < 48; ++i) {
    if (high - low <= width) break;
    ++effort.iterations;
    float place = low + (high - low) * (atLow / (atLow - atHigh));
    place = clamp(place, low + 0.4 * width, high - 0.4 * width);
    if (i % 4 == 3) place = 0.5 * (low + high);
    float value = fieldAt(ray, place);
    if (value > 0.0) {
      high = place;
      atHigh = value;
      if (side > 0) atLow *= 0.5;
      side = 1;
    } else {
      low = place;
      atLow = value;
      if (side < 0) atHigh *= 0.5;
      side = -1;
    }
  }
  effort.unfinished = effort.unfinished || high - low > width;
  return high;
}

float search(Ray ray, float length_, inout Effort effort, inout uint pieces) {
  float before = 0.0, least = kNone;
  for (int i = 0; i < gChordCount; ++i) least = min(least, inversesqrt(gChords[i].w));
  float last = -1.0;
  for (int step_ = 0; step_ < gChordCount; ++step_) {
    float place = kNone;
    for (int i = 0; i < gChordCount; ++i) {
      float at = clamp(gChords[i].x, 0.0, length_);
      if (at > last) place = min(place, at);
    }
    if (place == kNone) break;
    last = place;
    ++pieces;
    float value = fieldAt(ray, place);
    if (value > 0.0) {
      float atBefore = fieldAt(ray, before);
      if (atBefore > 0.0) return before;
      return interpolate(ray, before, atBefore, place, value, uSearch.x * least, effort);
    }
    before = place;
  }
  return kNone;
}
#else
// The first root in a stretch between entries and exits; what is active has its chord around the middle.
float searchStretch(Ray ray, float from, float to, inout Effort effort, inout uint pieces) {
  float middle = 0.5 * (from + to), most = -uField.x, least = -uField.x, size = uField.x;
  float smallest = kNone;
  int active_ = 0, last = 0;
  for (int i = 0; i < gChordCount; ++i) {
    if (!(gEnds[i].x < middle && gEnds[i].y > middle)) continue;
    vec4 c = gChords[i];
    ++active_;
    last = i;
    smallest = min(smallest, 1.0 / c.w);
    float a = from - c.x, b = to - c.x;
    float near = a <= 0.0 && b >= 0.0 ? 0.0 : min(a * a, b * b), far = max(a * a, b * b);
    float high = c.z * kernelAt(clamp((c.y - near) * c.w, 0.0, 1.0));
    float low = c.z * kernelAt(clamp((c.y - far) * c.w, 0.0, 1.0));
    most += max(low, high);
    least += min(low, high);
    size += abs(high);
  }
  if (active_ == 0) return ray.sign_ < 0.0 ? from : kNone;
  if (active_ == 1) return crossCore(coreEnds(gChords[last].x, gCores[last]), from, to, ray.sign_ < 0.0);
  // Less cannot be told from a ray that touches without crossing.
  float margin = 3e-7 * size;
  if (ray.sign_ > 0.0 ? most <= margin : least >= -margin) return kNone;
  ++pieces;
  Polygon sum = constantPolygon(-uField.x);
  for (int i = 0; i < gChordCount; ++i) {
    if (!(gEnds[i].x < middle && gEnds[i].y > middle)) continue;
    vec4 c = gChords[i];
    addShare(sum, windowOn(c.x, c.y, c.w, from, to), c.z);
  }
  if (ray.sign_ < 0.0) {
    for (int k = 0; k <= fieldDegree(); ++k) sum.c[k] = -sum.c[k];
  }
  float root = firstRoot(sum, max(uSearch.x * sqrt(smallest) / (to - from), 5e-7), effort);
  return root <= 1.0 ? from + root * (to - from) : kNone;
}

float search(Ray ray, float length_, inout Effort effort, inout uint pieces) {
  float now = 0.0;
  for (int step_ = 0; step_ <= 2 * kMostChords; ++step_) {
    float next = length_;
    for (int i = 0; i < gChordCount; ++i) {
      vec2 ends = gEnds[i];
      if (ends.x > now) next = min(next, ends.x);
      if (ends.y > now) next = min(next, ends.y);
    }
    if (!(next > now)) break;
    float root = searchStretch(ray, now, next, effort, pieces);
    if (root < kNone) return root;
    now = next;
  }
  return kNone;
}
#endif

// Nodes to be gone to, and where the ray enters them: no tree is deeper (core/bvh/box_tree.h).
uint gNodes[kMostDepth + 2];
float gFrom[kMostDepth + 2];
int gTop = 0;

void push(uint node, float from) {
  gNodes[gTop] = node;
  gFrom[gTop] = from;
  ++gTop;
}

// Whether F > 0 where the ray begins: a cell that holds the place knows.
bool beginsInside(Ray ray, Split start) {
  push(0u, 0.0);
  while (gTop > 0) {
    --gTop;
    Node node = fetchNode(gNodes[gTop]);
    vec2 part = clipTo(ray.world, node, start.hi, start.hi);
    if (!(part.x <= part.y)) continue;
    if (node.count == kInner) {
      push(node.first, 0.0);
      push(node.first + 1u, 0.0);
      continue;
    }
    float sum = -uField.x;
    for (uint k = 0u; k < node.count; ++k) {
      Ball ball = fetchBall(memberAt(node.first + k));
      BallRay b = ballOnRay(ball.projection, ray.scene);
      float x = placeBetween(b.middle, start);
      sum += ball.coefficient * kernelAt(clamp((b.halfChord2 - x * x) * ball.inverseR2, 0.0, 1.0));
    }
    if (sum > 0.0) {
      gTop = 0;
      return true;
    }
  }
  return false;
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy), targetTexel = texel + uRegion.xy;
  oHit = uvec4(0u);
  Ray ray;
  ray.scene = sceneRay(vec2(targetTexel) + 0.5 + uView.tile.xy);
  ray.world = worldRay(ray.scene);
  ray.sign_ = 1.0;
  Split start = startOf(ray.scene);
  float limit = kNone;
  float depth = texelFetch(tDepth, targetTexel, 0).x;
  if (depth > 0.0) {
    float place = placeOfDepth(ray.scene, depth);
    limit = place + slackOfDepth(place);
  }
  if (uRegion.z != 0 && beginsInside(ray, start)) ray.sign_ = -1.0;

  vec2 all = clipTo(ray.world, fetchNode(0u), start.hi, limit);
  if (!(all.x <= all.y)) return;
  push(0u, all.x);
  Effort effort = Effort(0, false, false);
  uint pieces = 0u, nodes = 0u, leaves = 0u, balls = 0u;
  while (gTop > 0 && !gOverflow) {
    --gTop;
    if (gFrom[gTop] > limit) continue;
    uint index = gNodes[gTop];
    Node node = fetchNode(index);
    ++nodes;
    if (node.count == kInner) {
      uint near = node.first, far = node.first + 1u;
      vec2 nearPart = clipTo(ray.world, fetchNode(near), start.hi, limit);
      vec2 farPart = clipTo(ray.world, fetchNode(far), start.hi, limit);
      if (farPart.x < nearPart.x) {
        vec2 part = nearPart;
        nearPart = farPart;
        farPart = part;
        near = node.first + 1u;
        far = node.first;
      }
      if (farPart.x <= farPart.y) push(far, farPart.x);
      if (nearPart.x <= nearPart.y) push(near, nearPart.x);
      continue;
    }
    vec2 part = clipTo(ray.world, node, start.hi, limit);
    if (!(part.x <= part.y)) continue;
    ++leaves;
    balls += node.count;
    Split base = part.x == start.hi ? start : makeSplit(part.x, 0.0);
    findChords(node, ray, base, part.y - part.x);
    if (gOverflow) break;
    float at = search(ray, part.y - part.x, effort, pieces);
    if (!(at < kNone)) continue;
    Split place = addSplit(base, makeSplit(at, 0.0));
    if (place.hi > limit) continue;
    limit = place.hi;
    oHit = uvec4(index, floatBitsToUint(place.hi), floatBitsToUint(place.lo),
                 kHit | (ray.sign_ < 0.0 ? kInsideOut : 0u));
  }
  if (gOverflow || loopsAreEnded(uRegion.w)) {
    oHit = uvec4(0u, 0u, 0u, kUnanswered);
    atomicAdd(uUnanswered, 1u);
    return;
  }
  if (leaves == 0u) return;
  int sums = sumsOf(texel);
  atomicAdd(uSums[sums].pixels, 1u);
  atomicAdd(uSums[sums].pieces, pieces);
  atomicAdd(uSums[sums].iterations, uint(effort.iterations));
  atomicMax(uSums[sums].mostIterations, uint(effort.iterations));
  atomicAdd(uSums[sums].nodes, nodes);
  atomicAdd(uSums[sums].leaves, leaves);
  atomicAdd(uSums[sums].balls, balls);
  if (effort.grazing) atomicAdd(uSums[sums].grazing, 1u);
  if (effort.unfinished) atomicAdd(uSums[sums].unfinished, 1u);
  if (oHit.w != 0u) atomicAdd(uSums[sums].hits, 1u);
}

// The balls of a fragment's ray. Lengths are relative to the hull's ball: its centre, and the place on the
// ray nearest to it. Needs include/ball_ray.glsl.

layout(binding = 0) uniform usampler2D tBalls;  // two texels each, by rank: centre, 1 / R^2; q, colour, id, 0
layout(binding = 1) uniform usampler2D tOthers;  // the lists of ranks
const uint kOthersPerRow = 4096u;

struct Other {
  vec3 base;  // from its centre to the ray's point nearest to the hull's ball
  float inverseR2;
  float coefficient;
  uint color;
  uint id;
};

// The fragment's ray, in model axes.
struct Line {
  vec3 center;                 // of the hull's ball
  vec3 nearest;                // relative to it
  vec3 direction;              // unit
  uint rank, first, from, to;  // of the list, those that may be active
  float sign;                  // 1: F > 0 is looked for; -1: F < 0
};

uint otherRank(uint at) {
  return texelFetch(tOthers, ivec2(at % kOthersPerRow, at / kOthersPerRow), 0).x;
}

vec3 centerOf(uint rank) {
  return uintBitsToFloat(texelFetch(tBalls, ballTexel(rank, 2u), 0).xyz);
}

Other fetchOther(Line line, uint rank) {
  ivec2 at = ballTexel(rank, 2u);
  uvec4 a = texelFetch(tBalls, at, 0), b = texelFetch(tBalls, at + ivec2(1, 0), 0);
  Other o;
  precise vec3 offset = uintBitsToFloat(a.xyz) - line.center;
  o.base = line.nearest - offset;
  o.inverseR2 = uintBitsToFloat(a.w);
  o.coefficient = line.sign * uintBitsToFloat(b.x);
  o.color = b.y;
  o.id = b.z;
  return o;
}

// Those of a line's balls that its ray meets, as far as there is room; else all are gone through.
const int kMostMet = 48;
struct Met {
  uint ranks[kMostMet];
  int count;  // -1: too many
};

int activeCount(Line line, Met met) {
  return met.count >= 0 ? met.count : int(line.to - line.from) + 1;
}

Other activeBall(Line line, Met met, int i) {
  uint rank = line.rank;
  if (met.count >= 0) {
    rank = met.ranks[i];
  } else if (i > 0) {
    rank = otherRank(line.first + line.from + uint(i - 1));
  }
  return fetchOther(line, rank);
}

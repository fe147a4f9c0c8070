#version 450 core
// flags: CREASES IDS GROUPS
// Which of a pixel's four borders carry a line. Sigg et al. 2006, §4 take the length of a Sobel gradient of
// depth and normals; here both are compared across each border, so that an edge has no width of its own and
// lies on one side.
#include "include/view.glsl"
#include "shared/octahedral.glsl"
#include "include/outline.glsl"

#ifdef IDS
layout(binding = 2) uniform usampler2D tId;
#endif
#ifdef GROUPS
layout(std430, binding = 0) readonly buffer Groups {
  uint uGroups[];  // by id
};
#endif

layout(location = 0) out float oBorders;  // two bits for each of right, left, up, down, / 65535

const uint kNoLine = 0u, kHalfLine = 1u, kWholeLine = 2u;  // half: the other half lies across the border

#ifdef IDS
uint groupAt(ivec2 at) {
  uint id = texelFetch(tId, at, 0).r;
#ifdef GROUPS
  if (id < uint(uGroups.length())) id = uGroups[id];
#endif
  return id;
}
#endif

#ifdef CREASES
// Cosine of how much the normal turns from s to its neighbour if the surface goes on there; otherwise 1.
float cosineTo(Surface s, ivec2 there) {
  if (!isInside(there)) return 1.0;
  float depth = texelFetch(tDepth, there, 0).r;
  if (depth <= 0.0) return 1.0;
  Surface other = surfaceAt(there, depth);
  return isApart(s, other, 1.0) ? 1.0 : min(dot(s.normal, other.normal), 1.0);
}

// A ridge turns the normal by more than the curvature does on the side that faces the viewer more: small
// spheres, which turn most at their limb, have none.
bool isCrease(Surface here, ivec2 at, Surface other, ivec2 towards) {
  float cosine = dot(here.normal, other.normal), least = uCrease.y;
  if (cosine >= least) return false;
  if (dot(other.normal - here.normal, other.point - here.point) < 0.0) return true;  // a groove
  float curvature =
      here.normal.z > other.normal.z ? cosineTo(here, at - towards) : cosineTo(other, at + 2 * towards);
  // The angles' sum is less than a half turn, and the normals turn by more than that.
  float across = sqrt(max(1.0 - curvature * curvature, 0.0));
  return curvature > -least && cosine < least * curvature - uCrease.x * across;
}
#endif

uint lineTowards(Surface here, uint group, ivec2 at, ivec2 towards) {
  ivec2 there = at + towards;
  if (!isInside(there)) return kNoLine;
  float depth = texelFetch(tDepth, there, 0).r;
  bool steps = uStep.w > 0.5;
#ifdef IDS
  bool differ = group != groupAt(there);
#else
  bool differ = false;
#endif
  if (depth <= 0.0) return steps || differ ? kWholeLine : kNoLine;
  Surface other = surfaceAt(there, depth);
  if (isApart(here, other, 1.0)) {
    bool inFront = here.point.z >= other.point.z;
    return (steps || differ) && inFront ? kWholeLine : kNoLine;
  }
#ifdef CREASES
  differ = differ || isCrease(here, at, other, towards);
#endif
  return differ ? kHalfLine : kNoLine;
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  float depth = texelFetch(tDepth, at, 0).r;
  Surface here = surfaceAt(at, depth);
  uint group = 0u;
#ifdef IDS
  group = groupAt(at);
#endif
  uint borders = lineTowards(here, group, at, ivec2(1, 0)) | lineTowards(here, group, at, ivec2(-1, 0)) << 2 |
                 lineTowards(here, group, at, ivec2(0, 1)) << 4 |
                 lineTowards(here, group, at, ivec2(0, -1)) << 6;
  oBorders = float(borders) / 65535.0;
}

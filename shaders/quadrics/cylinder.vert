#version 450 core
// flags: DISTANCE
// One instance per capped cylinder: a rectangle along its projected axis that tightly bounds both end discs,
// whose convex hull the cylinder is (Sigg et al. 2006, §3.2: a box per cap; turned along the axis here, which
// covers about half as many pixels).
#include "include/view.glsl"
#include "include/quadric_vertex.glsl"

layout(location = 0) in vec4 aEndRadius;   // end a, relative to the primitives' origin; radius
layout(location = 1) in vec3 aOtherEnd;    // end b
layout(location = 2) in uvec4 aColorsIds;  // colour a, b; id a, b

layout(location = 0) flat out vec4 vPixel;  // projected centre: hi xy, lo xy
layout(location = 1) flat out vec4 vView;   // view-space centre, radius
layout(location = 2) flat out vec4 vAxis;   // unit axis from a to b, half length
layout(location = 3) flat out vec2 vDepth;  // depth; 1 if the ray is taken from the eye
layout(location = 4) flat out uvec4 vColorsIds;
#ifdef DISTANCE
layout(location = 5) flat out vec2 vRange;
#endif

// Bounds of both end discs along the screen direction (c, s), as slopes from the projected centre; false:
// unbounded.
bool discBounds(ProjectedCenter center, vec3 axis, float halfLength, float radius, vec2 direction,
                out vec2 bounds) {
  float axisAlong = dot(axis.xy, direction);
  float slope = dot(center.view.xy, direction) / center.depth;
  bool bounded = true;
  bounds = vec2(LARGEST, -LARGEST);
  for (int end = -1; end <= 1; end += 2) {
    float h = float(end) * halfLength;
    bool perspective = isPerspective(uView);
    float depth = perspective ? center.depth - h * axis.z : 1.0;
    // slope of the disc's centre minus slope of the cylinder's, without cancellation
    float shift = perspective ? h * (axisAlong + slope * axis.z) / depth : h * axisAlong;
    Extent e = projectedExtent(uView, slope + shift, depth, radius, axisAlong, axis.z);
    bounded = bounded && e.bounded;
    bounds = vec2(min(bounds.x, shift + e.low), max(bounds.y, shift + e.high));
  }
  return bounded;
}

void main() {
  float radius = aEndRadius.w;
  Split x = twoSum(aEndRadius.x, aOtherEnd.x);
  Split y = twoSum(aEndRadius.y, aOtherEnd.y);
  Split z = twoSum(aEndRadius.z, aOtherEnd.z);
  vec3 cHi = 0.5 * vec3(x.hi, y.hi, z.hi);
  vec3 cLo = 0.5 * vec3(x.lo, y.lo, z.lo);
  ProjectedCenter center = projectCenter(uView, cHi, cLo);
  vec3 along = aOtherEnd - aEndRadius.xyz;
  float halfLength = 0.5 * length(along);
  vec3 axis = turn(uView, along);
  axis = halfLength > 0.0 ? normalize(axis) : vec3(0.0, 0.0, 1.0);

  vPixel = vec4(center.pixelX.hi, center.pixelY.hi, center.pixelX.lo, center.pixelY.lo);
  vView = vec4(center.view, radius);
  vAxis = vec4(axis, halfLength);
  vDepth = vec2(center.depth, nearEye(uView, center.depth, radius + halfLength) ? 1.0 : 0.0);
  vColorsIds = aColorsIds;
#ifdef DISTANCE
  Split range = centerRange(uView, cHi, cLo);
  vRange = vec2(range.hi, range.lo);
#endif

  float reach = halfLength * abs(axis.z) + radius;
  if (!(radius > 0.0 && halfLength > 0.0) || center.view.z - reach > uView.depth.z) {
    gl_Position = kNowhere;
    return;
  }
  vec2 lean = axis.xy + (isPerspective(uView) ? axis.z * center.view.xy / center.depth : vec2(0.0));
  vec2 direction = dot(lean, lean) > 1e-12 ? normalize(lean) : vec2(1.0, 0.0);
  vec2 across = vec2(-direction.y, direction.x);
  vec2 boundsAlong, boundsAcross;
  if (!discBounds(center, axis, halfLength, radius, direction, boundsAlong) ||
      !discBounds(center, axis, halfLength, radius, across, boundsAcross)) {
    gl_Position = wholeTarget(gl_VertexID);
    return;
  }
  // A turned rectangle cannot be cut to the target corner by corner; one far larger than it is given up
  // instead.
  vec2 span = vec2(boundsAlong.y - boundsAlong.x, boundsAcross.y - boundsAcross.x) / uView.scale.x;
  if (max(span.x, span.y) > 8.0 * max(uView.tile.z, uView.tile.w)) {
    gl_Position = wholeTarget(gl_VertexID);
    return;
  }
  vec2 corner = cornerOf(gl_VertexID);
  vec2 turned =
      mix(vec2(boundsAlong.x, boundsAcross.x), vec2(boundsAlong.y, boundsAcross.y), corner) / uView.scale.x +
      (corner * 2.0 - 1.0) * kPadding;
  vec2 pixel = targetPixel(center, turned.x * direction + turned.y * across);
  gl_Position = quadPosition(pixel, center.view.z + reach);
}

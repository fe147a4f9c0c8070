#version 450 core
// flags: DISTANCE
// One instance per ellipsoid: its tight bounding rectangle on the screen (Sigg et al. 2006, §3.2).
#include "include/view.glsl"
#include "include/quadric_vertex.glsl"

layout(location = 0) in vec4 aCenterShortest;  // relative to the primitives' origin; third semi-axis' length
layout(location = 1) in vec3 aAxisA;           // longest semi-axis
layout(location = 2) in vec3 aAxisB;
layout(location = 3) in uvec2 aColorId;

layout(location = 0) flat out vec4 vPixel;  // projected centre: hi xy, lo xy
layout(location = 1) flat out vec4 vView;   // view-space centre, shortest semi-axis
layout(location = 2) flat out vec4 vAxisA;  // unit axis, its half length
layout(location = 3) flat out vec4 vAxisB;
layout(location = 4) flat out vec2 vDepth;  // depth; 1 if the ray is taken from the eye
layout(location = 5) flat out uvec2 vColorId;
#ifdef DISTANCE
layout(location = 6) flat out vec2 vRange;
#endif

void main() {
  vec3 radii = vec3(length(aAxisA), length(aAxisB), aCenterShortest.w);
  float longest = radii.x;
  if (!(min(radii.y, radii.z) > 0.0)) longest = 0.0;
  ProjectedCenter center = projectCenter(uView, aCenterShortest.xyz, vec3(0.0));
  vec3 u = longest > 0.0 ? normalize(turn(uView, aAxisA)) : vec3(1.0, 0.0, 0.0);
  vec3 v = longest > 0.0 ? normalize(turn(uView, aAxisB)) : vec3(0.0, 1.0, 0.0);
  vec3 w = cross(u, v);
  vPixel = vec4(center.pixelX.hi, center.pixelY.hi, center.pixelX.lo, center.pixelY.lo);
  vView = vec4(center.view, radii.z);
  vAxisA = vec4(u, radii.x);
  vAxisB = vec4(v, radii.y);
  vDepth = vec2(center.depth, nearEye(uView, center.depth, longest) ? 1.0 : 0.0);
  vColorId = aColorId;
#ifdef DISTANCE
  Split range = centerRange(uView, aCenterShortest.xyz, vec3(0.0));
  vRange = vec2(range.hi, range.lo);
#endif

  vec3 shares = longest > 0.0 ? radii / longest : vec3(0.0);
  vec3 axesZ = shares * vec3(u.z, v.z, w.z);
  float reach = longest * length(axesZ);
  if (!(longest > 0.0) || center.view.z - reach > uView.depth.z) {
    gl_Position = kNowhere;
    return;
  }
  vec2 slope = center.view.xy / center.depth;
  Extent x = ellipsoidExtent(uView, slope.x, center.depth, longest, shares * vec3(u.x, v.x, w.x), axesZ);
  Extent y = ellipsoidExtent(uView, slope.y, center.depth, longest, shares * vec3(u.y, v.y, w.y), axesZ);
  if (!x.bounded || !y.bounded) {
    gl_Position = wholeTarget(gl_VertexID);
    return;
  }
  vec2 corner = cornerOf(gl_VertexID);
  vec2 offset =
      mix(vec2(x.low, y.low), vec2(x.high, y.high), corner) / uView.scale.x + (corner * 2.0 - 1.0) * kPadding;
  // What lies beyond the target is cut off here, so that no driver has to clip a quad of a million pixels.
  vec2 pixel = clamp(targetPixel(center, offset), vec2(-1.0), uView.tile.zw + 1.0);
  gl_Position = quadPosition(pixel, center.view.z + reach);
}

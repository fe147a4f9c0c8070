#version 450 core
// flags: DISTANCE
// One instance per sphere: its tight bounding rectangle on the screen (Sigg et al. 2006, §3.2).
#include "include/view.glsl"
#include "include/quadric_vertex.glsl"

layout(location = 0) in vec4 aCenterRadius;  // relative to the primitives' origin
layout(location = 1) in uvec2 aColorId;

layout(location = 0) flat out vec4 vPixel;  // projected centre: hi xy, lo xy
layout(location = 1) flat out vec4 vView;   // view-space centre, radius
layout(location = 2) flat out vec2 vDepth;  // depth; 1 if the ray is taken from the eye
layout(location = 3) flat out uvec2 vColorId;
#ifdef DISTANCE
layout(location = 4) flat out vec2 vRange;
#endif

void main() {
  float radius = aCenterRadius.w;
  ProjectedCenter center = projectCenter(uView, aCenterRadius.xyz, vec3(0.0));
  vPixel = vec4(center.pixelX.hi, center.pixelY.hi, center.pixelX.lo, center.pixelY.lo);
  vView = vec4(center.view, radius);
  vDepth = vec2(center.depth, nearEye(uView, center.depth, radius) ? 1.0 : 0.0);
  vColorId = aColorId;
#ifdef DISTANCE
  Split range = centerRange(uView, aCenterRadius.xyz, vec3(0.0));
  vRange = vec2(range.hi, range.lo);
#endif

  if (!(radius > 0.0) || center.view.z - radius > uView.depth.z) {
    gl_Position = kNowhere;
    return;
  }
  float slopeX = center.view.x / center.depth;
  float slopeY = center.view.y / center.depth;
  Extent x = projectedExtent(uView, slopeX, center.depth, radius, 0.0, 0.0);
  Extent y = projectedExtent(uView, slopeY, center.depth, radius, 0.0, 0.0);
  if (!x.bounded || !y.bounded) {
    gl_Position = wholeTarget(gl_VertexID);
    return;
  }
  vec2 corner = cornerOf(gl_VertexID);
  vec2 offset =
      mix(vec2(x.low, y.low), vec2(x.high, y.high), corner) / uView.scale.x + (corner * 2.0 - 1.0) * kPadding;
  // What lies beyond the target is cut off here, so that no driver has to clip a quad of a million pixels.
  vec2 pixel = clamp(targetPixel(center, offset), vec2(-1.0), uView.tile.zw + 1.0);
  gl_Position = quadPosition(pixel, center.view.z + radius);
}

#version 450 core
// One instance for each ball that may be seen: the rectangle around its support.
#include "include/view.glsl"
#include "include/ball_ray.glsl"
#include "include/newton.glsl"

layout(location = 0) in vec4 aBox;  // corners [pixels of the target]
layout(location = 1) in vec4 aPixel;
layout(location = 2) in vec4 aPlace;
layout(location = 3) in vec4 aEye;
layout(location = 4) in vec4 aCenter;  // in model axes; w: view-space z of its nearest point
layout(location = 5) in vec2 aHull;    // squared radius; coefficient
layout(location = 6) in uvec4 aLists;  // rank; start of its list of others; how many of it are smaller; all

layout(location = 0) flat out vec4 vPixel;
layout(location = 1) flat out vec4 vPlace;
layout(location = 2) flat out vec4 vEye;
layout(location = 3) flat out vec4 vCenter;
layout(location = 4) flat out vec2 vHull;
layout(location = 5) flat out uvec4 vLists;

void main() {
  vPixel = aPixel;
  vPlace = aPlace;
  vEye = aEye;
  vCenter = aCenter;
  vHull = aHull;
  vLists = aLists;
  vec2 corner = vec2((gl_VertexID & 1) == 0 ? aBox.x : aBox.z, (gl_VertexID >> 1) == 0 ? aBox.y : aBox.w);
  // In front of all that its fragments may write (include/gbuffer.glsl).
  float depth = depthValue(uView, min(aCenter.w, uView.depth.z)) * (1.0 + 1e-5) + 1e-30;
  gl_Position = vec4((corner - uArea.xy) / uArea.zw * 2.0 - 1.0, min(depth, 1.0), 1.0);
}

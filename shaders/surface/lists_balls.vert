#version 450 core
// flags: CORES INSIDE
// One instance for each ball: the rectangle around it, or around its core, at a depth that nothing drawn in
// it falls short of.
#include "include/view.glsl"
#include "include/ball_ray.glsl"
#include "include/lists.glsl"

layout(location = 0) flat out vec4 vPixel;
layout(location = 1) flat out vec4 vPlace;
layout(location = 2) flat out vec4 vEye;
layout(location = 3) flat out uint vBall;
layout(location = 4) flat out vec2 vShare;  // coefficient, 1/R^2

layout(binding = 5) uniform sampler2D tBalls;
layout(location = 0) uniform ivec2 uFirst;  // the first, and the step to the next

void main() {
  uint ball = uint(uFirst.x + uFirst.y * gl_InstanceID);
  BallProjection projection = fetchProjection(tBalls, ball);
  vPixel = projection.pixel;
  vPlace = projection.place;
  vEye = projection.eye;
  vShare = texelFetch(tBalls, ballTexel(ball, 4u) + ivec2(3, 0), 0).xy;
  vBall = ball;
#ifdef CORES
  vec4 box = orderOf(ball, 1);
#else
  vec4 box = orderOf(ball, 0);
#endif
#ifdef INSIDE
  float depth = 1.0;
#else
  float depth = orderOf(ball, 2).y;
#endif
  vec2 corner = vec2((gl_VertexID & 1) == 0 ? box.x : box.z, (gl_VertexID >> 1) == 0 ? box.y : box.w);
  gl_Position = vec4((corner - vec2(uRegion.xy)) / vec2(uRegion.zw) * 2.0 - 1.0, depth, 1.0);
}

// A field's balls, the sum of their shares on an interval of a ray, and what its surface is like at a point.
// Needs include/ball_ray.glsl, shared/metaball.glsl. Flags: KERNEL_QUARTIC, KERNEL_POWER (neither: sextic)
// choose the kernel of the pieces; what the surface is like is right for any. CUBIC: polynomials of degree
// three, whose shares the method itself adds.

struct Ball {
  BallProjection projection;
  float coefficient;
  float inverseR2;
  uint color;  // 0xRRGGBB, sRGB
  uint id;
};

layout(std430, binding = 0) readonly restrict buffer Balls {
  Ball uBalls[];
};

// The same without colours and ids: software drivers read vectors from textures several times as fast as
// numbers from buffers.
layout(binding = 5) uniform sampler2D tBalls;

// Its coefficient and inverseR2.
vec2 fetchShare(uint index) {
  return texelFetch(tBalls, ballTexel(index, 4u) + ivec2(3, 0), 0).xy;
}

Ball fetchBall(uint index) {
  Ball ball;
  ball.projection = fetchProjection(tBalls, index);
  vec2 rest = fetchShare(index);
  ball.coefficient = rest.x;
  ball.inverseR2 = rest.y;
  ball.color = 0u;
  ball.id = 0u;
  return ball;
}

#if defined(CUBIC)
const int kMostDegree = 3;
#elif defined(KERNEL_POWER)
const int kMostDegree = 2 * kMostExponent;
#elif defined(KERNEL_QUARTIC)
const int kMostDegree = 4;
#else
const int kMostDegree = 6;
#endif

// Of the polynomials along a ray: a constant but for the power kernel.
int fieldDegree() {
#if defined(KERNEL_POWER) && !defined(CUBIC)
  return 2 * int(uField.y);
#else
  return kMostDegree;
#endif
}

// A polynomial on an interval, in Bernstein form.
struct Polygon {
  float c[kMostDegree + 1];
};

Polygon constantPolygon(float value) {
  Polygon p;
  for (int k = 0; k <= kMostDegree; ++k) p.c[k] = value;
  return p;
}

#ifndef CUBIC
void addShare(inout Polygon sum, Window w, float coefficient) {
#if defined(KERNEL_POWER)
  PowerPiece piece = powerPiece(w, int(uField.y));
#elif defined(KERNEL_QUARTIC)
  QuarticPiece piece = quarticPiece(w);
#else
  SexticPiece piece = sexticPiece(w);
#endif
  for (int k = 0; k <= fieldDegree(); ++k) sum.c[k] += coefficient * piece.c[k];
}
#endif

#include "include/core.glsl"
#include "include/surface_point.glsl"

// b: the ball on the ray; along: from where the ray is nearest to its centre to the point.
void addToSurface(inout FieldSurface s, Ball ball, SceneRay ray, BallRay b, float along) {
  float w = clamp((b.halfChord2 - along * along) * ball.inverseR2, 0.0, 1.0);
  s.outward += ball.coefficient * kernelSlopeAt(w) * ball.inverseR2 * (b.nearest + along * ray.direction);
  addShareToSurface(s, ball.coefficient * kernelAt(w), ball.color, ball.id);
}

// place: of the point on the ray.
void addToSurface(inout FieldSurface s, Ball ball, SceneRay ray, Split place) {
  BallRay b = ballOnRay(ball.projection, ray);
  addToSurface(s, ball, ray, b, placeBetween(b.middle, place));
}

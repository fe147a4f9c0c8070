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

Ball fetchBall(uint index) {
  Ball ball;
  ball.projection = fetchProjection(tBalls, index);
  vec2 rest = texelFetch(tBalls, ballTexel(index, 4u) + ivec2(3, 0), 0).xy;
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

// Of a ball alone the surface is its core, a sphere, met exactly however close the level is to the maximum.
const float kNone = 1e30;  // no place on a ray

// Half of the ray's chord in it; -kNone: the ray passes by.
float halfCoreChord(Ball ball, BallRay b) {
  float square = ball.projection.eye.w - dot(b.nearest, b.nearest);
  return square > 0.0 ? sqrt(square) : -kNone;
}

// Where the ray enters and leaves it; middle: where it is nearest to the centre.
vec2 coreEnds(float middle, float halfChord) {
  return vec2(middle - halfChord, middle + halfChord);
}

bool isInCore(vec2 ends, float at) {
  return ends.x < at && ends.y > at;
}

// The first crossing in [from, to], or kNone. inside: of the field where the search begins; a sign that has
// changed by `from` is a crossing there: rounding opens no cracks.
float crossCore(vec2 ends, float from, float to, bool inside) {
  if (!inside) return ends.x < to && ends.y > from ? max(ends.x, from) : kNone;
  if (!isInCore(ends, from)) return from;
  return ends.y < to ? ends.y : kNone;
}

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

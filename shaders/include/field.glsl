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
const uint kBallsPerRow = 1024u;

Ball fetchBall(uint index) {
  ivec2 at = ivec2(4u * (index % kBallsPerRow), index / kBallsPerRow);
  Ball ball;
  ball.projection.pixel = texelFetch(tBalls, at, 0);
  ball.projection.place = texelFetch(tBalls, at + ivec2(1, 0), 0);
  ball.projection.eye = texelFetch(tBalls, at + ivec2(2, 0), 0);
  vec2 rest = texelFetch(tBalls, at + ivec2(3, 0), 0).xy;
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

float kernelAt(float w) {
  if (uField.z > 1.5) return powerKernel(w, int(uField.y));
  return uField.z > 0.5 ? quarticKernel(w) : sexticKernel(w);
}

float kernelSlopeAt(float w) {
  if (uField.z > 1.5) return powerSlope(w, int(uField.y));
  return uField.z > 0.5 ? quarticSlope(w) : sexticSlope(w);
}

// What the balls around a point of the surface give it, one after the other.
struct FieldSurface {
  vec3 outward;  // -grad F
  vec3 squares;  // of their colours, weighted by what they add to the field
  float weight;
  float most;  // the largest of the weights
  uint color, id;
};

FieldSurface emptyFieldSurface() {
  FieldSurface s;
  s.outward = vec3(0.0);
  s.squares = vec3(0.0);
  s.weight = 0.0;
  s.most = 0.0;
  s.color = 0u;
  s.id = 0u;
  return s;
}

vec3 bytesOf(uint color) {
  return vec3(uvec3(color >> 16, color >> 8, color) & 255u);
}

// b: the ball on the ray; along: from where the ray is nearest to its centre to the point.
void addToSurface(inout FieldSurface s, Ball ball, SceneRay ray, BallRay b, float along) {
  float w = clamp((b.halfChord2 - along * along) * ball.inverseR2, 0.0, 1.0);
  s.outward += ball.coefficient * kernelSlopeAt(w) * ball.inverseR2 * (b.nearest + along * ray.direction);
  float share = ball.coefficient * kernelAt(w);
  if (share > s.most || s.id == 0u || (share == s.most && ball.id < s.id)) {
    s.color = ball.color;
    s.id = ball.id;
  }
  share = max(share, 0.0);
  s.most = max(s.most, share);
  s.weight += share;
  vec3 bytes = bytesOf(ball.color);
  s.squares += share * bytes * bytes;
}

// place: of the point on the ray.
void addToSurface(inout FieldSurface s, Ball ball, SceneRay ray, Split place) {
  BallRay b = ballOnRay(ball.projection, ray);
  addToSurface(s, ball, ray, b, placeBetween(b.middle, place));
}

// Stored colours are blended by their squares: nearly linear light.
uint blendedColor(FieldSurface s) {
  if (!(s.weight > 0.0)) return s.color;
  uvec3 bytes = uvec3(min(sqrt(s.squares / s.weight), vec3(255.0)) + 0.5);
  return bytes.x << 16 | bytes.y << 8 | bytes.z;
}

// Unit, towards the viewer, whichever side of the surface the ray meets.
vec3 normalTowards(FieldSurface s, SceneRay ray, bool inner) {
  float largest = max(max(abs(s.outward.x), abs(s.outward.y)), abs(s.outward.z));
  if (!(largest > 0.0)) return -ray.direction;
  vec3 n = normalize(s.outward / largest) * (inner ? -1.0 : 1.0);
  float away = dot(n, ray.direction);
  return away > 0.0 ? normalize(n - away * ray.direction) : n;  // rounding, where the ray grazes
}

// From the eye (orthographic: from the near plane) to a place on the ray, rounded once.
float distanceAlong(SceneRay ray, Split place) {
  if (!isPerspective(uView)) {
    Split toPlane = addSplit(makeSplit(uView.depth.z, uView.depthMap.y), makeSplit(-uPlane.x, 0.0));
    Split total = addSplit(toPlane, place);
    return total.hi + total.lo;
  }
  Split perPixel = makeSplit(uView.scale.x, uView.scale.y);
  Split x = twoSum(ray.pixel.x - uView.center.x, -uView.center.z);
  Split y = twoSum(ray.pixel.y - uView.center.y, -uView.center.w);
  x = multiplySplit(x, perPixel);
  y = multiplySplit(y, perPixel);
  Split square = addSplit(addSplit(multiplySplit(x, x), multiplySplit(y, y)), makeSplit(1.0, 0.0));
  Split total = addSplit(multiplySplit(makeSplit(uPlane.y, uPlane.z), sqrtSplit(square)), place);
  return total.hi + total.lo;
}

// View-space z of a place on the ray.
float heightOf(SceneRay ray, Split place) {
  return uPlane.x - (place.hi + place.lo) / ray.stretch;
}

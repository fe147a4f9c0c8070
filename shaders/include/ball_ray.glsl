// Where a ray passes a ball of a field. Needs include/view.glsl.
//
// A place on the ray is measured from the plane z = uPlane.x of view space, which lies where the field is: an
// eye thousands of ångström away costs no digits. A ball's own numbers are relative to its centre, and its
// place on the ray is a pair of floats: balls of a millionth of the scene's size keep their digits, too.

#include "include/ball_texture.glsl"

layout(std140, binding = 1) uniform FieldUniforms {
  vec4 uPlane;  // x: z of the plane that places are measured from; y + z: height of the eye above it; w: 0
  vec4 uField;  // x: level; y: exponent of the power kernel; z: 0 sextic, 1 quartic, 2 power; w: 0
};

// What a ball's projection comes to (render/surface/projected_field.h).
struct BallProjection {
  vec4 pixel;  // its centre: hi xy, lo xy
  vec4 place;  // x: size of a pixel there, 0 if the ray is taken from the eye; y: R^2; z + w: how far its
               // centre (or the eye) lies below the plane
  vec4 eye;  // xyz: from the centre to the eye, if the ray is taken from there; w: squared radius of the core
};

// From a texture with ProjectedBall of render/surface/projected_field.h: four texels.
BallProjection fetchProjection(sampler2D balls, uint ball) {
  ivec2 at = ballTexel(ball, 4u);
  BallProjection p;
  p.pixel = texelFetch(balls, at, 0);
  p.place = texelFetch(balls, at + ivec2(1, 0), 0);
  p.eye = texelFetch(balls, at + ivec2(2, 0), 0);
  return p;
}

struct SceneRay {
  vec2 pixel;
  vec3 direction;  // unit
  float stretch;   // length of the ray per height
};

struct BallRay {
  vec3 nearest;      // the ray's nearest point to the centre, relative to it
  Split middle;      // its place on the ray
  float halfChord2;  // R^2 less its squared distance; the ball is met if that is positive
};

SceneRay sceneRay(vec2 pixel) {
  SceneRay ray;
  ray.pixel = pixel;
  ray.direction = rayDirection(uView, pixel);
  precise vec2 slope = (pixel - uView.center.xy) * uView.scale.x;
  precise float square = 1.0 + dot(slope, slope);
  ray.stretch = isPerspective(uView) ? sqrt(square) : 1.0;
  return ray;
}

BallRay ballOnRay(BallProjection ball, SceneRay ray) {
  precise vec2 off = (ray.pixel - ball.pixel.xy) - ball.pixel.zw;
  precise vec3 point = ball.eye.xyz + ball.place.x * vec3(off, 0.0);
  precise float toward = -dot(point, ray.direction);
  precise vec3 nearly = point + toward * ray.direction;
  precise float rest = -dot(nearly, ray.direction);  // once more: point may be several radii away
  precise vec3 nearest = nearly + rest * ray.direction;
  Split plane = twoProduct(ball.place.z, ray.stretch);
  precise float further = toward + rest;
  precise float below = plane.lo + ball.place.w * ray.stretch;
  BallRay b;
  b.nearest = nearest;
  b.middle = addSplit(makeSplit(plane.hi, below), makeSplit(further, 0.0));
  precise float halfChord2 = ball.place.y - dot(nearest, nearest);
  b.halfChord2 = halfChord2;
  return b;
}

// From b to a, two places; right relative to the difference.
float placeBetween(Split b, Split a) {
  precise float far = a.hi - b.hi;
  precise float near = a.lo - b.lo;
  precise float sum = far + near;
  return sum;
}

// The place on the ray that a value of the depth buffer stands for, which is not 0.
float placeOfDepth(SceneRay ray, float depth) {
  return (uPlane.x - viewPoint(uView, ray.pixel, depth).z) * ray.stretch;
}

// So far behind it all is hidden for certain, whatever rounding did.
float slackOfDepth(float place) {
  return 1e-5 * (abs(place) + uView.depth.z - uView.depth.w);
}

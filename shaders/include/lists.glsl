// What the passes of fragment lists share (render/surface/lists.cpp): the balls' order, the pixels' lists.
// Needs include/ball_ray.glsl. Pixels are those of a region of the target.

layout(std140, binding = 2) uniform ListsUniforms {
  // x: from a place to a depth between 0 and 1; y: width to which a root is narrowed down, as a share of the
  // smallest support; z: so many supports away from a pixel's first ball float32 is no longer trusted; w: 0
  vec4 uSettings;
  ivec4 uRegion;  // of the target: x, y of its corner; width, height
  // x: separators that a pixel's array may hold; y: nodes there is room for; z: 1 if there are layers to
  // join; w: 2
  ivec4 uLists;
  // Of lists for tiles: x, y: from a pixel of the target to one of the grid; z: tiles in a row; w: 0
  ivec4 uGrid;
};

// A pixel's head: index of its first node, plus 1; 0 = none.
const uint kFirstNode = 0x1FFFFFFFu;
const uint kHit = 0x80000000u;
const uint kInside = 0x40000000u;      // the hit is the surface's inner wall
const uint kUnanswered = 0x20000000u;  // to be done again

// Of a ball, beside what include/field.glsl reads: three texels. The rectangle around it; around its core; x:
// how far from the eye the nearest point of the ball is, less the height of the eye above the plane
// (orthographic: how far below the plane it lies); y: a depth that none of its places falls short of.
layout(binding = 6) uniform sampler2D tOrder;

vec4 orderOf(uint ball, int which) {
  return texelFetch(tOrder, ballTexel(ball, 3u) + ivec2(which, 0), 0);
}

// By how much a distance along the ray exceeds the height of the eye, less the ray's place there.
float slantOf(SceneRay ray) {
  if (!isPerspective(uView)) return 0.0;
  vec2 slope = (ray.pixel - uView.center.xy) * uView.scale.x;
  return uPlane.y * (dot(slope, slope) / (1.0 + ray.stretch));
}

// No ray enters the ball, or any after it, before this place (the effective distance, §5).
float firstPlace(uint ball, float slant) {
  float nearest = orderOf(ball, 2).x;
  return nearest - slant - 1e-6 * (abs(nearest) + slant);
}

// In the order of places; of a core, or of what hides the rest.
float depthOfPlace(float place) {
  return clamp(0.5 + place * uSettings.x, 0.0, 1.0);
}

// Where the ray begins: at the near plane.
Split startOf(SceneRay ray) {
  return twoProduct(uPlane.x - uView.depth.z, ray.stretch);
}

int pixelOf(ivec2 texel) {
  return texel.y * uRegion.z + texel.x;
}

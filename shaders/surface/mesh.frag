#version 450 core
// flags: ALBEDO NORMAL ID DISTANCE
// Where the pixel's ray meets the triangle, computed from the triangle itself, relative to one of its
// corners: what a driver interpolates is right to its grid of pixels only.
#include "include/view.glsl"
#include "include/mesh.glsl"
#include "include/gbuffer.glsl"

layout(binding = 1) uniform usampler2D tCorners;  // three texels each

uint cornerOf(int which) {
  int row = gl_PrimitiveID / kTrianglesPerRow;
  return texelFetch(tCorners, ivec2(3 * (gl_PrimitiveID - row * kTrianglesPerRow) + which, row), 0).x;
}

vec3 squaresOf(uint color) {
  vec3 bytes = vec3(uvec3(color >> 16, color >> 8, color) & 255u);
  return bytes * bytes;
}

void main() {
  MeshVertex a = fetchVertex(cornerOf(0)), b = fetchVertex(cornerOf(1)), c = fetchVertex(cornerOf(2));
  vec3 ab = turn(uView, b.position - a.position), ac = turn(uView, c.position - a.position);
  vec2 pixel = gl_FragCoord.xy + uView.tile.xy;
  vec3 direction = rayDirection(uView, pixel);
  ProjectedCenter center = projectCenter(uView, a.position, vec3(0.0));
  bool fromEye = nearEye(uView, center.depth, max(length(ab), length(ac)));
  vec3 point = rayPoint(uView, pixel, vec2(center.pixelX.hi, center.pixelY.hi),
                        vec2(center.pixelX.lo, center.pixelY.lo), center.view, center.depth, fromEye);

  // Barycentric coordinates of the hit (Moeller and Trumbore 1997), kept within the triangle: a pixel that
  // only its snapped corners cover shows its rim.
  vec3 across = cross(direction, ac);
  float volume = dot(ab, across);
  float u = 1.0 / 3.0, v = 1.0 / 3.0;
  if (abs(volume) > 1e-30) {
    u = clamp(dot(point, across) / volume, 0.0, 1.0);
    v = clamp(dot(direction, cross(point, ab)) / volume, 0.0, 1.0 - u);
  }
  vec3 hit = u * ab + v * ac;

  vec3 normal = (1.0 - u - v) * a.normal + u * b.normal + v * c.normal;
  normal = normalize(turn(uView, normal));
  if (!gl_FrontFacing) normal = -normal;
  float away = dot(normal, direction);
  if (away > 0.0) normal = normalize(normal - away * direction);  // beyond the rim of what the normals bend
  vec3 squares = (1.0 - u - v) * squaresOf(a.color) + u * squaresOf(b.color) + v * squaresOf(c.color);
  uvec3 bytes = uvec3(min(sqrt(max(squares, vec3(0.0))), vec3(255.0)) + 0.5);
  float w = 1.0 - u - v;
  uint id = w >= u && w >= v ? a.id : u >= v ? b.id : c.id;
  float distance = 0.0;
#ifdef DISTANCE
  distance = rayDistance(uView, center.view, centerRange(uView, a.position, vec3(0.0)), hit);
#endif
  writeSurface(depthValue(uView, center.view.z + hit.z), normal, bytes.x << 16 | bytes.y << 8 | bytes.z,
               max(id, 1u), distance);
}

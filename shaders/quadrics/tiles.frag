#version 450 core
// flags: ALBEDO NORMAL ID DISTANCE
// A ray against its tile's list of spheres, cylinders and ellipsoids, nearest first, as core/tiles/
// quadric_caster.cpp casts them: each in its own coordinates, until the next begins behind the nearest hit.
#include "include/view.glsl"
#include "shared/quadrics.glsl"
#include "include/gbuffer.glsl"
#include "include/quadric_fragment.glsl"
#include "include/ball_texture.glsl"
#include "include/tile_lists.glsl"

// QuadricTexels of render/tile_quadrics_glsl.cpp.
layout(binding = 0) uniform sampler2D tQuadrics;
layout(std430, binding = 0) readonly restrict buffer Colors {
  uvec4 uColorsIds[];  // of a cylinder's halves: colours, ids; else the first of each counts
};
layout(location = 0) uniform ivec4 uGrid;
layout(location = 1) uniform ivec2 uPart;   // of each list: its first entry, how many
layout(location = 2) uniform float uSlack;  // how much nearer a later entry can be than an earlier one

const float kCylinder = 1.0, kEllipsoid = 2.0;

struct Quadric {
  vec4 pixel;   // projected centre: hi xy, lo xy
  vec4 center;  // view space; w: largest z of its points
  vec4 shape;   // size of a pixel there, 0: the ray is taken from the eye; height of the eye; kind; radius
  vec4 axisU, axisV;  // w: half lengths; of a cylinder axisU counts
  vec4 range;         // distance of the centre along its ray, hi and lo; third half length
};

vec4 texelOf(uint index, int which) {
  return texelFetch(tQuadrics, ballTexel(index, 6u) + ivec2(which, 0), 0);
}

Chord chordOf(Quadric q, vec2 pixel, vec3 direction) {
  precise vec2 off = (pixel - q.pixel.xy) - q.pixel.zw;
  vec3 point = q.shape.x > 0.0 ? vec3(q.shape.x * off, 0.0) : vec3(-q.center.xy, q.shape.y);
  if (q.shape.z == kCylinder) return cylinderChord(point, direction, q.axisU.xyz, q.axisU.w, q.shape.w);
  if (q.shape.z == kEllipsoid)
    return ellipsoidChord(point, direction, q.axisU.xyz, q.axisV.xyz, cross(q.axisU.xyz, q.axisV.xyz),
                          vec3(q.axisU.w, q.axisV.w, q.range.z));
  return sphereChord(point, direction, q.shape.w);
}

void main() {
  uvec2 list = listOfTile(uGrid, ivec2(gl_FragCoord.xy));
  vec2 pixel = gl_FragCoord.xy + uView.tile.xy;
  vec3 direction = rayDirection(uView, pixel);
  SurfacePoint nearest = SurfacePoint(vec3(0.0), vec3(0.0), -1e38);
  uint met = 0u;
  bool any = false;
  int last = min(int(list.y), uPart.x + uPart.y);
  for (int i = uPart.x; i < last; ++i) {
    uint index = uEntries[list.x + uint(i)];
    Quadric q;
    q.center = texelOf(index, 1);
    if (q.center.w + uSlack < nearest.z) break;
    if (q.center.w < nearest.z) continue;
    q.pixel = texelOf(index, 0);
    q.shape = texelOf(index, 2);
    q.axisU = q.axisV = q.range = vec4(0.0);
    if (q.shape.z > 0.0) {
      q.axisU = texelOf(index, 3);
      q.axisV = texelOf(index, 4);
      q.range = texelOf(index, 5);
    }
    SurfacePoint s;
    if (!visibleEnd(chordOf(q, pixel, direction), q.center.z, s) || !(s.z > nearest.z)) continue;
    nearest = s;
    met = index;
    any = true;
  }
  if (!any) discard;
  uvec4 colorsIds = uColorsIds[met];
  bool second = texelOf(met, 2).z == kCylinder && dot(nearest.position, texelOf(met, 3).xyz) > 0.0;
  float distance = 0.0;
#ifdef DISTANCE
  vec2 range = texelOf(met, 5).xy;
  distance = rayDistance(uView, texelOf(met, 1).xyz, makeSplit(range.x, range.y), nearest.position);
#endif
  writeSurface(depthValue(uView, nearest.z), normalize(nearest.normal), second ? colorsIds.y : colorsIds.x,
               second ? colorsIds.w : colorsIds.z, distance);
}

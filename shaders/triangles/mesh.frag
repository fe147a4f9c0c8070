#version 450 core
// flags: ALBEDO NORMAL ID DISTANCE
// A mesh with the interpolated normals of the surface that it stands for.
#include "include/view.glsl"
#include "include/gbuffer.glsl"

layout(std430, binding = 0) readonly restrict buffer Surfaces {
  uvec2 uSurfaces[];  // by triangle: colour, id
};

layout(location = 0) in vec3 vView;
layout(location = 1) in vec3 vNormal;

void main() {
  vec3 toEye =
      isPerspective(uView) ? normalize(vec3(-vView.xy, uView.depth.x - vView.z)) : vec3(0.0, 0.0, 1.0);
  vec3 normal = normalize(gl_FrontFacing ? vNormal : -vNormal);
  // At the limb the surface's normal turns away before its chord does.
  float facing = dot(normal, toEye);
  if (facing < 0.0) normal = normalize(normal - facing * toEye);
  uvec2 surface = uSurfaces[gl_PrimitiveID];
  float distance =
      isPerspective(uView) ? length(vView - vec3(0.0, 0.0, uView.depth.x)) : uView.depth.z - vView.z;
  writeSurface(gl_FragCoord.z, normal, surface.x, surface.y, distance);
}

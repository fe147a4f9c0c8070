#version 450 core
// A vertex of a mesh, projected without a division: triangles may reach behind the eye.
#include "include/view.glsl"

layout(location = 0) in vec3 aPosition;  // relative to the primitives' origin
layout(location = 1) in vec3 aNormal;

layout(location = 0) out vec3 vView;
layout(location = 1) out vec3 vNormal;

void main() {
  RowProducts p = transformPoint(uView, aPosition, vec3(0.0));
  float z = p.z.hi + p.z.lo;
  vec2 pixels = vec2(p.x.hi + p.x.lo, p.y.hi + p.y.lo);  // at unit depth | as they are
  float depth = isPerspective(uView) ? uView.depth.x - z : 1.0;
  vec2 axis = uView.center.xy + uView.center.zw - uView.tile.xy;
  vView = vec3(pixels * uView.scale.x, z);
  vNormal = turn(uView, aNormal);
  // Divided by the depth this is depthValue().
  gl_Position = vec4((pixels + axis * depth) / uView.tile.zw * 2.0 - depth,
                     (z - uView.depth.w) * uView.depthMap.x, depth);
}

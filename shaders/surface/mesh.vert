#version 450 core
// A vertex of the mesh, found by its number. Linear in homogeneous coordinates: triangles may reach behind
// the eye.
#include "include/view.glsl"
#include "include/mesh.glsl"

void main() {
  RowProducts p = transformPoint(uView, vertexPosition(uint(gl_VertexID)), vec3(0.0));
  float w = 1.0;
  if (isPerspective(uView)) {
    Split depth = depthOf(uView, p.z);
    w = depth.hi + depth.lo;
  }
  vec2 rows = vec2(p.x.hi + p.x.lo, p.y.hi + p.y.lo);
  vec2 axis = (uView.center.xy - uView.tile.xy) + uView.center.zw;  // the optical axis in the target
  float z = (p.z.hi - uView.depth.w) + p.z.lo;
  gl_Position = vec4((rows + axis * w) * 2.0 / uView.tile.zw - w, z * uView.depthMap.x, w);
}

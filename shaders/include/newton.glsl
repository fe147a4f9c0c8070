// What the passes of the method "newton" share (render/surface/newton.cpp). Needs include/ball_ray.glsl.

layout(std140, binding = 2) uniform NewtonUniforms {
  vec4 uTurn[3];  // rows of the rotation from model to view axes
  vec4 uSolver;   // x: tolerance, as a share of a support; y, z, w: 0
  // x: how many terms are added exactly (TERMS); y: most iterations (PLAIN); z: 1 if a ray may begin inside;
  // w: 1 if pixels that failed are shown (PLAIN)
  ivec4 uTerms;
  vec4 uAmbient;     // xyz: the ambient grid's node (0, 0, 0) in model axes; w: 1 / its spacing
  ivec4 uAmbientTo;  // xyz: its last node; w: 1 if there is one
};

// The band of the target that is being drawn: corner and size. Framebuffers and textures but the G-buffer's
// are as large.
layout(location = 0) uniform vec4 uArea;

// Bits of a pixel's status; above them its iterations.
const uint kTouched = 1u;  // its ray meets a support
const uint kFailed = 2u;   // an iteration ended without its tolerance
const uint kGrazing = 4u;  // a tangency could not be told from a crossing
const int kStatusBits = 3;

vec3 toModel(vec3 v) {
  return v.x * uTurn[0].xyz + v.y * uTurn[1].xyz + v.z * uTurn[2].xyz;
}
vec3 toView(vec3 v) {
  return vec3(dot(uTurn[0].xyz, v), dot(uTurn[1].xyz, v), dot(uTurn[2].xyz, v));
}

// Where the ray begins.
Split startOf(SceneRay ray) {
  precise float below = uPlane.x - uView.depth.z;
  return twoProduct(below, ray.stretch);
}

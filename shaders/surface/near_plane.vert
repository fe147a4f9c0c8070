#version 450 core
// One triangle over the whole target, on the near plane: the fragments lie behind it.
void main() {
  gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 1.0, 1.0);
}

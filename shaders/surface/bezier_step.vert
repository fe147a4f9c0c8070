#version 450 core
// One instance for each run of blocks of the screen that have a pixel which is not finished.

layout(location = 0) in vec4 aBox;    // corners [pixels of the region]
layout(location = 1) in ivec2 aCell;  // its cell; the first step that an event of a ball not drawn may have

layout(location = 0) flat out ivec2 vCell;

layout(location = 0) uniform vec2 uSize;  // of the region

void main() {
  vCell = aCell;
  vec2 corner = vec2((gl_VertexID & 1) == 0 ? aBox.x : aBox.z, (gl_VertexID >> 1) == 0 ? aBox.y : aBox.w);
  gl_Position = vec4(corner / uSize * 2.0 - 1.0, 0.0, 1.0);
}

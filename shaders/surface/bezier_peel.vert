#version 450 core
// One instance for each ball that may be seen in a part of the screen: the rectangle around it.

layout(location = 0) in vec4 aBox;  // corners [pixels of the region]
layout(location = 1) in vec4 aPixel;
layout(location = 2) in vec4 aPlace;
layout(location = 3) in vec4 aEye;
layout(location = 4) in uvec2 aIndex;  // of the ball; of the instance

layout(location = 0) flat out vec4 vPixel;
layout(location = 1) flat out vec4 vPlace;
layout(location = 2) flat out vec4 vEye;
layout(location = 3) flat out uvec2 vIndex;

layout(location = 0) uniform vec2 uSize;  // of the region

void main() {
  vPixel = aPixel;
  vPlace = aPlace;
  vEye = aEye;
  vIndex = aIndex;
  vec2 corner = vec2((gl_VertexID & 1) == 0 ? aBox.x : aBox.z, (gl_VertexID >> 1) == 0 ? aBox.y : aBox.w);
  gl_Position = vec4(corner / uSize * 2.0 - 1.0, 0.0, 1.0);
}

#version 450 core
// flags: ENCODE_SRGB
// The mean of all samples (box filter) as the picture.
#include "include/color.glsl"
#include "include/picture.glsl"

layout(binding = 0) uniform sampler2D tSum;  // premultiplied linear light, added up

layout(std140, binding = 1) uniform ResolveUniforms {
  vec4 uCount;     // x: samples
  vec4 uBackdrop;  // premultiplied linear
};

layout(location = 0) out vec4 oColor;

void main() {
  oColor = pictureValue(texelFetch(tSum, ivec2(gl_FragCoord.xy), 0) / uCount.x, uBackdrop);
}

#version 450 core
// The G-buffer's depth in the order of the parts (render/post/occlusion.h); 0 outside.
#include "include/occlusion.glsl"

layout(binding = 0) uniform sampler2D tDepth;

void main() {
  ivec2 here = uPart.xy + uPart.z * ivec2(gl_FragCoord.xy);
  bool inside = all(greaterThanEqual(here, ivec2(0))) && all(lessThan(here, textureSize(tDepth, 0)));
  gl_FragDepth = inside ? texelFetch(tDepth, max(here, ivec2(0)), 0).r : 0.0;
}

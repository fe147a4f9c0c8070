#version 450 core
// flags: ALBEDO NORMAL ID DISTANCE
// Lays what the processor cast (render/surface/tiles.cpp) into the G-buffer, whose formats it already has;
// the depth test decides against what is there.
layout(binding = 0) uniform sampler2D tDepth;
#ifdef ALBEDO
layout(binding = 1) uniform sampler2D tAlbedo;
layout(location = 0) out vec4 oAlbedo;
#endif
#ifdef NORMAL
layout(binding = 2) uniform sampler2D tNormal;
layout(location = 1) out vec2 oNormal;
#endif
#ifdef ID
layout(binding = 3) uniform usampler2D tId;
layout(location = 2) out uint oId;
#endif
#ifdef DISTANCE
layout(binding = 4) uniform sampler2D tDistance;
layout(location = 3) out float oDistance;
#endif

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  float depth = texelFetch(tDepth, texel, 0).x;
  if (!(depth > 0.0)) discard;
  gl_FragDepth = depth;
#ifdef ALBEDO
  oAlbedo = texelFetch(tAlbedo, texel, 0);
#endif
#ifdef NORMAL
  oNormal = texelFetch(tNormal, texel, 0).xy;
#endif
#ifdef ID
  oId = texelFetch(tId, texel, 0).x;
#endif
#ifdef DISTANCE
  oDistance = texelFetch(tDistance, texel, 0).x;
#endif
}

// The only door to the G-buffer: attachments that nobody reads do not exist (render/gbuffer.h).
#include "shared/octahedral.glsl"

// Reversed z; every fragment lies behind the quad it is drawn with, so early depth tests stay possible.
layout(depth_less) out float gl_FragDepth;
#ifdef ALBEDO
layout(location = 0) out vec4 oAlbedo;
#endif
#ifdef NORMAL
layout(location = 1) out vec2 oNormal;
#endif
#ifdef ID
layout(location = 2) out uint oId;
#endif
#ifdef DISTANCE
layout(location = 3) out float oDistance;
#endif

// depth: depthValue() of the point; normal: unit, view space, towards the viewer; color: 0xRRGGBB sRGB; id:
// not 0; distance: along the unit ray [Å].
void writeSurface(float depth, vec3 normal, uint color, uint id, float distance) {
  gl_FragDepth = min(depth, gl_FragCoord.z);  // the promise holds in spite of rounding
#ifdef ALBEDO
  oAlbedo = vec4(uvec3(color >> 16, color >> 8, color) & 255u, 255u) / 255.0;
#endif
#ifdef NORMAL
  oNormal = encodeNormal(normal);
#endif
#ifdef ID
  oId = id;
#endif
#ifdef DISTANCE
  oDistance = distance;
#endif
}

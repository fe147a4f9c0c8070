#version 450 core
// flags: FINAL ENCODE_SRGB FOG LABELS
// Lays the layers of translucent surfaces (include/lists_layers.glsl) over what is opaque: the merged rest,
// then the four nearest, back to front. Each lets through what it does not cover.
#include "include/view.glsl"
#include "shared/octahedral.glsl"
#include "include/color.glsl"
#include "include/picture.glsl"
#include "include/lighting.glsl"

layout(binding = 0) uniform sampler2D tLight;  // premultiplied linear, of what is opaque
layout(binding = 1) uniform usampler2D tLayer0;
layout(binding = 2) uniform usampler2D tLayer1;
layout(binding = 3) uniform usampler2D tLayer2;
layout(binding = 4) uniform usampler2D tLayer3;
layout(binding = 5) uniform usampler2D tRest;

#ifdef LABELS
layout(binding = 6) uniform sampler2D tLabels;  // premultiplied, over everything
#endif

layout(location = 0) out vec4 oColor;

// Of a distance along the ray, in shares of the scene's depth range.
float awayOf(float distance) {
  float range = uView.depth.z - uView.depth.w;
  if (!isPerspective(uView)) return distance / range;
  vec2 slope = (gl_FragCoord.xy + uView.tile.xy - uView.center.xy) * uView.scale.x;
  return (distance * inversesqrt(1.0 + dot(slope, slope)) - (uView.depth.x - uView.depth.z)) / range;
}

// `count` of them behind each other.
vec4 layOver(vec4 light, uvec4 layer, float count, vec3 toEye) {
  float opacity = 1.0 - pow(1.0 - uUnsharp.z, count);
  vec3 color = linearColor(uvec3(layer.x >> 16, layer.x >> 8, layer.x) & 255u);
  vec3 normal = decodeNormal(unpackUnorm2x16(layer.y));
  vec4 over = vec4(lit(color, normal, toEye, 1.0, 1.0), 1.0) * opacity;
#ifdef FOG
  over *= throughFog(awayOf(uintBitsToFloat(layer.z)));
#endif
  return over + (1.0 - over.a) * light;
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 light = texelFetch(tLight, at, 0);
  uvec4 nearest = texelFetch(tLayer0, at, 0);
  if (nearest.w != 0u) {
    vec3 toEye = -rayDirection(uView, gl_FragCoord.xy + uView.tile.xy);
    uvec4 rest = texelFetch(tRest, at, 0);
    if (rest.w != 0u) light = layOver(light, rest, float(rest.w), toEye);
    uvec4 layers[3];
    layers[0] = texelFetch(tLayer3, at, 0);
    layers[1] = texelFetch(tLayer2, at, 0);
    layers[2] = texelFetch(tLayer1, at, 0);
    for (int i = 0; i < 3; ++i) {
      if (layers[i].w != 0u) light = layOver(light, layers[i], 1.0, toEye);
    }
    light = layOver(light, nearest, 1.0, toEye);
  }
#ifdef LABELS
  vec4 label = texelFetch(tLabels, at, 0);
  light = label + (1.0 - label.a) * light;
#endif
#ifdef FINAL
  oColor = pictureValue(light, uBackdrop);
#else
  oColor = light;
#endif
}

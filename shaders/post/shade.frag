#version 450 core
// flags: FINAL ENCODE_SRGB SHADOW OCCLUSION UNSHARP FOG LINES
// Deferred shading: key, fill and ambient light, and the key light's highlight (Blinn 1977), in linear light.
// One sample is written as the picture (FINAL); of several, each is added to the sum that post/resolve.frag
// divides.
#include "include/view.glsl"
#include "shared/octahedral.glsl"
#include "include/color.glsl"
#include "include/scene_depth.glsl"
#include "include/picture.glsl"

layout(binding = 0) uniform sampler2D tAlbedo;  // alpha 1 where there is a surface
layout(binding = 1) uniform sampler2D tNormal;
#ifdef SHADOW
layout(binding = 2) uniform sampler2D tVisibility;  // share of the key light that arrives
#endif

#ifdef OCCLUSION
layout(binding = 3) uniform sampler2D tOcclusion;  // what is hidden of the sky, and the sky, in one unit
#endif
#ifdef UNSHARP
layout(binding = 4) uniform sampler2D tDifference;  // how much nearer than its surroundings (depth_unsharp.h)
#endif
#ifdef FOG
layout(binding = 5) uniform sampler2D tDepth;
#endif
#ifdef LINES
layout(binding = 6) uniform sampler2D tLines;  // share of the pixel that is line
#endif

layout(std140, binding = 1) uniform ShadeUniforms {
  vec4 uKey;       // unit vector towards the light, intensity
  vec4 uFill;      // the same
  vec4 uAmbient;   // ambient, specular, shininess, strength of occlusion
  vec4 uBackdrop;  // premultiplied linear
  vec4 uFog;       // strength; start and 1 / (end - start) in shares of the scene's depth range; 0
  vec4 uLine;      // linear, opacity
  vec4 uUnsharp;   // strength, largest brightening, 0, 0
  // x: linear light of each 8-bit sRGB value. Three pow() per pixel cost llvmpipe more, above all to compile.
  vec4 uLinear[256];
};

vec3 linearAlbedo(vec3 stored) {
  uvec3 value = uvec3(stored * 255.0 + 0.5);
  return vec3(uLinear[value.r].x, uLinear[value.g].x, uLinear[value.b].x);
}

layout(location = 0) out vec4 oColor;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 albedo = texelFetch(tAlbedo, at, 0);
  vec4 light = vec4(0.0);
  if (albedo.a > 0.5) {
    vec3 normal = decodeNormal(texelFetch(tNormal, at, 0).xy);
    vec3 toEye = -rayDirection(uView, gl_FragCoord.xy + uView.tile.xy);
    vec3 halfway = normalize(uKey.xyz + toEye + vec3(0.0, 0.0, 1e-6));  // never zero
    float key = max(dot(normal, uKey.xyz), 0.0) * uKey.w;
#ifdef SHADOW
    key *= texelFetch(tVisibility, at, 0).r;
#endif
    float fill = max(dot(normal, uFill.xyz), 0.0) * uFill.w;
    float around = fill + uAmbient.x;
#ifdef OCCLUSION
    vec2 sky = texelFetch(tOcclusion, at, 0).rg;
    around *= 1.0 - uAmbient.w * min(sky.x / max(sky.y, 1e-5), 1.0);
#endif
    float highlight = key > 0.0 ? uAmbient.y * pow(max(dot(normal, halfway), 1e-6), uAmbient.z) : 0.0;
    highlight *= uKey.w * min(key / (0.1 * uKey.w), 1.0);  // fades out with the light it mirrors
    light = vec4(linearAlbedo(albedo.rgb) * (key + around) + highlight, 1.0);
#ifdef UNSHARP
    // Shifted on the scale of perceived brightness, of which the square root is near enough.
    float shift = min(uUnsharp.x * texelFetch(tDifference, at, 0).r, uUnsharp.y);
    vec3 shifted = max(sqrt(light.rgb) + shift, 0.0);
    light.rgb = shifted * shifted;
#endif
#ifdef FOG
    // Lets the background through: right over a colour, and over nothing.
    float away = 1.0 - nearness(texelFetch(tDepth, at, 0).r);
    light *= 1.0 - uFog.x * clamp((away - uFog.y) * uFog.z, 0.0, 1.0);
#endif
#ifdef LINES
    // The surface's own alpha: a line stays in the fog.
    light.rgb = mix(light.rgb, uLine.rgb * light.a, uLine.a * texelFetch(tLines, at, 0).r);
#endif
  }
#ifdef FINAL
  oColor = pictureValue(light, uBackdrop);
#else
  oColor = light;
#endif
}

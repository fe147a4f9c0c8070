#version 450 core
// flags: FINAL ENCODE_SRGB SHADOW
// Deferred shading: key, fill and ambient light, and the key light's highlight (Blinn 1977), in linear light.
// One sample is written as the picture (FINAL); of several, each is added to the sum that post/resolve.frag
// divides.
#include "include/view.glsl"
#include "shared/octahedral.glsl"
#include "include/color.glsl"
#include "include/picture.glsl"

layout(binding = 0) uniform sampler2D tAlbedo;  // alpha 1 where there is a surface
layout(binding = 1) uniform sampler2D tNormal;
#ifdef SHADOW
layout(binding = 2) uniform sampler2D tVisibility;  // share of the key light that arrives
#endif

layout(std140, binding = 1) uniform ShadeUniforms {
  vec4 uKey;       // unit vector towards the light, intensity
  vec4 uFill;      // the same
  vec4 uAmbient;   // ambient, specular, shininess, 0
  vec4 uBackdrop;  // premultiplied linear
};

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
    float highlight = key > 0.0 ? uAmbient.y * pow(max(dot(normal, halfway), 1e-6), uAmbient.z) : 0.0;
    highlight *= uKey.w * min(key / (0.1 * uKey.w), 1.0);  // fades out with the light it mirrors
    light = vec4(linearFromSrgb(albedo.rgb) * (key + fill + uAmbient.x) + highlight, 1.0);
  }
#ifdef FINAL
  oColor = pictureValue(light, uBackdrop);
#else
  oColor = light;
#endif
}

#version 450 core
// flags: FINAL ENCODE_SRGB SHADOW OCCLUSION UNSHARP FOG LINES LABELS
// Deferred shading. One sample is written as the picture (FINAL); of several, each is added to the sum that
// post/resolve.frag divides. Drawn over the surface only, unless there are labels: the background's colour,
// or nothing, is there already.
#include "include/view.glsl"
#include "shared/octahedral.glsl"
#include "include/color.glsl"
#include "include/scene_depth.glsl"
#include "include/picture.glsl"
#include "include/lighting.glsl"

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
// Light that is added, and the share left of what is here. Asked about by a uniform: another flag would make
// twice as many programs of all.
layout(binding = 8) uniform sampler2D tTraced;
#ifdef LABELS
layout(binding = 7) uniform sampler2D tLabels;  // premultiplied, over everything
#endif

layout(location = 0) out vec4 oColor;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 albedo = texelFetch(tAlbedo, at, 0);
  vec4 light = vec4(0.0);
  if (albedo.a > 0.5) {
    vec3 normal = decodeNormal(texelFetch(tNormal, at, 0).xy);
    vec3 toEye = -rayDirection(uView, gl_FragCoord.xy + uView.tile.xy);
    float visible = 1.0, sky = 1.0;
#ifdef SHADOW
    visible = texelFetch(tVisibility, at, 0).r;
#endif
#ifdef OCCLUSION
    vec2 hidden = texelFetch(tOcclusion, at, 0).rg;
    sky = 1.0 - uAmbient.w * min(hidden.x / max(hidden.y, 1e-5), 1.0);
#endif
    light = vec4(lit(linearColor(uvec3(albedo.rgb * 255.0 + 0.5)), normal, toEye, visible, sky), 1.0);
    if (uUnsharp.w > 0.5) {
      vec4 traced = texelFetch(tTraced, at, 0);
      light.rgb = traced.a * light.rgb + traced.rgb;
    }
#ifdef UNSHARP
    // Shifted on the scale of perceived brightness, of which the square root is near enough.
    float shift = min(uUnsharp.x * texelFetch(tDifference, at, 0).r, uUnsharp.y);
    vec3 shifted = max(sqrt(light.rgb) + shift, 0.0);
    light.rgb = shifted * shifted;
#endif
#ifdef FOG
    // Lets the background through: right over a colour, and over nothing.
    light *= throughFog(1.0 - nearness(texelFetch(tDepth, at, 0).r));
#endif
#ifdef LINES
    // The surface's own alpha: a line stays in the fog.
    light.rgb = mix(light.rgb, uLine.rgb * light.a, uLine.a * texelFetch(tLines, at, 0).r);
#endif
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

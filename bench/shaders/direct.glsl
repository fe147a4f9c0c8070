// Direct shading: what post/shadow.frag and post/shade.frag do once per pixel, for every fragment that passes
// the depth test. Needs include/view.glsl; flags: SHADOW SOFT.
#include "include/color.glsl"
#include "include/picture.glsl"
#ifdef SHADOW
#include "include/shadow.glsl"
#endif

layout(depth_less) out float gl_FragDepth;
layout(location = 0) out vec4 oColor;

layout(std140, binding = 2) uniform DirectUniforms {
  vec4 uKey;      // unit vector towards the light, intensity
  vec4 uFill;     // the same
  vec4 uAmbient;  // ambient, specular, shininess, 0
};

// position: view space; normal: unit; color: 0xRRGGBB sRGB.
void writeShaded(vec3 position, vec3 direction, vec3 normal, uint color) {
  gl_FragDepth = depthValue(uView, position.z);
  vec3 albedo = linearFromSrgb(vec3(uvec3(color >> 16, color >> 8, color) & 255u) / 255.0);
  vec3 halfway = normalize(uKey.xyz - direction + vec3(0.0, 0.0, 1e-6));
  float key = max(dot(normal, uKey.xyz), 0.0) * uKey.w;
#ifdef SHADOW
  key *= keyLightAt(position, normal);
#endif
  float fill = max(dot(normal, uFill.xyz), 0.0) * uFill.w;
  float highlight = key > 0.0 ? uAmbient.y * pow(max(dot(normal, halfway), 1e-6), uAmbient.z) : 0.0;
  highlight *= uKey.w * min(key / (0.1 * uKey.w), 1.0);
  oColor = pictureValue(vec4(albedo * (key + fill + uAmbient.x) + highlight, 1.0), vec4(0.0));
}

// The light of a scene (core/scene.h, Lighting) on a surface: key, fill and ambient light, and the key
// light's highlight (Blinn 1977), in linear light. Also what else shading is told.

layout(std140, binding = 1) uniform ShadeUniforms {
  vec4 uKey;       // unit vector towards the light, intensity
  vec4 uFill;      // the same
  vec4 uAmbient;   // ambient, specular, shininess, strength of occlusion
  vec4 uBackdrop;  // premultiplied linear
  vec4 uFog;       // strength; start and 1 / (end - start) in shares of the scene's depth range; 0
  vec4 uLine;      // linear, opacity
  vec4 uUnsharp;   // strength, largest brightening; opacity of translucent surfaces; 1: mirrors or glass
  // x: linear light of each 8-bit sRGB value. Three pow() per pixel cost llvmpipe more, above all to compile.
  vec4 uLinear[256];
};

vec3 linearColor(uvec3 stored) {
  return vec3(uLinear[stored.r].x, uLinear[stored.g].x, uLinear[stored.b].x);
}

// visible: share of the key light that arrives; sky: share of the ambient and the fill light that does.
vec3 lit(vec3 albedo, vec3 normal, vec3 toEye, float visible, float sky) {
  vec3 halfway = normalize(uKey.xyz + toEye + vec3(0.0, 0.0, 1e-6));  // never zero
  float key = max(dot(normal, uKey.xyz), 0.0) * uKey.w * visible;
  float fill = max(dot(normal, uFill.xyz), 0.0) * uFill.w;
  float around = (fill + uAmbient.x) * sky;
  float highlight = key > 0.0 ? uAmbient.y * pow(max(dot(normal, halfway), 1e-6), uAmbient.z) : 0.0;
  highlight *= uKey.w * min(key / (0.1 * uKey.w), 1.0);  // fades out with the light it mirrors
  return albedo * (key + around) + highlight;
}

// away: 0 = nearest of the scene's depth range, 1 = farthest. The share that fog leaves.
float throughFog(float away) {
  return 1.0 - uFog.x * clamp((away - uFog.y) * uFog.z, 0.0, 1.0);
}

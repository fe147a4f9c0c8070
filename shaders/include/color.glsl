// sRGB (IEC 61966-2-1) to linear light and back.

vec3 linearFromSrgb(vec3 c) {
  return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

vec3 srgbFromLinear(vec3 c) {
  return mix(c * 12.92, 1.055 * pow(max(c, vec3(1e-8)), vec3(1.0 / 2.4)) - 0.055,
             greaterThan(c, vec3(0.0031308)));
}

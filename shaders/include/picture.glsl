// From premultiplied linear light to what is stored in the picture. Needs include/color.glsl.

// backdrop: premultiplied linear light behind everything (alpha 0: transparent, 1: opaque).
vec4 pictureValue(vec4 light, vec4 backdrop) {
  vec4 over = light + (1.0 - light.a) * backdrop;
#ifdef ENCODE_SRGB
  vec3 straight = over.a > 0.0 ? clamp(over.rgb / over.a, 0.0, 1.0) : vec3(0.0);
  return vec4(srgbFromLinear(straight), over.a);
#else
  return over;
#endif
}

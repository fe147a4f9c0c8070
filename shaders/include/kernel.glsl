// The kernel and its first two derivatives by w, w >= 0. Flags: KERNEL_QUARTIC, KERNEL_POWER (neither:
// sextic). Needs shared/metaball.glsl and include/ball_ray.glsl.

float kernelOf(float w) {
#if defined(KERNEL_POWER)
  return powerKernel(w, int(uField.y));
#elif defined(KERNEL_QUARTIC)
  return quarticKernel(w);
#else
  return sexticKernel(w);
#endif
}

float kernelSlopeOf(float w) {
#if defined(KERNEL_POWER)
  return powerSlope(w, int(uField.y));
#elif defined(KERNEL_QUARTIC)
  return quarticSlope(w);
#else
  return sexticSlope(w);
#endif
}

// Grows with w, as the others do.
float kernelCurveOf(float w) {
#if defined(KERNEL_POWER)
  int alpha = int(uField.y);
  float curve = float(alpha * (alpha - 1));
  for (int i = 2; i < alpha; ++i) curve *= w;
  return curve;
#elif defined(KERNEL_QUARTIC)
  return 2.0;
#else
  return (10.0 + 24.0 * w) / 9.0;
#endif
}

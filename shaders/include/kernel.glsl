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

// 1 - k(1 - u): near the centre of a ball, where u = r^2 / R^2 is small, it keeps the digits that k rounds
// off.
float kernelDeficit(float u) {
#if defined(KERNEL_POWER)
  float deficit = u;
  for (int i = 1; i < int(uField.y); ++i) deficit = u + (1.0 - u) * deficit;
  return deficit;
#elif defined(KERNEL_QUARTIC)
  return u * (2.0 - u);
#else
  return u * (22.0 - u * (17.0 - 4.0 * u)) / 9.0;
#endif
}

// A sum of terms q k(1 - u), in two parts: the coefficients of balls close by, which add up without rounding
// where they are whole numbers, and what is left.
struct Terms {
  float coefficients, rest;
};

void addTerm(inout Terms terms, float q, float u) {
  if (u < 0.5) {
    terms.coefficients += q;
    terms.rest -= q * kernelDeficit(u);
  } else {
    terms.rest += q * kernelOf(max(1.0 - u, 0.0));
  }
}

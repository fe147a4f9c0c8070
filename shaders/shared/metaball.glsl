// Kernels of metaballs and one ball's share of the field along a ray, in Bernstein form on any interval. With
// w = 1 - r^2/R^2: sextic w^2 (5 + 4 w) / 9 (Wyvill et al. 1986), quartic w^2 (Murakami and Ichihara 1987),
// power w^alpha (Gourmel et al. 2010). The interval form is the polar form of the quadratic w(t) (Nishita and
// Nakamae 1994 and Kanamori et al. 2008 clip the whole chord instead, and print a = D/R for the dimensionless
// D/R^2). Its coefficients are sums of non-negative terms of the size of the field: float32 loses nothing.

const int kMostExponent = 16;

FN real sexticKernel(real w) {
  return w * w * (real(5) + real(4) * w) / real(9);
}
FN real sexticSlope(real w) {
  return w * (real(10) + real(12) * w) / real(9);
}
FN real quarticKernel(real w) {
  return w * w;
}
FN real quarticSlope(real w) {
  return real(2) * w;
}
FN real powerKernel(real w, int alpha) {
  real product = w;
  for (int i = 1; i < alpha; ++i) product = product * w;
  return product;
}
FN real powerSlope(real w, int alpha) {
  return real(alpha) * powerKernel(w, alpha - 1);
}

// w on an interval of a ray, as a quadratic in Bernstein form.
struct Window {
  real w0;
  real w1;
  real w2;
};

// middle: where on the ray it is nearest to the ball's centre; halfChord2: R^2 less the square of that
// distance; [t0, t1] within the chord: no coefficient is negative but by rounding, which is cut off.
FN Window windowOn(real middle, real halfChord2, real inverseR2, real t0, real t1) {
  real a = t0 - middle;
  real b = t1 - middle;
  Window w;
  w.w0 = max((halfChord2 - a * a) * inverseR2, real(0));
  w.w1 = max((halfChord2 - a * b) * inverseR2, real(0));
  w.w2 = max((halfChord2 - b * b) * inverseR2, real(0));
  return w;
}

struct QuarticPiece {
  real c[5];
};
struct SexticPiece {
  real c[7];
};
struct PowerPiece {
  real c[2 * kMostExponent + 1];  // the first 2 alpha + 1 count
};

FN QuarticPiece quarticPiece(Window w) {
  QuarticPiece p;
  p.c[0] = w.w0 * w.w0;
  p.c[1] = w.w0 * w.w1;
  p.c[2] = (w.w0 * w.w2 + real(2) * w.w1 * w.w1) / real(3);
  p.c[3] = w.w1 * w.w2;
  p.c[4] = w.w2 * w.w2;
  return p;
}

// w^2 raised from degree four to six, and w^3, weighted 5/9 and 4/9.
FN SexticPiece sexticPiece(Window w) {
  QuarticPiece q = quarticPiece(w);
  SexticPiece p;
  p.c[0] = q.c[0] * (real(5) + real(4) * w.w0) / real(9);
  p.c[1] = (real(5) * (real(2) * q.c[0] + real(4) * q.c[1]) +
            real(4) * (real(2) * q.c[0] * w.w1 + real(4) * q.c[1] * w.w0)) /
           real(54);
  p.c[2] = (real(5) * (q.c[0] + real(8) * q.c[1] + real(6) * q.c[2]) +
            real(4) * (q.c[0] * w.w2 + real(8) * q.c[1] * w.w1 + real(6) * q.c[2] * w.w0)) /
           real(135);
  p.c[3] = (real(5) * (real(4) * q.c[1] + real(12) * q.c[2] + real(4) * q.c[3]) +
            real(4) * (real(4) * q.c[1] * w.w2 + real(12) * q.c[2] * w.w1 + real(4) * q.c[3] * w.w0)) /
           real(180);
  p.c[4] = (real(5) * (real(6) * q.c[2] + real(8) * q.c[3] + q.c[4]) +
            real(4) * (real(6) * q.c[2] * w.w2 + real(8) * q.c[3] * w.w1 + q.c[4] * w.w0)) /
           real(135);
  p.c[5] = (real(5) * (real(4) * q.c[3] + real(2) * q.c[4]) +
            real(4) * (real(4) * q.c[3] * w.w2 + real(2) * q.c[4] * w.w1)) /
           real(54);
  p.c[6] = q.c[4] * (real(5) + real(4) * w.w2) / real(9);
  return p;
}

// w^alpha by repeated products of Bernstein forms: with scaled coefficients C(n, k) c_k the product is a
// plain convolution.
FN PowerPiece powerPiece(Window w, int alpha) {
  PowerPiece p;
  for (int k = 0; k <= 2 * kMostExponent; ++k) p.c[k] = real(0);
  p.c[0] = w.w0;
  p.c[1] = real(2) * w.w1;
  p.c[2] = w.w2;
  for (int n = 2; n <= alpha; ++n) {
    for (int k = 2 * n; k >= 0; --k) {
      real sum = k <= 2 * n - 2 ? p.c[k] * w.w0 : real(0);
      if (k >= 1 && k <= 2 * n - 1) sum = sum + real(2) * p.c[k - 1] * w.w1;
      if (k >= 2) sum = sum + p.c[k - 2] * w.w2;
      p.c[k] = sum;
    }
  }
  real binomial = real(1);
  for (int k = 0; k <= 2 * alpha; ++k) {
    p.c[k] = p.c[k] / binomial;
    binomial = binomial * real(2 * alpha - k) / real(k + 1);
  }
  return p;
}

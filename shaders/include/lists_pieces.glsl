// One ball's share of the field along a ray (Szécsi and Illés 2012, §3 and §4), exact or, with CUBIC, as two
// cubics that agree with it in value and slope at both ends of its chord and in the middle. Needs
// include/field.glsl. Where on the ray: relative to any common place.

// A place at which the polynomial changes.
//   exact: x place; y half the chord, negative where the ball is left; z coefficient, negated there; w 1/R^2
//   cubic: the same, but z the peak times the coefficient, of one sign; in the middle y = 0, w half the chord
#define Separator vec4

// A ball that the ray is in, as the record of where it is left says it.
struct Active {
  float middle, halfChord, strength, inverseR2;
};

Active activeOf(Separator s) {
#ifdef CUBIC
  return Active(s.x + s.y, -s.y, s.z, s.w);
#else
  return Active(s.x + s.y, -s.y, -s.z, s.w);
#endif
}

bool isLeft(Separator s) {
  return s.y < 0.0;
}

#ifdef CUBIC

const int kSeparatorsOfBall = 3;

// The peak: what the ball adds where the ray is nearest to its centre.
float strengthOf(Ball ball, float halfChord2) {
  return ball.coefficient * kernelAt(clamp(halfChord2 * ball.inverseR2, 0.0, 1.0));
}

// x^2 (3 - 2 x) in powers of a place u, where x = at + slope u.
void addSmoothstep(inout Polygon sum, float at, float slope, float strength) {
  sum.c[0] += strength * at * at * (3.0 - 2.0 * at);
  sum.c[1] += strength * slope * 6.0 * at * (1.0 - at);
  sum.c[2] += strength * slope * slope * (3.0 - 6.0 * at);
  sum.c[3] -= strength * slope * slope * slope * 2.0;
}

// What the polynomial changes by at a separator, in powers of the distance from `now`, which is not before
// it. (In the paper's own form: strength / Q^3 times alpha + beta, -2 alpha, alpha - beta.)
void addChange(inout Polygon sum, Separator s, float now) {
  float after = now - s.x;
  if (s.y > 0.0) {
    addSmoothstep(sum, after / s.y, 1.0 / s.y, s.z);
  } else if (s.y < 0.0) {
    addSmoothstep(sum, after / s.y, 1.0 / s.y, -s.z);
  } else {
    float slope = 1.0 / s.w;
    addSmoothstep(sum, 1.0 + after * slope, slope, -s.z);
    addSmoothstep(sum, 1.0 - after * slope, -slope, s.z);
  }
}

// A ball within which the interval lies, in powers of the distance from `now`; middleOf: of the interval.
void addActive(inout Polygon sum, Active a, float now, float middleOf) {
  float slope = (middleOf < a.middle ? 1.0 : -1.0) / a.halfChord;
  addSmoothstep(sum, 1.0 + (now - a.middle) * slope, slope, a.strength);
}

// The same on [now, now + size], in Bernstein form: the polar form of the cubic.
void addExactly(inout Polygon sum, Active a, float now, float size) {
  float from = (now - a.middle) / a.halfChord, to = from + size / a.halfChord;
  float side = from + to < 0.0 ? 1.0 : -1.0;
  float x = clamp(1.0 + side * from, 0.0, 1.0), y = clamp(1.0 + side * to, 0.0, 1.0);
  sum.c[0] += a.strength * x * x * (3.0 - 2.0 * x);
  sum.c[1] += a.strength * (x * x + 2.0 * x * y - 2.0 * x * x * y);
  sum.c[2] += a.strength * (y * y + 2.0 * x * y - 2.0 * x * y * y);
  sum.c[3] += a.strength * y * y * (3.0 - 2.0 * y);
}

#else

const int kSeparatorsOfBall = 2;

float strengthOf(Ball ball, float halfChord2) {
  return ball.coefficient;
}

void addExactly(inout Polygon sum, Active a, float now, float size) {
  addShare(sum, windowOn(a.middle - now, a.halfChord * a.halfChord, a.inverseR2, 0.0, size), a.strength);
}

#ifndef KERNEL_POWER
// f(w) in powers of u, where w = a + b u + c u^2.
void addPowers(inout Polygon sum, float a, float b, float c, float strength) {
  float s0 = a * a, s1 = 2.0 * a * b, s2 = b * b + 2.0 * a * c, s3 = 2.0 * b * c, s4 = c * c;
#ifdef KERNEL_QUARTIC
  sum.c[0] += strength * s0;
  sum.c[1] += strength * s1;
  sum.c[2] += strength * s2;
  sum.c[3] += strength * s3;
  sum.c[4] += strength * s4;
#else
  float five = strength * (5.0 / 9.0), four = strength * (4.0 / 9.0);
  sum.c[0] += five * s0 + four * (s0 * a);
  sum.c[1] += five * s1 + four * (s1 * a + s0 * b);
  sum.c[2] += five * s2 + four * (s2 * a + s1 * b + s0 * c);
  sum.c[3] += five * s3 + four * (s3 * a + s2 * b + s1 * c);
  sum.c[4] += five * s4 + four * (s4 * a + s3 * b + s2 * c);
  sum.c[5] += four * (s4 * b + s3 * c);
  sum.c[6] += four * (s4 * c);
#endif
}

void addChange(inout Polygon sum, Separator s, float now) {
  float after = now - s.x;
  addPowers(sum, after * (2.0 * s.y - after) * s.w, 2.0 * (s.y - after) * s.w, -s.w, s.z);
}

void addActive(inout Polygon sum, Active a, float now, float middleOf) {
  float along = now - a.middle;
  addPowers(sum, (a.halfChord * a.halfChord - along * along) * a.inverseR2, -2.0 * along * a.inverseR2,
            -a.inverseR2, a.strength);
}
#endif

#endif

#if defined(CUBIC) || !defined(KERNEL_POWER)
#define RUNNING  // of the power kernel, of up to degree 32, float32 cannot carry a sum along

// In powers of the distance from a place that lies farther by `step`. Constant bounds: see partOf().
void shiftPowers(inout Polygon p, float step) {
  for (int n = 0; n < kMostDegree; ++n) {
    for (int k = kMostDegree - 1; k >= 0; --k) {
      if (k >= n) p.c[k] += step * p.c[k + 1];
    }
  }
}

// Bernstein form on [0, size] of a polynomial in powers.
Polygon bernsteinOf(Polygon p, float size) {
  float power = 1.0, binomial = 1.0;
  for (int k = 1; k <= kMostDegree; ++k) {
    power *= size;
    binomial *= float(kMostDegree - k + 1) / float(k);
    p.c[k] *= power / binomial;
  }
  for (int n = 1; n <= kMostDegree; ++n) {
    for (int k = kMostDegree; k > 0; --k) {
      if (k >= n) p.c[k] += p.c[k - 1];
    }
  }
  return p;
}

// The least and the largest coefficient.
vec2 rangeOf(Polygon p) {
  vec2 range = vec2(p.c[0]);
  for (int k = 1; k <= kMostDegree; ++k) range = vec2(min(range.x, p.c[k]), max(range.y, p.c[k]));
  return range;
}
#endif

// The first root in a stretch of a ray, guaranteed: bounds of the field and of its second derivative along
// the ray say where there is none and where there is one at most (Kalra and Barr 1989,
// doi 10.1145/74334.74364, whose bounds are of values and slopes in space). Within a bracket Newton's method,
// halving where a step leaves it. Needs include/newton_field.glsl.

struct Found {
  bool hit;
  float at;
};

struct Effort {
  int iterations;
  int pieces;
  bool grazing;
  bool unfinished;
};

// Of a sum of terms, as a share of their absolute values.
const float kRounding = 2e-7;
const int kMostIntervals = 4096;
const int kMostSteps = 48;

// low and high are known to hold f <= 0 and f > 0.
float rootWithin(Line line, Met met, float low, float high, float guess, float enough, inout Effort effort) {
  float at = guess;
  for (int i = 0; i < kMostSteps; ++i) {
    ++effort.iterations;
    Value v = valueAt(line, met, at);
    if (v.f > 0.0) {
      high = at;
    } else {
      low = at;
    }
    float next = at - v.f / v.slope;
    bool inside = next > low && next < high;
    if (!inside) next = low + 0.5 * (high - low);
    if (inside && abs(next - at) <= enough) return next;
    if (!(high - low > 2e-7 * max(abs(low), abs(high))) || next == at) return next;
    at = next;
  }
  effort.unfinished = true;
  return at;
}

#ifndef TERMS
// Around a place: the value, and bounds over all places within r of it.
struct Bounds {
  Value middle;
  float most;             // of f
  float lowest, highest;  // of the second derivative
};

Bounds boundsAround(Line line, Met met, float at, float r) {
  Bounds b;
  b.middle = Value(0.0, 0.0, uField.x);
  Terms terms = Terms(-line.sign * uField.x, 0.0);
  b.most = -line.sign * uField.x;
  b.lowest = 0.0;
  b.highest = 0.0;
  int balls = activeCount(line, met);
  for (int i = 0; i < balls; ++i) {
    Other o = activeBall(line, met, i);
    vec3 v = o.base + at * line.direction;
    float s = dot(v, line.direction), inverse = o.inverseR2;
    float u = dot(v, v) * inverse;
    vec3 aside = v - s * line.direction;
    float peak = 1.0 - dot(aside, aside) * inverse;  // w where the ray is nearest
    float near = max(abs(s) - r, 0.0), far = abs(s) + r;
    float wMost = peak - near * near * inverse;
    if (!(wMost > 0.0)) continue;
    float wLeast = max(peak - far * far * inverse, 0.0);
    float q = o.coefficient, w = max(1.0 - u, 0.0);
    addTerm(terms, q, u);
    b.middle.slope -= 2.0 * q * kernelSlopeOf(w) * s * inverse;
    b.middle.size += abs(q) * w;
    b.most += q * kernelOf(q > 0.0 ? wMost : wLeast);
    // k'' (w')^2 + k' w'', with w' = -2 s / R^2 and w'' = -2 / R^2.
    float steepest = min(far * far, peak / inverse), flattest = near * near;
    float high =
        4.0 * inverse * inverse * kernelCurveOf(wMost) * steepest - 2.0 * inverse * kernelSlopeOf(wLeast);
    float low =
        4.0 * inverse * inverse * kernelCurveOf(wLeast) * flattest - 2.0 * inverse * kernelSlopeOf(wMost);
    if (!(wLeast > 0.0)) {  // part of it is beyond the support
      low = min(low, 0.0);
      high = max(high, 0.0);
    }
    b.lowest += q * (q > 0.0 ? low : high);
    b.highest += q * (q > 0.0 ? high : low);
  }
  b.middle.f = terms.coefficients + terms.rest;
  return b;
}

// The largest that f can be within r.
float largestWithin(Bounds b, float r) {
  float s = abs(b.middle.slope);
  float quadratic = b.middle.f + s * r + 0.5 * b.highest * r * r;
  if (b.highest < 0.0 && s < -b.highest * r) quadratic = b.middle.f - 0.5 * s * s / b.highest;
  return min(b.most, quadratic);
}

// Where f becomes positive between two places; at the first it is not, but by rounding or because it became
// so where another hull has seen to it. core2: squared radius of the hull's own ball's core.
Found firstRoot(Line line, float from, float to, float support, float core2, inout Effort effort) {
  Met met = ballsMet(line, from, to);
  ++effort.pieces;
  if (met.count == 1) {
    float at = crossCore(coreEnds(0.0, halfCoreChord(core2, line.nearest)), from, to, line.sign < 0.0);
    return Found(at < kNone, at);
  }
  ++effort.iterations;
  Value start = valueAt(line, met, from);
  if (start.f > kRounding * start.size) return Found(true, from);
  float enough = uSolver.x * support;
  float size = to - from;
  for (int i = 0; i < kMostIntervals; ++i) {
    if (!(from < to)) return Found(false, 0.0);
    float end = to - from > 1.01 * size ? from + size : to;
    float r = 0.5 * (end - from), middle = from + r;
    ++effort.iterations;
    Bounds b = boundsAround(line, met, middle, r);
    float largest = largestWithin(b, r);
    float bend = r * max(max(b.highest, -b.lowest), 0.0);
    bool falls = b.middle.slope + bend<0.0, rises = b.middle.slope - bend> 0.0;
    // Where f is nowhere above rounding there is less to be told apart.
    bool flat_ = largest < kRounding * b.middle.size;
    bool narrow = r <= (flat_ ? 2e-4 : 4e-7) * support;
    if (!(largest > 0.0) || falls || rises || narrow) {
      if (largest > 0.0 && !falls) {
        effort.grazing = effort.grazing || !rises;
        float last = middle;
        bool found = b.middle.f > 0.0;
        if (!found) {
          ++effort.iterations;
          last = end;
          found = valueAt(line, met, end).f > 0.0;
        }
        if (found) return Found(true, rootWithin(line, met, from, last, middle, enough, effort));
      }
      from = end;
      size *= 2.0;
    } else {
      size = r;
    }
  }
  effort.unfinished = true;
  return Found(false, 0.0);
}
#else
// The sum of the largest terms and a trilinear texture have kinks, so there are no such bounds: the first
// change of sign between places a 32nd of the support apart.
Found firstRoot(Line line, float from, float to, float support, float core2, inout Effort effort) {
  Met met = ballsMet(line, from, to);
  ++effort.pieces;
  float enough = uSolver.x * support, step = support / 32.0;
  for (int i = 0; i < kMostIntervals; ++i) {
    float at = min(from + float(i) * step, to);
    ++effort.iterations;
    if (valueAt(line, met, at).f > 0.0) {
      if (i == 0) return Found(true, from);
      float before = from + float(i - 1) * step;
      return Found(true, rootWithin(line, met, before, at, 0.5 * (before + at), enough, effort));
    }
    if (!(at < to)) return Found(false, 0.0);
  }
  effort.unfinished = true;
  return Found(false, 0.0);
}
#endif

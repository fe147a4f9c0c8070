// Where a polynomial in Bernstein form first becomes positive. Needs include/field.glsl. The interval is
// halved until the coefficients change their sign at most once, which brackets a single root; regula falsi
// with halved weights (Dowell and Jarratt 1971, doi 10.1007/BF01934364) and bisection narrow it down.
//
// Halves are taken from the whole anew by their place, a whole number of powers of two: no stack, any depth.

struct Effort {
  int iterations;
  bool grazing;     // a tangency could not be told from a crossing at the tolerance
  bool unfinished;  // iterations ran out
};

const float kNoRoot = 2.0;

float polygonAt(Polygon p, float u) {
  int degree = fieldDegree();
  float v = 1.0 - u, power = 1.0, binomial = 1.0, sum = p.c[0] * v;
  for (int k = 1; k < degree; ++k) {
    power *= u;
    binomial *= float(degree - k + 1) / float(k);
    sum = (sum + power * binomial * p.c[k]) * v;
  }
  return sum + power * u * p.c[degree];
}

// The part on [from, from + size] (de Casteljau, from both ends). The bounds of all loops are the same: Mesa
// 22.3 runs an inner loop not even once whose bound is the outer one's counter.
Polygon partOf(Polygon p, float from, float size) {
  int degree = fieldDegree();
  for (int n = 0; n < degree; ++n) {
    for (int k = 0; k < degree; ++k) {
      if (k + n < degree) p.c[k] += (p.c[k + 1] - p.c[k]) * from;
    }
  }
  float share = size / (1.0 - from);
  for (int n = 0; n < degree; ++n) {
    for (int k = degree; k > 0; --k) {
      if (k > n) p.c[k] = p.c[k - 1] + (p.c[k] - p.c[k - 1]) * share;
    }
  }
  return p;
}

int signChanges(Polygon p) {
  int changes = 0;
  for (int k = 0; k < fieldDegree(); ++k) changes += (p.c[k] > 0.0) != (p.c[k + 1] > 0.0) ? 1 : 0;
  return changes;
}

// The only root in [0, 1]; the first coefficient is not positive, the last is.
float bracketedRoot(Polygon p, float width, inout Effort effort) {
  float low = 0.0, high = 1.0, atLow = p.c[0], atHigh = p.c[fieldDegree()];
  float weightLow = atLow, weightHigh = atHigh, before = 2.0;
  int side = 0;  // which end moved last
  for (int i = 0; i < 64; ++i) {
    float size = high - low;
    if (size <= width) return low + size * (atLow / (atLow - atHigh));
    ++effort.iterations;
    // A step shorter than the tolerance would only creep up to the root.
    float u = low + size * (weightLow / (weightLow - weightHigh));
    u = clamp(u, low + 0.4 * width, high - 0.4 * width);
    if (i % 3 == 2) {  // steps that do not halve what is left are followed by one that does
      if (size > 0.25 * before) u = 0.5 * (low + high);
      before = size;
    }
    float value = polygonAt(p, u);
    if (value > 0.0) {
      high = u;
      atHigh = value;
      weightHigh = value;
      if (side > 0) weightLow *= 0.5;
      side = 1;
    } else {
      low = u;
      atLow = value;
      weightLow = value;
      if (side < 0) weightHigh *= 0.5;
      side = -1;
    }
  }
  effort.unfinished = true;
  return high;
}

// The first place in [0, 1] at which the polynomial becomes positive, or kNoRoot. width: what a root, or a
// tangency that cannot be told from one, is narrowed down to.
float firstRoot(Polygon whole, float width, inout Effort effort) {
  int degree = fieldDegree();
  float start = 0.0, size = 1.0;
  for (int i = 0; i < 256; ++i) {
    Polygon p = whole;
    if (size < 1.0) p = partOf(whole, start, size);
    if (p.c[0] > 0.0) return start;
    int changes = signChanges(p);
    if (changes == 1) return start + size * bracketedRoot(p, width / size, effort);
    if (changes > 1 && size > width) {
      ++effort.iterations;
      size *= 0.5;
      continue;
    }
    if (changes > 1) {
      effort.grazing = true;
      if (p.c[degree] > 0.0) return start + 0.5 * size;
    }
    start += size;
    if (start >= 1.0) return kNoRoot;
    for (int k = 0; k < 24; ++k) {  // as wide again as its place allows
      if (fract(start / (2.0 * size)) == 0.0) size *= 2.0;
    }
  }
  effort.unfinished = true;
  return kNoRoot;
}

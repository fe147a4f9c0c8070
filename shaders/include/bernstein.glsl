// Roots of a polynomial in Bernstein form: Bezier clipping (Nishita, Sederberg, Kakimoto 1990,
// doi 10.1145/97879.97916) with the rules and the short stack of Kanamori et al. 2008, §5.4. Needs
// include/field.glsl for Polygon and its degree. Flag: PLAIN, halving in the place of clipping.
//
// Where the paper's stack of three would overflow, the farthest of what waits is forgotten, and found again
// from the whole polynomial once the nearer is done: any depth is right, three suffice for nearly all. The
// power kernel's polynomials, of up to 33 numbers, are too long to be kept: its stack is empty.

// The part on [0, u] and the part on [u, 1] (de Casteljau). The bounds of both loops are the same: Mesa 22.3
// runs an inner loop not even once whose bound is the outer one's counter.
void splitPolygon(Polygon p, float u, out Polygon left, out Polygon right) {
  int degree = fieldDegree();
  Polygon head = p, work = p;
  for (int n = 0; n < degree; ++n) {
    for (int k = 0; k < degree; ++k) {
      if (k + n < degree) work.c[k] += (work.c[k + 1] - work.c[k]) * u;
    }
    head.c[n + 1] = work.c[0];
  }
  left = head;
  right = work;
}

int signChanges(Polygon p) {
  int changes = 0;
  for (int k = 0; k < fieldDegree(); ++k) changes += (p.c[k] > 0.0) != (p.c[k + 1] > 0.0) ? 1 : 0;
  return changes;
}

bool anyPositive(Polygon p) {
  bool any = false;
  for (int k = 0; k <= fieldDegree(); ++k) any = any || p.c[k] > 0.0;
  return any;
}

// Where the hull of the control points meets the axis.
vec2 hullOnAxis(Polygon p) {
  int degree = fieldDegree();
  vec2 range = vec2(1.0, 0.0);
  for (int i = 0; i <= degree; ++i) {
    for (int j = 0; j <= degree; ++j) {
      if (j <= i || (p.c[i] > 0.0) == (p.c[j] > 0.0)) continue;
      float x = (float(i) + float(j - i) * (p.c[i] / (p.c[i] - p.c[j]))) / float(degree);
      range = vec2(min(range.x, x), max(range.y, x));
    }
  }
  return clamp(range + vec2(-1e-6, 1e-6), 0.0, 1.0);
}

struct Effort {
  int iterations;
  bool grazing;
  bool unfinished;
};

const int kMostIterations = 256;
const float kNoRoot = 2.0;

struct Part {
  Polygon p;
  float start, end;
};

// The first place in [0, 1] at which the polynomial becomes positive, or kNoRoot. width: what a root, or a
// tangency that cannot be told from one, is narrowed down to.
float firstRoot(Polygon whole, float width, inout Effort effort) {
  int degree = fieldDegree();
  Part now = Part(whole, 0.0, 1.0);
#ifndef KERNEL_POWER
  Part next = now, second = now, third = now;
  int waiting = 0;
#endif
  bool forgotten = false;
  for (int i = 0; i < kMostIterations; ++i) {
    if (now.p.c[0] > 0.0) return now.start;
    int changes = signChanges(now.p);
    bool narrow = now.end - now.start <= width;
    if (changes > 0 && narrow) {
      effort.grazing = effort.grazing || changes > 1;
      float low = now.p.c[0], high = now.p.c[degree];
      if (high > 0.0) return mix(now.start, now.end, low / (low - high));
    }
    if (changes == 0 || narrow) {  // none here: on to what waits
#ifndef KERNEL_POWER
      if (waiting > 0) {
        now = next;
        next = second;
        second = third;
        --waiting;
        continue;
      }
#endif
      if (forgotten && now.end < 1.0) {
        Polygon before;
        float from = now.end;
        splitPolygon(whole, from, before, now.p);
        now.start = from;
        now.end = 1.0;
        forgotten = false;
      } else {
        return kNoRoot;
      }
      continue;
    }
    ++effort.iterations;
    Polygon left, right;
#ifndef PLAIN
    if (changes == 1) {
      vec2 hull = hullOnAxis(now.p);
      if (hull.y - hull.x < 0.5) {
        float size = now.end - now.start;
        splitPolygon(now.p, hull.y, left, right);
        splitPolygon(left, hull.x / hull.y, right, now.p);
        now.end = now.start + size * hull.y;
        now.start += size * hull.x;
        if (!(now.p.c[degree] > 0.0)) return now.end;  // rounding has moved the root out of its hull
        continue;
      }
    }
#endif
    float middle = 0.5 * (now.start + now.end);
    splitPolygon(now.p, 0.5, left, right);
    bool inLeft = changes > 1 || left.c[degree] > 0.0;
    if (!inLeft) {
      now.p = right;
      now.start = middle;
      continue;
    }
    if (changes > 1 && anyPositive(right)) {
#ifdef KERNEL_POWER
      forgotten = true;
#else
      forgotten = forgotten || waiting == 3;
      third = second;
      second = next;
      next = Part(right, middle, now.end);
      waiting = min(waiting + 1, 3);
#endif
    }
    now.p = left;
    now.end = middle;
  }
  effort.unfinished = true;
  return now.p.c[degree] > 0.0 ? now.end : kNoRoot;
}

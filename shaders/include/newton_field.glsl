// The field along a fragment's ray. Flag TERMS: the uTerms.x largest terms, and the rest from a volume
// texture. Needs include/kernel.glsl, include/newton.glsl, include/newton_balls.glsl.

// Those that are met between two places.
Met ballsMet(Line line, float from, float to) {
  Met met;
  met.ranks[0] = line.rank;
  met.count = 1;
  for (uint k = line.from; k < line.to; ++k) {
    uint rank = otherRank(line.first + k);
    Other o = fetchOther(line, rank);
    float middle = -dot(o.base, line.direction);
    float nearest = clamp(middle, from, to);
    vec3 v = o.base + nearest * line.direction;
    if (dot(v, v) * o.inverseR2 > 1.0 + 1e-5) continue;
    if (met.count == kMostMet) {
      met.count = -1;
      break;
    }
    met.ranks[met.count++] = rank;
  }
  return met;
}

// sign * F at a place, its slope along the ray, and a bound of the absolute values of its terms.
struct Value {
  float f, slope, size;
};

#ifdef TERMS
layout(binding = 2) uniform sampler3D tAmbient;

// Value and slope: trilinear by hand, since filters of hardware round their weights to 8 bits.
vec2 ambientAt(vec3 point, vec3 direction) {
  vec3 place = (point - uAmbient.xyz) * uAmbient.w;
  vec3 last = vec3(uAmbientTo.xyz);
  bvec3 within = bvec3(place.x > 0.0 && place.x<last.x, place.y> 0.0 && place.y<last.y, place.z> 0.0 &&
                       place.z < last.z);
  place = clamp(place, vec3(0.0), last);
  vec3 cell = min(floor(place), last - 1.0), f = place - cell;
  ivec3 n = ivec3(cell);
  float c000 = texelFetch(tAmbient, n, 0).x, c100 = texelFetch(tAmbient, n + ivec3(1, 0, 0), 0).x;
  float c010 = texelFetch(tAmbient, n + ivec3(0, 1, 0), 0).x,
        c110 = texelFetch(tAmbient, n + ivec3(1, 1, 0), 0).x;
  float c001 = texelFetch(tAmbient, n + ivec3(0, 0, 1), 0).x,
        c101 = texelFetch(tAmbient, n + ivec3(1, 0, 1), 0).x;
  float c011 = texelFetch(tAmbient, n + ivec3(0, 1, 1), 0).x,
        c111 = texelFetch(tAmbient, n + ivec3(1, 1, 1), 0).x;
  float y0 = mix(mix(c000, c100, f.x), mix(c010, c110, f.x), f.y);
  float y1 = mix(mix(c001, c101, f.x), mix(c011, c111, f.x), f.y);
  vec3 slope =
      vec3(mix(mix(c100 - c000, c110 - c010, f.y), mix(c101 - c001, c111 - c011, f.y), f.z),
           mix(mix(c010, c110, f.x) - mix(c000, c100, f.x), mix(c011, c111, f.x) - mix(c001, c101, f.x), f.z),
           y1 - y0);
  slope *= vec3(within) * uAmbient.w;
  return vec2(mix(y0, y1, f.z), dot(slope, direction));
}

const int kMostTerms = 32;

Value valueAt(Line line, Met met, float at) {
  float values[kMostTerms], slopes[kMostTerms];
  int kept = 0, least = 0;
  int balls = activeCount(line, met);
  for (int i = 0; i < balls; ++i) {
    Other o = activeBall(line, met, i);
    vec3 v = o.base + at * line.direction;
    float w = 1.0 - dot(v, v) * o.inverseR2;
    if (!(w > 0.0)) continue;
    float value = o.coefficient * kernelOf(w);
    float slope = -2.0 * o.coefficient * kernelSlopeOf(w) * dot(v, line.direction) * o.inverseR2;
    int slot = least;
    if (kept < uTerms.x) {
      slot = kept++;
    } else if (!(abs(value) > abs(values[least]))) {
      continue;
    }
    values[slot] = value;
    slopes[slot] = slope;
    least = 0;
    for (int k = 1; k < kMostTerms; ++k) {
      if (k < kept && abs(values[k]) < abs(values[least])) least = k;
    }
  }
  Value sum = Value(-line.sign * uField.x, 0.0, uField.x);
  for (int k = 0; k < kMostTerms; ++k) {
    if (k >= kept) break;
    sum.f += values[k];
    sum.slope += slopes[k];
    sum.size += abs(values[k]);
  }
  if (uAmbientTo.w == 0) return sum;
  vec2 rest = line.sign * ambientAt(line.center + (line.nearest + at * line.direction), line.direction);
  sum.f += rest.x;
  sum.slope += rest.y;
  return sum;
}
#else
Value valueAt(Line line, Met met, float at) {
  Value sum = Value(0.0, 0.0, uField.x);
  Terms terms = Terms(-line.sign * uField.x, 0.0);
  int balls = activeCount(line, met);
  for (int i = 0; i < balls; ++i) {
    Other o = activeBall(line, met, i);
    vec3 v = o.base + at * line.direction;
    float u = dot(v, v) * o.inverseR2, w = max(1.0 - u, 0.0);
    addTerm(terms, o.coefficient, u);
    sum.slope -= 2.0 * o.coefficient * kernelSlopeOf(w) * dot(v, line.direction) * o.inverseR2;
    sum.size += abs(o.coefficient) * w;
  }
  sum.f = terms.coefficients + terms.rest;
  return sum;
}
#endif

// Of a ball alone the surface is its core, a sphere, met exactly however close the level is to the maximum.
const float kNone = 1e30;  // no place on a ray

// Half of a ray's chord in it; -kNone: the ray passes by. core2: squared radius; nearest: from the centre to
// the ray.
float halfCoreChord(float core2, vec3 nearest) {
  float square = core2 - dot(nearest, nearest);
  return square > 0.0 ? sqrt(square) : -kNone;
}

// Where the ray enters and leaves it; middle: where it is nearest to the centre.
vec2 coreEnds(float middle, float halfChord) {
  return vec2(middle - halfChord, middle + halfChord);
}

bool isInCore(vec2 ends, float at) {
  return ends.x < at && ends.y > at;
}

// The first crossing in [from, to], or kNone. inside: of the field where the search begins; a sign that has
// changed by `from` is a crossing there: rounding opens no cracks.
float crossCore(vec2 ends, float from, float to, bool inside) {
  if (!inside) return ends.x < to && ends.y > from ? max(ends.x, from) : kNone;
  if (!isInCore(ends, from)) return from;
  return ends.y < to ? ends.y : kNone;
}

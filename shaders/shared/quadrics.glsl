// Where a ray meets a sphere, a capped cylinder or an ellipsoid, relative to the primitive's own centre.
// Sigg et al., GPU-Based Ray-Casting of Quadratic Surfaces, PBG 2006, §3.3, with the intersection in eye
// space instead of their eq. (7), which cancels for small, far quadrics: the discriminant is r^2 - |closest
// approach|^2 (Haines, Günther, Akenine-Möller, Ray Tracing Gems 2019, ch. 7,
// doi 10.1007/978-1-4842-4427-2_7).

// The part of a ray inside a convex solid: parameters measured from the given ray point, normals outward.
struct Chord {
  bool hit;
  vec3 entry;  // relative to the centre
  vec3 exit;
  vec3 entryNormal;  // unit
  vec3 exitNormal;
};

FN Chord missedChord() {
  Chord c;
  c.hit = false;
  c.entry = vec3(real(0), real(0), real(0));
  c.exit = c.entry;
  c.entryNormal = c.entry;
  c.exitNormal = c.entry;
  return c;
}

// point: of the ray, relative to the sphere's centre; direction: unit. Tangent rays hit.
FN Chord sphereChord(vec3 point, vec3 direction, real radius) {
  PRECISE vec3 nearly = point - dot(point, direction) * direction;
  PRECISE vec3 nearest =
      nearly - dot(nearly, direction) * direction;  // once more: point may be many radii away
  real discriminant = radius * radius - dot(nearest, nearest);
  if (!(discriminant >= real(0))) return missedChord();
  vec3 halfChord = sqrt(discriminant) * direction;
  Chord c;
  c.hit = true;
  c.entry = nearest - halfChord;
  c.exit = nearest + halfChord;
  c.entryNormal = c.entry / radius;
  c.exitNormal = c.exit / radius;
  return c;
}

// Solid cylinder |along axis| <= halfLength, distance from the axis <= radius. axis: unit; any ray point.
FN Chord cylinderChord(vec3 point, vec3 direction, vec3 axis, real halfLength, real radius) {
  // In the plane perpendicular to the axis the ray is a line (or a point); `moment` is perpendicular to both.
  vec3 moment = cross(direction, axis);
  real slope2 = dot(moment, moment);  // sin^2 of the angle between ray and axis
  real along = dot(direction, axis);
  real height = dot(point, axis);
  vec3 aside = point - height * axis;

  real sideIn;
  real sideOut;
  if (slope2 > real(PARALLEL_LIMIT)) {
    vec3 crossing = direction - along * axis;
    real middle = -dot(aside, crossing) / slope2;
    real offset = dot(aside, moment);
    real discriminant = radius * radius - offset * offset / slope2;
    if (!(discriminant >= real(0))) return missedChord();
    real halfWidth = sqrt(discriminant / slope2);
    sideIn = middle - halfWidth;
    sideOut = middle + halfWidth;
  } else {
    if (!(dot(aside, aside) <= radius * radius)) return missedChord();
    sideIn = real(-LARGEST);
    sideOut = real(LARGEST);
  }

  if (!(halfLength >= real(0))) return missedChord();
  real capIn = real(-LARGEST);
  real capOut = real(LARGEST);
  if (abs(along) > real(PARALLEL_LIMIT)) {
    real sign_ = along > real(0) ? real(1) : real(-1);
    capIn = (-height - sign_ * halfLength) / along;
    capOut = (-height + sign_ * halfLength) / along;
  } else if (!(abs(height) <= halfLength)) {
    return missedChord();
  }

  real tIn = max(sideIn, capIn);
  real tOut = min(sideOut, capOut);
  if (!(tIn <= tOut)) return missedChord();
  Chord c;
  c.hit = true;
  c.entry = point + tIn * direction;
  c.exit = point + tOut * direction;
  vec3 capNormal = along > real(0) ? axis : -axis;
  c.entryNormal = capIn > sideIn ? -capNormal : (c.entry - dot(c.entry, axis) * axis) / radius;
  c.exitNormal = capOut < sideOut ? capNormal : (c.exit - dot(c.exit, axis) * axis) / radius;
  return c;
}

// Ellipsoid with perpendicular unit axes u, v, w of half lengths radii: the ray in the space where it is the
// unit sphere, found there by its closest approach, and taken back. An error of a rounding of the longest
// semi-axis in `point` is all that reaches the result, however thin the needle.
FN Chord ellipsoidChord(vec3 point, vec3 direction, vec3 u, vec3 v, vec3 w, vec3 radii) {
  real shortest = min(radii.x, min(radii.y, radii.z));
  vec3 shares = vec3(shortest / radii.x, shortest / radii.y, shortest / radii.z);  // at most 1
  vec3 from = vec3(dot(point, u) / radii.x, dot(point, v) / radii.y, dot(point, w) / radii.z);
  vec3 along = vec3(dot(direction, u) * shares.x, dot(direction, v) * shares.y, dot(direction, w) * shares.z);
  Chord unit = sphereChord(from, normalize(along), real(1));
  if (!unit.hit) return unit;
  Chord c;
  c.hit = true;
  c.entry = (unit.entry.x * radii.x) * u + (unit.entry.y * radii.y) * v + (unit.entry.z * radii.z) * w;
  c.exit = (unit.exit.x * radii.x) * u + (unit.exit.y * radii.y) * v + (unit.exit.z * radii.z) * w;
  // The inverse transpose maps normals.
  c.entryNormal = normalize((unit.entry.x * shares.x) * u + (unit.entry.y * shares.y) * v +
                            (unit.entry.z * shares.z) * w);
  c.exitNormal =
      normalize((unit.exit.x * shares.x) * u + (unit.exit.y * shares.y) * v + (unit.exit.z * shares.z) * w);
  return c;
}

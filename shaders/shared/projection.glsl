// From a primitive's centre to the pixel grid and back to a ray *relative to that centre*, without
// cancellation. Needs double_float.glsl and view_block.glsl.
//
// The textbook ray/sphere test subtracts numbers of the size of the camera distance and loses the sphere in
// their rounding. Here the centre's pixel coordinates are known to about 48 bits, so the ray through a pixel
// passes the centre at (pixel - projected centre) * (size of a pixel at that depth): small, and right to
// float32's relative precision at any distance (MATH: docs/methods.md, "Quadrics").

struct ProjectedCenter {
  vec3 view;     // view-space position, rounded
  real depth;    // distance in front of the eye plane, rounded; 1 for orthographic views
  Split pixelX;  // projected pixel coordinates; meaningless where depth is not positive
  Split pixelY;
};

FN bool isPerspective(ViewBlock view) {
  return view.scale.z > real(0.5);
}

// row . c + translation, where cHi has at most 12 significant bits per component, as rowHi has: their
// products are exact.
FN Split dotRow(vec4 rowHi, vec4 rowLo, vec3 cHi, vec3 cLo) {
  Split xy = twoSum(rowHi.x * cHi.x, rowHi.y * cHi.y);
  Split xyz = twoSum(xy.hi, rowHi.z * cHi.z);
  Split all_ = twoSum(xyz.hi, rowHi.w);
  PRECISE real cross1 = rowHi.x * cLo.x + rowHi.y * cLo.y + rowHi.z * cLo.z;
  PRECISE real cross2 = rowLo.x * (cHi.x + cLo.x) + rowLo.y * (cHi.y + cLo.y) + rowLo.z * (cHi.z + cLo.z);
  PRECISE real rest = (cross1 + cross2) + ((xy.lo + xyz.lo) + (all_.lo + rowLo.w));
  return twoSum(all_.hi, rest);
}

// a / b, not normalized; b.hi must not be 0.
FN Split quotient(Split a, Split b) {
  PRECISE real q = a.hi / b.hi;
  Split product = twoProduct(q, b.hi);
  PRECISE real rest = ((a.hi - product.hi) - product.lo) + (a.lo - q * b.lo);
  return makeSplit(q, rest / b.hi);
}

// Distance of the eye plane from a point of view-space height z.
FN Split depthOf(ViewBlock view, Split z) {
  Split depth = twoSum(view.depth.x, -z.hi);
  PRECISE real rest = depth.lo + (view.depth.y - z.lo);
  return twoSum(depth.hi, rest);
}

// View-space position of cHi + cLo, given relative to the primitives' origin; x and y in pixels (at unit
// depth).
struct RowProducts {
  Split x;
  Split y;
  Split z;
};

FN RowProducts transformPoint(ViewBlock view, vec3 cHi, vec3 cLo) {
  vec3 upper = vec3(upperHalf(cHi.x), upperHalf(cHi.y), upperHalf(cHi.z));
  PRECISE vec3 lower = (cHi - upper) + cLo;
  RowProducts p;
  p.x = dotRow(view.xRowHi, view.xRowLo, upper, lower);
  p.y = dotRow(view.yRowHi, view.yRowLo, upper, lower);
  p.z = dotRow(view.zRowHi, view.zRowLo, upper, lower);
  return p;
}

// Projects the point cHi + cLo, given relative to the primitives' origin.
FN ProjectedCenter projectCenter(ViewBlock view, vec3 cHi, vec3 cLo) {
  RowProducts p = transformPoint(view, cHi, cLo);
  ProjectedCenter c;
  c.view = vec3((p.x.hi + p.x.lo) * view.scale.x, (p.y.hi + p.y.lo) * view.scale.x, p.z.hi + p.z.lo);
  c.depth = real(1);
  if (isPerspective(view)) {
    Split depth = depthOf(view, p.z);
    c.depth = depth.hi + depth.lo;
    if (!(depth.hi > real(0))) depth = makeSplit(real(1), real(0));
    p.x = quotient(p.x, depth);
    p.y = quotient(p.y, depth);
  }
  c.pixelX = twoSum(p.x.hi, view.center.x);
  c.pixelY = twoSum(p.y.hi, view.center.y);
  PRECISE real restX = c.pixelX.lo + (p.x.lo + view.center.z);
  PRECISE real restY = c.pixelY.lo + (p.y.lo + view.center.w);
  c.pixelX.lo = restX;
  c.pixelY.lo = restY;
  return c;
}

// Perspective: distance from the eye. Orthographic: distance behind the near plane.
FN Split centerRange(ViewBlock view, vec3 cHi, vec3 cLo) {
  RowProducts p = transformPoint(view, cHi, cLo);
  if (!isPerspective(view)) {
    return addSplit(makeSplit(view.depth.z, view.depthMap.y), negateSplit(p.z));
  }
  Split perPixel = makeSplit(view.scale.x, view.scale.y);
  Split x = multiplySplit(p.x, perPixel);
  Split y = multiplySplit(p.y, perPixel);
  Split depth = depthOf(view, p.z);
  return sqrtSplit(addSplit(addSplit(multiplySplit(x, x), multiplySplit(y, y)), multiplySplit(depth, depth)));
}

// A direction in view space.
FN vec3 turn(ViewBlock view, vec3 v) {
  return vec3((dot(vec3(view.xRowHi.x, view.xRowHi.y, view.xRowHi.z), v) +
               dot(vec3(view.xRowLo.x, view.xRowLo.y, view.xRowLo.z), v)) *
                  view.scale.x,
              (dot(vec3(view.yRowHi.x, view.yRowHi.y, view.yRowHi.z), v) +
               dot(vec3(view.yRowLo.x, view.yRowLo.y, view.yRowLo.z), v)) *
                  view.scale.x,
              dot(vec3(view.zRowHi.x, view.zRowHi.y, view.zRowHi.z), v) +
                  dot(vec3(view.zRowLo.x, view.zRowLo.y, view.zRowLo.z), v));
}

// Unit direction of the ray through a pixel.
FN vec3 rayDirection(ViewBlock view, vec2 pixel) {
  if (!isPerspective(view)) return vec3(real(0), real(0), real(-1));
  return normalize(
      vec3((pixel.x - view.center.x) * view.scale.x, (pixel.y - view.center.y) * view.scale.x, real(-1)));
}

// Whether a ray is better taken from the eye than from the plane of the primitive's centre: close by, or
// behind.
FN bool nearEye(ViewBlock view, real depth, real radius) {
  return isPerspective(view) && depth < real(2) * radius;
}

// A point of the ray through `pixel`, relative to the primitive's centre; for nearEye() it is the eye itself.
FN vec3 rayPoint(ViewBlock view, vec2 pixel, vec2 pixelHi, vec2 pixelLo, vec3 centerView, real depth,
                 bool fromEye) {
  if (fromEye) return vec3(-centerView.x, -centerView.y, view.depth.x - centerView.z);
  real perPixel = depth * view.scale.x;
  PRECISE real x = (pixel.x - pixelHi.x) - pixelLo.x;
  PRECISE real y = (pixel.y - pixelHi.y) - pixelLo.y;
  return vec3(perPixel * x, perPixel * y, real(0));
}

// Value for a reversed-z depth buffer of a point at view-space z: 1 on the near plane, 0 on the far plane.
FN real depthValue(ViewBlock view, real z) {
  real aboveFar = (z - view.depth.w) * view.depthMap.x;
  if (isPerspective(view)) return aboveFar / (view.depth.x - z);
  return aboveFar;
}

// View-space point of a pixel whose depth buffer holds `value` (> 0): the inverse of depthValue.
FN vec3 viewPoint(ViewBlock view, vec2 pixel, real value) {
  real factor = view.depthMap.x;
  real x = (pixel.x - view.center.x) * view.scale.x;
  real y = (pixel.y - view.center.y) * view.scale.x;
  if (!isPerspective(view)) return vec3(x, y, view.depth.w + value / factor);
  real toFar = view.depth.x - view.depth.w;
  real depth = toFar * factor / (value + factor);
  return vec3(x * depth, y * depth, view.depth.w + value * toFar / (value + factor));
}

// Distance along the unit ray from its origin to a point `hit` relative to the centre, rounded once.
FN real rayDistance(ViewBlock view, vec3 centerView, Split range, vec3 hit) {
  PRECISE real below = range.hi + (range.lo - hit.z);
  if (!isPerspective(view)) return below;
  vec3 fromEye = vec3(centerView.x, centerView.y, centerView.z - view.depth.x);
  real squares = real(2) * dot(fromEye, hit) + dot(hit, hit);  // |fromEye + hit|^2 - |fromEye|^2
  real total = length(fromEye + hit) + range.hi;
  real further = total > real(0) ? squares / total : real(0);
  PRECISE real distance = range.hi + (range.lo + further);
  return distance;
}

// Bounds of a projected quadric along one screen direction, relative to its projected centre, as slopes
// (multiply by 1 / pixel size): the two planes through the eye that touch it, Sigg et al. 2006 eq. (4) and
// (5) with the unknown measured from the projected centre instead of from 0, which removes the cancellation
// between the two roots.
struct Extent {
  real low;
  real high;
  bool bounded;  // false: it meets the eye plane
};

// A plane of normal n touches a quadric M (columns: its semi-axes) where its distance from the centre is
// |transpose(M) n|. G = M transpose(M) / radius^2; with n = (1, 0, slope of the centre) and e = (0, 0, 1),
// g0 = nGn, g1 = nGe, g2 = eGe. Orthographic: half the width is radius * sqrt(g0).
FN Extent tangentExtent(ViewBlock view, real depth, real radius, real g0, real g1, real g2) {
  Extent e;
  if (!isPerspective(view)) {
    real half_ = radius * sqrt(max(g0, real(0)));
    e.low = -half_;
    e.high = half_;
    e.bounded = true;
    return e;
  }
  real r2 = radius * radius;
  real a = depth * depth - r2 * g2;
  e.bounded = depth > real(0) && a > real(1e-4) * depth * depth;
  if (!e.bounded) {
    e.low = real(0);
    e.high = real(0);
    return e;
  }
  // (depth^2 - r^2 g2) b^2 - 2 r^2 g1 b - r^2 g0 = 0
  real middle = r2 * g1 / a;
  real half_ = radius * sqrt(max(r2 * g1 * g1 + a * g0, real(0))) / a;
  e.low = middle - half_;
  e.high = middle + half_;
  return e;
}

// Of a disc or sphere along screen direction (cosA, sinA): (position, axis) in view space turned so that x is
// that direction; axis is the disc's unit normal, or zero for a sphere.
FN Extent projectedExtent(ViewBlock view, real slope, real depth, real radius, real axisX, real axisZ) {
  real s = isPerspective(view) ? slope : real(0);
  // z points towards the viewer, depth away from it: the plane x = b * depth has the normal (1, 0, b).
  real g0n = axisX + s * axisZ;
  real g0 = real(1) + s * s - g0n * g0n;
  real g1 = s - g0n * axisZ;
  real g2 = real(1) - axisZ * axisZ;
  return tangentExtent(view, depth, radius, g0, g1, g2);
}

// The same of an ellipsoid with perpendicular semi-axes: their components along the screen direction and
// along z, as shares of `radius`, the longest.
FN Extent ellipsoidExtent(ViewBlock view, real slope, real depth, real radius, vec3 axesX, vec3 axesZ) {
  real s = isPerspective(view) ? slope : real(0);
  vec3 n = axesX + s * axesZ;
  return tangentExtent(view, depth, radius, dot(n, n), dot(n, axesZ), dot(axesZ, axesZ));
}

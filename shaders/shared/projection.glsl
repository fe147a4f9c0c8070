// From a primitive's centre to the pixel grid and back to a ray *relative to that centre*, without cancellation.
// Needs double_float.glsl and view_block.glsl.
//
// The textbook ray/sphere test subtracts numbers of the size of the camera distance and loses the sphere in their
// rounding. Here the centre's pixel coordinates are known to about 48 bits, so the ray through a pixel passes the
// centre at (pixel - projected centre) * (size of a pixel at that depth): small, and right to float32's relative
// precision at any distance (MATH: docs/methods.md, "Quadrics").

struct ProjectedCenter {
  vec3 view;      // view-space position, rounded
  real depth;     // distance in front of the eye plane, rounded; 1 for orthographic views
  Split pixelX;   // projected pixel coordinates; meaningless where depth is not positive
  Split pixelY;
  Split range;    // perspective: distance from the eye; orthographic: distance behind the near plane
};

FN Split dotRow(vec4 rowHi, vec4 rowLo, vec3 cHi, vec3 cLo) {
  Split s = addSplit(twoProduct(rowHi.x, cHi.x), twoProduct(rowHi.y, cHi.y));
  s = addSplit(s, twoProduct(rowHi.z, cHi.z));
  PRECISE real small = (rowLo.x * cHi.x + rowLo.y * cHi.y + rowLo.z * cHi.z) +
                       (rowHi.x * cLo.x + rowHi.y * cLo.y + rowHi.z * cLo.z);
  s = addSplit(s, makeSplit(rowHi.w, rowLo.w));
  return addSplit(s, makeSplit(small, real(0)));
}

// Projects the point cHi + cLo, given relative to the primitives' origin.
FN ProjectedCenter projectCenter(ViewBlock view, vec3 cHi, vec3 cLo) {
  Split x = dotRow(view.xRowHi, view.xRowLo, cHi, cLo);
  Split y = dotRow(view.yRowHi, view.yRowLo, cHi, cLo);
  Split z = dotRow(view.zRowHi, view.zRowLo, cHi, cLo);
  Split perPixel = makeSplit(view.scale.y, view.scale.z);

  ProjectedCenter c;
  c.view = vec3(x.hi, y.hi, z.hi);
  c.depth = real(1);
  Split slopeX = x;
  Split slopeY = y;
  if (view.scale.w > real(0.5)) {
    Split depth = addSplit(makeSplit(view.depth.x, view.depth.y), negateSplit(z));
    c.depth = depth.hi;
    c.range = sqrtSplit(addSplit(addSplit(multiplySplit(x, x), multiplySplit(y, y)), multiplySplit(depth, depth)));
    if (depth.hi <= real(0)) depth = makeSplit(real(1), real(0));
    slopeX = divideSplit(x, depth);
    slopeY = divideSplit(y, depth);
  } else {
    c.range = addSplit(makeSplit(view.depth.z, view.depthMap.y), negateSplit(z));
  }
  c.pixelX = addSplit(multiplySplit(slopeX, perPixel), makeSplit(view.center.x, view.center.z));
  c.pixelY = addSplit(multiplySplit(slopeY, perPixel), makeSplit(view.center.y, view.center.w));
  return c;
}

// Unit direction of the ray through a pixel.
FN vec3 rayDirection(ViewBlock view, vec2 pixel) {
  if (view.scale.w < real(0.5)) return vec3(real(0), real(0), real(-1));
  return normalize(vec3((pixel.x - view.center.x) * view.scale.x, (pixel.y - view.center.y) * view.scale.x, real(-1)));
}

// Whether a ray is better taken from the eye than from the plane of the primitive's centre: close by, or behind.
FN bool nearEye(ViewBlock view, real depth, real radius) {
  return view.scale.w > real(0.5) && depth < real(2) * radius;
}

// A point of the ray through `pixel`, relative to the primitive's centre; for nearEye() it is the eye itself.
FN vec3 rayPoint(ViewBlock view, vec2 pixel, vec2 pixelHi, vec2 pixelLo, vec3 centerView, real depth, bool fromEye) {
  if (fromEye) return vec3(-centerView.x, -centerView.y, view.depth.x - centerView.z);
  real perPixel = depth * view.scale.x;
  return vec3(perPixel * ((pixel.x - pixelHi.x) - pixelLo.x), perPixel * ((pixel.y - pixelHi.y) - pixelLo.y), real(0));
}

// Value for a reversed-z depth buffer of a point at view-space z: 1 on the near plane, 0 on the far plane.
FN real depthValue(ViewBlock view, real z) {
  real aboveFar = (z - view.depth.w) * view.depthMap.x;
  if (view.scale.w > real(0.5)) return aboveFar / (view.depth.x - z);
  return aboveFar;
}

// Distance along the unit ray from its origin to a point `hit` relative to the centre, rounded once.
FN real rayDistance(ViewBlock view, vec3 centerView, Split range, vec3 hit) {
  if (view.scale.w < real(0.5)) return range.hi + (range.lo - hit.z);
  vec3 fromEye = vec3(centerView.x, centerView.y, centerView.z - view.depth.x);
  real squares = real(2) * dot(fromEye, hit) + dot(hit, hit);  // |fromEye + hit|^2 - |fromEye|^2
  real total = length(fromEye + hit) + range.hi;
  return range.hi + (range.lo + (total > real(0) ? squares / total : real(0)));
}

// Bounds of a projected disc or sphere along screen direction (cosA, sinA), relative to its projected centre, as
// slopes (multiply by 1 / pixel size). (position, axis) in view space turned so that x is that direction; axis is the
// disc's unit normal, or zero for a sphere.
//
// The two planes through the eye that touch the quadric, Sigg et al. 2006 eq. (4) and (5) with the unknown measured
// from the projected centre instead of from 0, which removes the cancellation between the two roots.
struct Extent {
  real low;
  real high;
  bool bounded;  // false: it meets the eye plane
};

FN Extent projectedExtent(ViewBlock view, real slope, real depth, real radius, real axisX, real axisZ) {
  Extent e;
  real r2 = radius * radius;
  if (view.scale.w < real(0.5)) {
    real half_ = radius * sqrt(max(real(1) - axisX * axisX, real(0)));
    e.low = -half_;
    e.high = half_;
    e.bounded = true;
    return e;
  }
  // z points towards the viewer, depth away from it: the plane x = b * depth has the normal (1, 0, b).
  real g0n = axisX + slope * axisZ;
  real g0 = real(1) + slope * slope - g0n * g0n;
  real g1 = slope - g0n * axisZ;
  real g2 = real(1) - axisZ * axisZ;
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

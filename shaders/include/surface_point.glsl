// What a surface is like where it is met, for any way to meet it. Needs include/ball_ray.glsl and
// shared/metaball.glsl.

float kernelAt(float w) {
  if (uField.z > 1.5) return powerKernel(w, int(uField.y));
  return uField.z > 0.5 ? quarticKernel(w) : sexticKernel(w);
}

float kernelSlopeAt(float w) {
  if (uField.z > 1.5) return powerSlope(w, int(uField.y));
  return uField.z > 0.5 ? quarticSlope(w) : sexticSlope(w);
}

// What the balls around a point of the surface give it, one after the other.
struct FieldSurface {
  vec3 outward;  // -grad F
  vec3 squares;  // of their colours, weighted by what they add to the field
  float weight;
  float most;  // the largest of the weights
  uint color, id;
};

FieldSurface emptyFieldSurface() {
  FieldSurface s;
  s.outward = vec3(0.0);
  s.squares = vec3(0.0);
  s.weight = 0.0;
  s.most = 0.0;
  s.color = 0u;
  s.id = 0u;
  return s;
}

vec3 bytesOf(uint color) {
  return vec3(uvec3(color >> 16, color >> 8, color) & 255u);
}

// The share q f of one ball; its part of s.outward is the caller's.
void addShareToSurface(inout FieldSurface s, float share, uint color, uint id) {
  if (share > s.most || s.id == 0u || (share == s.most && id < s.id)) {
    s.color = color;
    s.id = id;
  }
  share = max(share, 0.0);
  s.most = max(s.most, share);
  s.weight += share;
  vec3 bytes = bytesOf(color);
  s.squares += share * bytes * bytes;
}

// Stored colours are blended by their squares: nearly linear light.
uint blendedColor(FieldSurface s) {
  if (!(s.weight > 0.0)) return s.color;
  uvec3 bytes = uvec3(min(sqrt(s.squares / s.weight), vec3(255.0)) + 0.5);
  return bytes.x << 16 | bytes.y << 8 | bytes.z;
}

// Unit, towards the viewer, whichever side of the surface the ray meets.
vec3 normalTowards(FieldSurface s, SceneRay ray, bool inner) {
  float largest = max(max(abs(s.outward.x), abs(s.outward.y)), abs(s.outward.z));
  if (!(largest > 0.0)) return -ray.direction;
  vec3 n = normalize(s.outward / largest) * (inner ? -1.0 : 1.0);
  float away = dot(n, ray.direction);
  return away > 0.0 ? normalize(n - away * ray.direction) : n;  // rounding, where the ray grazes
}

// From the eye (orthographic: from the near plane) to a place on the ray, rounded once.
float distanceAlong(SceneRay ray, Split place) {
  if (!isPerspective(uView)) {
    Split toPlane = addSplit(makeSplit(uView.depth.z, uView.depthMap.y), makeSplit(-uPlane.x, 0.0));
    Split total = addSplit(toPlane, place);
    return total.hi + total.lo;
  }
  Split perPixel = makeSplit(uView.scale.x, uView.scale.y);
  Split x = twoSum(ray.pixel.x - uView.center.x, -uView.center.z);
  Split y = twoSum(ray.pixel.y - uView.center.y, -uView.center.w);
  x = multiplySplit(x, perPixel);
  y = multiplySplit(y, perPixel);
  Split square = addSplit(addSplit(multiplySplit(x, x), multiplySplit(y, y)), makeSplit(1.0, 0.0));
  Split total = addSplit(multiplySplit(makeSplit(uPlane.y, uPlane.z), sqrtSplit(square)), place);
  return total.hi + total.lo;
}

// View-space z of a place on the ray.
float heightOf(SceneRay ray, Split place) {
  return uPlane.x - (place.hi + place.lo) / ray.stretch;
}

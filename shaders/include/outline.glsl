// Whether two points of the G-buffer lie on one continuous surface. Needs include/view.glsl,
// shared/octahedral.glsl.
//
// Not their difference in depth decides but how far each lies from the other's tangent plane. On a plane that
// is 0 however grazing the view. On a sphere or cylinder it is |PQ|^2 / 2R, which never exceeds the distance
// of the two rays, up to the limb: more than that is a step.

layout(binding = 0) uniform sampler2D tDepth;
layout(binding = 1) uniform sampler2D tNormal;

layout(std140, binding = 1) uniform SilhouetteUniforms {
  vec4 uStep;  // least step: x [pixels], y [Å]; z: what rounding can amount to [Å]; w: 1 if steps raise lines
  vec4 uCrease;  // x, y: sine and cosine of the least angle; z: width of a line [pixels]; w: how far its
                 // pixels are from the borders' pixels, at most
};

struct Surface {
  vec3 point;  // view space
  vec3 normal;
  float footprint;  // size of a pixel there [Å]
};

bool isInside(ivec2 at) {
  return all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, textureSize(tDepth, 0)));
}

// depth: what tDepth holds there, > 0.
Surface surfaceAt(ivec2 at, float depth) {
  Surface s;
  s.point = viewPoint(uView, vec2(at) + 0.5 + uView.tile.xy, depth);
  s.normal = decodeNormal(texelFetch(tNormal, at, 0).xy);
  s.footprint = uView.scale.x * (isPerspective(uView) ? uView.depth.x - s.point.z : 1.0);
  return s;
}

// Whether there is a step between surfaces that are seen `pixels` apart.
bool isApart(Surface a, Surface b, float pixels) {
  vec3 away = b.point - a.point;
  float gap = max(abs(dot(a.normal, away)), abs(dot(b.normal, away)));
  return gap > max(uStep.x * max(a.footprint, b.footprint) * pixels, uStep.y) + uStep.z;
}

// What the passes of depth-peeled Bezier clipping share (render/surface/bezier.cpp). Needs
// include/ball_ray.glsl.
//
// Places at which the ray enters or leaves a ball are whole numbers of steps: 30 bits over the depth of the
// field. Their bits, taken as a float between 0 and 1, are in the same order and go through the depth buffer
// unchanged; the least are left out, which would be denormal.

layout(std140, binding = 2) uniform BezierUniforms {
  vec4 uSteps;  // x: length of a step, a power of two; y: 1 / x; z: tolerance, as a share of a support; w: 0
  ivec4 uRegion;  // of the target: x, y of its corner; width, height
  ivec4 uList;    // x: most ids in a pixel's list; y: the layer after which pixels go on without one, as they
                  // do if it is too short, 0: neither; z: 2; w: 0
};

const int kMiddleStep = 0x20000000;
const int kFirstStep = 0x00800000;
const int kLastStep = 0x3F7FFFFF;
const uint kNoEvent = 0x3F800000u;   // a cleared depth buffer
const uint kFinished = 0xFFFFFFFFu;  // instead of a pixel's last event

uint stepAt(Split place, float further) {
  precise float steps = place.hi * uSteps.y;
  precise float whole = floor(steps);
  precise float rest = (steps - whole) + (place.lo + further) * uSteps.y;
  return uint(clamp(kMiddleStep + int(whole) + int(floor(rest + 0.5)), kFirstStep, kLastStep));
}

Split placeOf(uint step) {
  int n = int(step) - kMiddleStep;
  int upper = (n >> 12) << 12;
  return makeSplit(float(upper) * uSteps.x, float(n - upper) * uSteps.x);
}

// Where the ray begins: at the near plane.
uint firstStep(SceneRay ray) {
  float below = uPlane.x - uView.depth.z;
  Split plane = twoProduct(below, ray.stretch);
  return stepAt(plane, 0.0);
}

// The first step behind what the depth buffer holds.
uint hiddenFrom(SceneRay ray, float depth) {
  if (!(depth > 0.0)) return uint(kLastStep);
  float place = placeOfDepth(ray, depth);
  return stepAt(makeSplit(place, 0.0), slackOfDepth(place));
}

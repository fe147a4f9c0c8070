// From the bounds of a quadric to the corner of its quad. Needs include/view.glsl.

// A corner is this much further out than the exact bounds [pixels]: rasterizers snap to 1/256 pixel, and
// float32 positions on a poster of 65,000 pixels have steps of 1/128.
const float kPadding = 0.02;

const vec4 kNowhere = vec4(2.0, 2.0, 2.0, 1.0);  // all four corners there: nothing is drawn

vec2 cornerOf(int vertex) {
  return vec2(vertex & 1, vertex >> 1);
}

// Pixel coordinates in the target of a point `offset` pixels from the projected centre.
vec2 targetPixel(ProjectedCenter center, vec2 offset) {
  precise float x = (center.pixelX.hi - uView.tile.x) + (center.pixelX.lo + offset.x);
  precise float y = (center.pixelY.hi - uView.tile.y) + (center.pixelY.lo + offset.y);
  return vec2(x, y);
}

// frontZ: view-space z of the nearest point of the quadric. Rounding must neither clip the quad at the near
// plane nor put it behind its own fragments.
vec4 quadPosition(vec2 pixel, float frontZ) {
  float depth = depthValue(uView, min(frontZ, uView.depth.z)) * (1.0 + 1e-5);
  return vec4(pixel / uView.tile.zw * 2.0 - 1.0, min(depth, 1.0), 1.0);
}

// For quadrics that meet the eye plane, which no bounds hold.
vec4 wholeTarget(int vertex) {
  return vec4(cornerOf(vertex) * 2.0 - 1.0, 1.0, 1.0);
}

// Takes the visible end of a chord into the G-buffer. Needs include/view.glsl, shared/quadrics.glsl,
// include/gbuffer.glsl.

struct SurfacePoint {
  vec3 position;  // relative to the primitive's centre
  vec3 normal;    // towards the viewer
  float z;        // view space
};

// The chord's entry, or its exit seen from inside where the entry lies before the near plane; false if it has
// neither.
bool visibleEnd(Chord chord, float centerZ, out SurfacePoint s) {
  s.position = chord.entry;
  s.normal = chord.entryNormal;
  s.z = centerZ + chord.entry.z;
  if (s.z > uView.depth.z) {
    s.position = chord.exit;
    s.normal = -chord.exitNormal;
    s.z = centerZ + chord.exit.z;
  }
  return chord.hit && s.z <= uView.depth.z;
}

// The balls of a cell, by their nearest point, for pixels that keep no list. Needs include/bezier.glsl and
// field.glsl.

struct CellBall {
  uint ball;
  uint begins;  // no ray of the cell is in it before this step; behind a cell's last ball: more than any step
};
layout(std430, binding = 3) readonly restrict buffer CellBalls {
  CellBall uCellBalls[];
};

// Where the ray passes a ball.
struct Chord {
  BallRay ray;
  float radius2;
  uint enters, leaves;  // steps; leaves: 0 if it is not met
};

Chord chordOf(uint ball, SceneRay ray) {
  BallProjection projection = fetchProjection(tBalls, ball);
  Chord chord;
  chord.ray = ballOnRay(projection, ray);
  chord.radius2 = projection.place.y;
  bool met = chord.ray.halfChord2 > 0.0;
  float halfChord = met ? sqrt(chord.ray.halfChord2) : 0.0;
  chord.enters = stepAt(chord.ray.middle, -halfChord);
  chord.leaves = met ? stepAt(chord.ray.middle, halfChord) : 0u;
  return chord;
}

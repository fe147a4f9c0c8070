// What the surface is like at a place, from the balls of the pixel's list that reach there. Needs
// include/field.glsl, include/lists.glsl, include/lists_nodes.glsl.

// from: a node of the list, none of whose balls before it reaches there; moved on to the first that the ray
// has not left at the place.
FieldSurface surfaceAt(inout uint from, SceneRay ray, Split place) {
  FieldSurface s = emptyFieldSurface();
  float slant = slantOf(ray), until = place.hi + 1e-6 * abs(place.hi);
  uint nearest = nodeAt(from).x;
  float most = -1e30;
  bool passing = true;
  for (uint node = from; node != 0u;) {
    uvec2 n = nodeAt(node);
    if (firstPlace(n.x, slant) > until) break;
    Ball ball = fetchBall(n.x);
    BallRay b = ballOnRay(ball.projection, ray);
    float along = placeBetween(b.middle, place);
    float w = (b.halfChord2 - along * along) * ball.inverseR2;
    if (w > most && b.halfChord2 > 0.0) {  // lists of tiles have balls that the ray passes by
      most = w;
      nearest = n.x;
    }
    if (w > 0.0) {
      ball.color = uBalls[n.x].color;
      ball.id = uBalls[n.x].id;
      addToSurface(s, ball, ray, b, along);
    }
    node = n.y;
    passing = passing && along > 0.0 && w < 0.0 && node != 0u;
    if (passing) from = node;
  }
  if (s.id == 0u) addToSurface(s, uBalls[nearest], ray, place);  // rounding: its very end
  return s;
}

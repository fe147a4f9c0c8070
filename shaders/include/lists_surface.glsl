// What the surface is like at a place, from the balls of the pixel's list that reach there. Needs
// include/field.glsl, include/lists.glsl, include/lists_nodes.glsl.

FieldSurface surfaceAt(uint head, SceneRay ray, Split place) {
  FieldSurface s = emptyFieldSurface();
  float slant = slantOf(ray), until = place.hi + 1e-6 * abs(place.hi);
  uint nearest = uNodes[head - 1u].x;
  float most = -1e30;
  for (uint node = head; node != 0u;) {
    uvec2 n = uNodes[node - 1u];
    if (firstPlace(n.x, slant) > until) break;
    Ball ball = fetchBall(n.x);
    BallRay b = ballOnRay(ball.projection, ray);
    float along = placeBetween(b.middle, place);
    float w = (b.halfChord2 - along * along) * ball.inverseR2;
    if (w > most) {
      most = w;
      nearest = n.x;
    }
    if (w > 0.0) {
      ball.color = uBalls[n.x].color;
      ball.id = uBalls[n.x].id;
      addToSurface(s, ball, ray, b, along);
    }
    node = n.y;
  }
  if (s.id == 0u) addToSurface(s, uBalls[nearest], ray, place);  // rounding: its very end
  return s;
}

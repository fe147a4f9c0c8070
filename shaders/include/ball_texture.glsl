// Textures hold numbers of balls, or of other primitives, in rows of so many
// (render/surface/ball_texture.cpp, newton_field.cpp).
const uint kBallsPerRow = 1024u;

// The first texel of a ball that has `texels` of them.
ivec2 ballTexel(uint ball, uint texels) {
  return ivec2(texels * (ball % kBallsPerRow), ball / kBallsPerRow);
}

// Unit vectors as two numbers in [0, 1] (Cigolle et al., JCGT 3(2), 2014). 16-bit unsigned channels rather
// than signed ones: the latter need not be renderable in OpenGL 4.5.

FN real awayFromZero(real x) {
  return x >= real(0) ? real(1) : real(-1);
}

FN vec2 encodeNormal(vec3 n) {
  real sum = abs(n.x) + abs(n.y) + abs(n.z);
  real x = n.x / sum;
  real y = n.y / sum;
  if (n.z < real(0)) {
    real foldedX = (real(1) - abs(y)) * awayFromZero(x);
    y = (real(1) - abs(x)) * awayFromZero(y);
    x = foldedX;
  }
  return vec2(real(0.5) * x + real(0.5), real(0.5) * y + real(0.5));
}

FN vec3 decodeNormal(vec2 stored) {
  real x = real(2) * stored.x - real(1);
  real y = real(2) * stored.y - real(1);
  real z = real(1) - abs(x) - abs(y);
  real fold = max(-z, real(0));
  return normalize(vec3(x - awayFromZero(x) * fold, y - awayFromZero(y) * fold, z));
}

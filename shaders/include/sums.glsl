// What a method counts (render/surface/ray_counts.h). MORE_SUMS: members of what only this method counts.

const int kSums = 64;
struct Sums {
  uint pixels, pieces, iterations, mostIterations, overflow, grazing, unfinished, hits;
#ifdef MORE_SUMS
  MORE_SUMS
#endif
};
layout(std430, binding = 5) restrict buffer Statistics {
  Sums uSums[kSums];  // spread out, so that pixels seldom wait for each other
};

// Where a pixel counts.
int sumsOf(ivec2 texel) {
  return texel.x / 8 + 13 * (texel.y / 8) & (kSums - 1);
}

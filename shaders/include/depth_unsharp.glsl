// The grid of square blocks of pixels on which depth_unsharp blurs. It is fixed to the picture, not to the
// tile: a block's mean is the same in whatever tile it is taken.

const int kMostTaps = 20;
layout(std140, binding = 1) uniform DepthUnsharpUniforms {
  ivec4 uGrid;  // x, y: picture's pixel at the target's corner; z: side of a block [pixels]; w: taps
  vec4 uTaps[kMostTaps / 4];  // half a Gaussian, from its middle
};

ivec2 firstBlock() {
  return uGrid.xy / uGrid.z;
}

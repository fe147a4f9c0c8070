// What the two passes of ambient occlusion share (render/post/occlusion.h).

// Four at a time, each named by a constant: indexed by a variable, their numbers are fetched per pixel on
// llvmpipe, which takes longer than all else here.
struct Direction {
  vec4 rowX, rowY, rowZ;  // camera's view space -> texels, texels, height above the map's far plane [Å]
  ivec4 map;              // first texel, width, height, slabs
};
layout(std140, binding = 1) uniform OcclusionUniforms {
  ivec4 uPart;   // pixel of the target = x, y + z * place in the part; w: 0
  ivec4 uParts;  // x, y: size of a part; z, w: place of the target's corner in its block of 4 x 4 pixels
  vec4 uSlab;  // 1 / slab height; how far anything lies above its centre [Å]; z: y of uFade per unit of the
               // stored heights; w: such units per Å
  vec4 uFade;  // how much an occluder counts: x - y * distance; z: weight of a direction; w: rounding [Å]
  Direction uDirections[4];
};

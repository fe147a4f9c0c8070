// What a shader knows of a View (core/view.h): a uniform block of vec4 rows, the same bytes in std140 and in
// C++. Filled by render/view_block.cpp. Lengths in Å, pixels as in core/view.h.

struct ViewBlock {
  // A point C given relative to Primitives::origin lies at rotation * C + translation in view space. xyz = a
  // row of the rotation, w = that component of the translation; the x and y rows are divided by the pixel
  // size, so that they give pixels (at unit depth | as they are). Each number is the sum of Hi, of which xyz
  // have at most 12 significant bits, and Lo.
  vec4 xRowHi, yRowHi, zRowHi;
  vec4 xRowLo, yRowLo, zRowLo;
  vec4 scale;  // x + y: pixel size (at unit depth | in Å), hi and lo; z: 1 perspective, 0 orthographic; w: 0
  vec4 center;    // x, y: pixel of the optical axis, hi; z, w: lo
  vec4 depth;     // x + y: eye to pivot, hi and lo; z: nearZ; w: farZ
  vec4 depthMap;  // x: factor of the depth value (depthValue in projection.glsl); y: nearZ's lo; z, w: 0
  vec4 tile;  // x, y: pixel coordinates of this target's lower left corner (with the sample's shift); z, w:
              // its size
};

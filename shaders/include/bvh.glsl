// The tree of the method "bvh" (render/surface/bvh.cpp) and what its passes share. Needs
// include/ball_ray.glsl.

layout(std140, binding = 2) uniform BvhUniforms {
  vec4 uTurn[3];  // rows of the rotation from model to view axes
  vec4 uBase;     // xyz: in model axes, where the optical axis meets the plane of uPlane; w: 0
  vec4 uSearch;   // x: width that roots are narrowed down to, as a share of the smallest support; y, z, w: 0
  // x, y: the target's pixel of this region's corner; z: 1 if a ray may begin inside; w: 2
  ivec4 uRegion;
};

// By number: two texels a node. Lower corner of its box, what is first; upper corner, how many. Of an inner
// node that is its first child, which the second follows, and kInner; of a leaf, of the members.
layout(binding = 6) uniform usampler2D tNodes;
layout(binding = 7) uniform usampler2D tMembers;
const uint kInner = 0xFFFFFFFFu;
const uint kMembersPerRow = 4096u;

struct Node {
  vec3 low, high;
  uint first, count;
};

Node fetchNode(uint index) {
  ivec2 at = ballTexel(index, 2u);
  uvec4 a = texelFetch(tNodes, at, 0), b = texelFetch(tNodes, at + ivec2(1, 0), 0);
  return Node(uintBitsToFloat(a.xyz), uintBitsToFloat(b.xyz), a.w, b.w);
}

uint memberAt(uint index) {
  return texelFetch(tMembers, ivec2(index % kMembersPerRow, index / kMembersPerRow), 0).x;
}

// What became of a pixel.
const uint kHit = 1u;
const uint kInsideOut = 2u;   // the hit is the surface's inner wall
const uint kUnanswered = 4u;  // left to the processor

// The lists: nodes that each name a ball and the next node. Needs include/lists.glsl.

#ifndef LIST_ACCESS
#define LIST_ACCESS
#endif
layout(std430, binding = 1) restrict LIST_ACCESS buffer Nodes {
  uvec2 uNodes[];  // ball; index of the next node plus 1, 0 = none
};
layout(std430, binding = 2) restrict LIST_ACCESS buffer Heads {
  uint uHeads[];  // of each pixel of the region
};

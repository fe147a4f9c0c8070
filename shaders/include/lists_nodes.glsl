// The lists: nodes that each name a ball and the next node. Needs include/lists.glsl. Flag: TILES, the lists
// are those of the tiles of a grid, made by the processor.

#ifndef LIST_ACCESS
#define LIST_ACCESS
#endif
#ifdef TILES
#include "include/tile_lists.glsl"

const uint kLastOfTile = 0x80000000u;  // in an entry, which is a ball; nodes are entries, counted from 1

// 0: the tile shows nothing.
uint nodeOfTile(ivec2 targetTexel) {
  uvec2 list = listOfTile(uGrid, targetTexel);
  return list.y > 0u ? list.x + 1u : 0u;
}

// Ball; the next node, 0 = none.
uvec2 nodeAt(uint node) {
  uint entry = uEntries[node - 1u];
  return uvec2(entry & ~kLastOfTile, (entry & kLastOfTile) != 0u ? 0u : node + 1u);
}
#else
layout(std430, binding = 1) restrict LIST_ACCESS buffer Nodes {
  uvec2 uNodes[];  // ball; index of the next node plus 1, 0 = none
};

uvec2 nodeAt(uint node) {
  return uNodes[node - 1u];
}
#endif
layout(std430, binding = 2) restrict LIST_ACCESS buffer Heads {
  uint uHeads[];  // of each pixel of the region
};

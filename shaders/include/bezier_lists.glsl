// The lists of ball indices that pixels keep, and what else they remember from layer to layer. Needs
// include/bezier.glsl. Slot by slot, so that neighbours read neighbouring words.

#ifndef LIST_ACCESS
#define LIST_ACCESS
#endif
layout(std430, binding = 1) restrict LIST_ACCESS buffer Lists {
  uint uLists[];
};

const int kStatus = 0;  // kHit, kInside, ... and the number of ids
const int kPlace = 1;   // of a hit: the step before it; until then, how many events there were
const int kOffset = 2;  // and the distance from there
const int kEffort = 3;  // pieces << 16 | iterations
const int kSolved = 4;  // most iterations of one piece << 16 | pieces that took any
const int kIds = 5;

const uint kHit = 0x80000000u;
const uint kInside = 0x40000000u;   // F > 0 where the ray begins
const uint kOutside = 0x20000000u;  // F <= 0 there; neither: not known yet
const uint kGrazing = 0x10000000u;
const uint kUnfinished = 0x08000000u;
const uint kSpilled = 0x04000000u;  // the list was too short
const uint kCount = 0x00FFFFFFu;

// Of the calling pixel.
int slot(ivec2 texel, int which) {
  return which * (uRegion.z * uRegion.w) + texel.y * uRegion.z + texel.x;
}

// The lists of ball indices that pixels keep, and what else they remember from draw to draw. Needs
// include/bezier.glsl. Slot by slot, so that neighbours read neighbouring words.

#ifndef LIST_ACCESS
#define LIST_ACCESS
#endif
layout(std430, binding = 1) restrict LIST_ACCESS buffer Lists {
  uint uLists[];
};

const int kStatus = 0;  // kHit, kInside, ... and the number of ids
const int kPlace = 1;   // of a hit: the step before it; of a pixel without a list: where it is; else, how
                        // many events there were
const int kOffset = 2;  // of a hit: the distance from that step
const int kReach = 2;   // of a pixel without a list: how many steps it tries to take at once; 0: not known
const int kEffort = 3;  // pieces << 16 | iterations
const int kSolved = 4;  // most iterations of one piece << 16 | pieces that took any
const int kIds = 5;
const int kFrom = 5;  // of a pixel without a list: the first of its cell's balls that it has not passed

const uint kHit = 0x80000000u;
const uint kInside = 0x40000000u;   // F > 0 where the ray begins
const uint kOutside = 0x20000000u;  // F <= 0 there; neither: not known yet
const uint kGrazing = 0x10000000u;
const uint kUnfinished = 0x08000000u;
const uint kWalks = 0x04000000u;    // it keeps no list any more (bezier_walk.frag)
const uint kWalked = 0x02000000u;   // and is finished
const uint kCareful = 0x01000000u;  // it goes one step at a time
const uint kCount = 0x00FFFFFFu;

// Of the calling pixel.
int slot(ivec2 texel, int which) {
  return which * (uRegion.z * uRegion.w) + texel.y * uRegion.z + texel.x;
}

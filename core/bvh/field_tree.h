#pragma once
// Trees over the metaballs of a field, for rays from anywhere. O. Gourmel, A. Pajot, M. Paulin, L. Barthe,
// P. Poulin, Fitted BVH for Fast Raytracing of Metaballs, Computer Graphics Forum 29(2), 2010,
// doi 10.1111/j.1467-8659.2009.01597.x.
//
// A leaf of a fitted tree is a cell of space: cells do not overlap but by rounding, the field within one is
// that of its members alone, and wherever F >= 0 there is a cell. Departures from the paper: r_max (§5.3.1)
// is taken of each ball's own support, since where F >= 0 one of n balls has at least an n-th of the level;
// a ball is discarded (§5.3.2) if its r_max sphere misses the cell and its support those r_max spheres that
// do not, which is all that can matter there, and only in nodes of at most kMostToDiscardFrom members: the
// test compares pairs. Split metaballs of the other tree are found as in Algorithm 1, but against the child's
// box on the way down and ball by ball in leaves only, or it would be quadratic.

#include "core/bvh/box_tree.h"
#include "core/metaball_field.h"

namespace meniscus::bvh {

/// Pictures are drawn with fitted trees; the others are what the paper compares them with, and serve its
/// tables (docs/measured/bvh.md) and as a second opinion in tests.
enum class Structure : std::uint8_t {
  classical,  ///< each ball in one leaf, which does not know the others around
  split,      ///< the same; leaves have "split metaballs", too: all that overlap one of their own (§4)
  fitted      ///< §5
};

struct TreeSettings {
  Structure structure = Structure::fitted;
  LeafCost cost = LeafCost::square;
  // Of fitted trees:
  bool fit = true;      ///< cells are cut to what is in them (§5.1.2)
  bool tight = true;    ///< ... of which only r_max counts (§5.3.1)
  bool discard = true;  ///< members that contribute nothing are dropped (§5.3.2)
};

inline constexpr std::size_t kMostToDiscardFrom = 64;

/// As a share of the field's extent: how far outside of a cell the field is still that of its members. Nodes'
/// boxes are grown by half of it, which is more than rounding moves float32 coordinates, and rays in float32
/// whose coordinates are not much larger than the field's. The shader's, which begin on the view's axis, are
/// if that passes the field at more than about ten of its extents (half of the slack is then three
/// roundings): a ray may miss the rim of a cell.
inline constexpr float kSlack = 4e-6f;

struct FieldTree : Tree {
  TreeSettings settings;
  float slack = 0;  ///< [Å]
};

/// Takes balls that are valid (requireValid()). The same whatever the number of threads.
FieldTree buildFieldTree(const MetaballField& field, const TreeSettings& settings = {});

/// The largest |coordinate| + support.
float extentOf(const MetaballField& field);

}  // namespace meniscus::bvh

#pragma once
// Scenes like those of Gourmel et al. 2010, Figure 8, of which the paper gives the numbers of balls and
// pictures: made from a seed, kernel w^2.

#include <memory>
#include <string>

#include "core/primitives.h"
#include "core/view.h"

namespace meniscus::bench {

struct BvhScene {
  std::string name;
  std::shared_ptr<const Primitives> primitives;
  View view;  ///< 640 x 480, as the paper's
};

/// Spread evenly in a cube; a point lies in 0.5 supports on average.
BvhScene scattered(std::size_t balls);
/// A funnel of turning balls, denser below; a point within lies in about 30 supports.
BvhScene tornado(std::size_t balls);
/// The first atoms of hemoglobin, side by side, as their van der Waals surface: supports twice the radius.
BvhScene moleculeOf(std::size_t atoms);
/// A tank of water: a point below its waves lies in about 60 supports.
BvhScene pool(std::size_t balls);

}  // namespace meniscus::bench

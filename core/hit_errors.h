#pragma once
// How far a picture's hits are from the truth.

#include <cstddef>

#include "core/hit_image.h"
#include "core/reference_tracer.h"

namespace meniscus {

struct HitErrors {
  std::size_t pixels = 0;     ///< of the picture
  std::size_t missed = 0;     ///< not grazing: the truth has a hit, the image none
  std::size_t falseHits = 0;  ///< not grazing: the image has a hit, the truth none
  std::size_t grazing = 0;    ///< pixels that the truth marks so; below, they count in grazingDisputes only
  std::size_t grazingDisputes = 0;  ///< of those, hit in one and not in the other
  std::size_t compared = 0;         ///< both hit, not grazing: what the rest is about

  double relativeRms = 0;  ///< sqrt(mean(((t - t0) / t0)^2)), of pixels with t0 > 0 (Kanamori et al. 2008)
  double distanceP99 = 0;  ///< 99 % of |t - t0| are at most this [Å]
  double largestDistance = 0;   ///< largest |t - t0| [Å]; infinite if a hit's distance is not a number
  double normalRmsDeg = 0;      ///< angle between the normals; 0 if the image has none
  double largestNormalDeg = 0;  ///<
  std::size_t idsDiffer = 0;    ///< 0 if the image has none. Where two shares are equal, rounding decides.
};

/// A pixel of `image` is a hit if its distance is not +infinity. Sizes must be the same.
HitErrors compareHits(const HitImage& image, const ReferenceImage& truth);

}  // namespace meniscus

#pragma once
// How much of a picture is drawn while it moves, so that a frame takes no longer than its budget: fewer
// pixels, one ray for each, and then the dearest effects left out, one after the other. Chosen by the time
// that frames take, which is why none of it needs to know the machine.

#include <limits>
#include <string>
#include <vector>

#include "app/render_options.h"

namespace meniscus {

struct MovingQuality {
  double scale = 0.5;  ///< of the picture's sides
  int cuts = 0;        ///< how many of the effects are left out
};

/// What can be left out of a picture of these options, the dearest first, in words; the first `most`.
std::vector<std::string> possibleCuts(RenderOptions options, int most = std::numeric_limits<int>::max());

/// The options of a frame of a moving picture: one ray per pixel, of `quality`.
RenderOptions reduced(RenderOptions options, const MovingQuality& quality);

/// Sizes are steps of a fourth of an octave: each that was drawn once has its textures already.
class QualityGovernor {
 public:
  /// Begins anew with the least of everything, for a scene or settings whose cost is not known.
  void reset(int possibleCuts);
  const MovingQuality& quality() const { return quality_; }
  /// A frame of quality() took so long, and might have taken so long as the budget [ms].
  void measured(double milliseconds, double budget);

 private:
  void change(int level, int cuts);

  MovingQuality quality_;
  int level_ = 0;
  std::vector<bool> tooSlow_;  // by number of cuts: known to take longer than the budget
  bool isNew_ = true;          // no frame of this quality was drawn
  int frames_ = 0;             // of this quality, since it was last looked at
  double worst_ = 0;           // of these, as a share of the budget
};

}  // namespace meniscus

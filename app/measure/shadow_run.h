#pragma once
// Error against time of soft shadows' samples.

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "app/measure/output_folder.h"
#include "app/measure/sweep.h"
#include "app/progress.h"
#include "core/primitives.h"
#include "core/view.h"

namespace meniscus::measure {

struct ShadowPoint {
  int samples = 0, probes = 0;
  double rms = 0, largest = 0;  ///< of the share of light, over the pixels that face it
  /// Medians of the processor's time [ms]: of the shadow pass; of shadow map, G-buffer, shadow and shading.
  double passMs = 0, frameMs = 0;
  double samplesTaken = 0;   ///< by a pixel that faces the light, on average
  double penumbraShare = 0;  ///< of those pixels: neither wholly lit nor wholly dark
};

struct ShareError {
  double rms = 0, largest = 0;
};
/// Over the values that count.
ShareError compareShares(const std::vector<float>& values, const std::vector<float>& truth,
                         const std::vector<bool>& counts);

/// A point for each pair of samples and probes, interleaved after one warm-up, against 4,096 samples of the
/// same shadow map. Quadrics only; needs a current context.
std::vector<ShadowPoint> measureShadowPoints(const std::shared_ptr<const Primitives>& primitives,
                                             const View& view, double penumbra,
                                             const std::vector<std::pair<int, int>>& settings,
                                             int repetitions, const std::function<void(double)>& progress);

/// The sweep's shadows that are not there yet, into shadows.csv.
void measureShadows(const Sweep& sweep, const OutputFolder& folder, Progress& progress);

}  // namespace meniscus::measure

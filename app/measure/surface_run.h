#pragma once
// Measures the points of surface methods: interleaved, warmed up, compared with the truth.

#include "app/measure/points.h"
#include "app/progress.h"

namespace meniscus::measure {

/// All points that are not there yet. Needs a current context.
void measureSurfaces(const Sweep& sweep, const OutputFolder& folder, PointTables& tables, Progress& progress);

}  // namespace meniscus::measure

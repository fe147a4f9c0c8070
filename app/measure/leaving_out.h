#pragma once
// What scenes that need little cost: programs, passes, memory, times.

#include "app/measure/output_folder.h"
#include "app/measure/sweep.h"
#include "app/progress.h"

namespace meniscus::measure {

/// One row of leaving_out.csv for each kind of scene that is not there yet. Needs a current context.
void measureLeavingOut(const Sweep& sweep, const OutputFolder& folder, Progress& progress);

}  // namespace meniscus::measure

#pragma once
// The papers' tables of frame times, measured here, as ratios within a table.

#include "app/measure/output_folder.h"
#include "app/measure/sweep.h"
#include "app/progress.h"

namespace meniscus::measure {

/// The rows that are not there yet, into papers.csv. Needs a current context.
void measurePapers(const Sweep& sweep, const OutputFolder& folder, Progress& progress);

}  // namespace meniscus::measure

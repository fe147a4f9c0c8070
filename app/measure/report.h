#pragma once
// DIR/report.html: everything that was measured on one page, which needs no network.

#include "app/measure/output_folder.h"
#include "app/measure/sweep.h"

namespace meniscus::measure {

/// Writes it from the tables in the folder. Every figure names the line of the table that it is from.
void writeReport(const Sweep& sweep, const OutputFolder& folder);

}  // namespace meniscus::measure

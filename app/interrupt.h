#pragma once
// Ctrl-C in a run of many pictures: the first one lets the current picture be finished, the second one ends
// the process at once, as it always does elsewhere.

namespace meniscus {

/// Lets SIGINT wait from now on.
void deferInterrupt();

/// Whether SIGINT has come since.
bool interrupted();

/// Ends the process as SIGINT does, after the run has put its things in order.
[[noreturn]] void endByInterrupt();

}  // namespace meniscus

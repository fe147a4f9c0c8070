#pragma once
// Which vectors the casters use.

#include <string>
#include <vector>

namespace meniscus::tiles {

/// Compiled in and supported by this processor, widest first: "AVX3", "AVX2", "SSE4", "EMU128".
std::vector<std::string> instructionSets();
/// The one in use.
std::string instructionSet();
/// Uses one of instructionSets() from now on; an empty name chooses the widest again. For tests and
/// measurements.
void useInstructionSet(const std::string& name);

}  // namespace meniscus::tiles

#pragma once
// Counts a call's machine instructions where the processor's own counters are out of reach, as on most
// virtual machines: a child process runs it step by step.

#include <cstdint>
#include <functional>

namespace meniscus::bench {

/// Instructions of one call in this thread. Everything must run in it: no other thread may ever have been
/// begun (oneTBB: global_control). A step takes microseconds. Throws std::runtime_error where processes
/// cannot be traced.
std::uint64_t instructionsOf(const std::function<void()>& call);

}  // namespace meniscus::bench

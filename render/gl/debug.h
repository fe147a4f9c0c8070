#pragma once
// The driver's own opinion of what we do, for tests and for developers.

#include <string>
#include <vector>

namespace meniscus::gl {

/// If the environment variable MENISCUS_GL_DEBUG is set: collects the driver's messages of the current
/// context about errors, undefined and deprecated behaviour and portability. Called for every new context.
void installDebugOutput();

/// The messages since the last call, and any error glGetError() still holds.
std::vector<std::string> takeDebugMessages();

}  // namespace meniscus::gl

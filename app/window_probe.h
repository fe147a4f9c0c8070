#pragma once
// Whether a window with an OpenGL 4.5 core context can be opened here, for `meniscus doctor`.

#include "render/gl/context.h"

namespace meniscus {

/// Opens an invisible window through GLFW, which is looked for at run time, and closes it again.
BackendReport probeWindow();

}  // namespace meniscus

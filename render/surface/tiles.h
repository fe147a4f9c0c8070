#pragma once
// Method "tiles": exact metaballs by the processor, from tile lists and with vectors of rays (core/tiles/).
// The picture's part that holds the surface is uploaded and laid into the G-buffer with a depth test.

#include "render/surface_method.h"

namespace meniscus {

std::unique_ptr<SurfaceMethod> makeTiles(const SurfaceParameters& values);

}  // namespace meniscus

#pragma once
// The method "tiles_glsl": the lists of the method "tiles", which the processor makes, cast by shaders.

#include "render/surface_method.h"

namespace meniscus {

std::span<const SurfaceParameter> tilesGlslParameters();
std::unique_ptr<SurfaceMethod> makeTilesGlsl(const SurfaceParameters& values);

}  // namespace meniscus

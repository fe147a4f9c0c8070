#pragma once
// Method "newton": hulls around the balls are rasterized, and where a ray enters one, Newton's method looks
// for the surface. "GPU-Accelerated Ray Casting of Node-Based Implicit Surfaces", SIGGRAPH 2006 poster: the
// largest terms of the field are added exactly, the rest comes from an ambient field in a volume texture.
//
// Deviations (docs/methods.md): by default the iteration is kept in a bracket that holds the first root and
// no other, and all terms are exact; safeguard=0 is the poster's. The poster's modified field, which its
// hulls bound, is one of compact support here.

#include "render/surface_method.h"

namespace meniscus {

std::span<const SurfaceParameter> newtonParameters();
std::unique_ptr<SurfaceMethod> makeNewton(const SurfaceParameters& values);

}  // namespace meniscus

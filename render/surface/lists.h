#pragma once
// Method "lists": ray casting with fragment lists. Szécsi, Illés, Real-Time Metaball Ray Casting with
// Fragment Lists, Eurographics 2012 short papers, doi 10.2312/conf/EG2012/short/093-096.
//
// Balls are sorted by effective distance; the fronts of their cores are laid down and hide what lies behind;
// what remains is gathered into a list for each pixel; each list is cast. Deviations (docs/methods.md): lists
// are counted before memory is taken for them, and made band by band where that is short; fragments that come
// out of order are put in order; the running polynomial is relative to the last separator and decides only
// that a piece cannot cross the surface, while one that may is summed up anew; besides the paper's cubics
// there are exact pieces; pixels whose array is too short are done again by walking their list.

#include "render/surface_method.h"

namespace meniscus {

/// The parameters are in the list of render/surface_methods.cpp.
std::span<const SurfaceParameter> listsParameters();
std::unique_ptr<SurfaceMethod> makeLists(const SurfaceParameters& values);

}  // namespace meniscus

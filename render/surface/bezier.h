#pragma once
// Method "bezier": depth-peeled Bezier clipping. Kanamori, Szego, Nishita, GPU-based Fast Ray Casting for a
// Large Number of Metaballs, Computer Graphics Forum 27(2), 2008, doi 10.1111/j.1467-8659.2008.01132.x.
//
// Layer by layer, the places at which each pixel's ray enters or leaves a ball are peeled off in order; the
// pixel keeps the list of the balls that it is in, and looks for the surface in each interval between two
// such places. Deviations (docs/methods.md): events are ordered by (place, ball), so that none is lost or
// taken twice; a pixel whose list becomes too short, or whose layers too many, goes on without one; the
// polynomials of an interval are written down at once instead of being clipped from the whole chord; balls
// are culled for each cell of the screen, by a flag in a buffer instead of a query for each.

#include "render/surface_method.h"

namespace meniscus {

/// The parameters are in the list of render/surface_methods.cpp.
std::span<const SurfaceParameter> bezierParameters();
std::unique_ptr<SurfaceMethod> makeBezier(const SurfaceParameters& values);

}  // namespace meniscus

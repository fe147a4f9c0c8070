#pragma once
// Method "bvh": rays walk a tree of cells that is fitted to the surface. O. Gourmel, A. Pajot, M. Paulin, L.
// Barthe, P. Poulin, Fitted BVH for Fast Raytracing of Metaballs, Computer Graphics Forum 29(2), 2010,
// doi 10.1111/j.1467-8659.2009.01597.x. The tree: core/bvh/field_tree.h.
//
// Deviations (docs/methods.md): by default the first root is isolated for certain; search=1 is the paper's.
// Pixels whose ray meets more balls in a cell than the shader has room for, or for which the driver ends a
// loop, are cast by the processor through the same tree (core/bvh/field_tracer.h), and counted.

#include "render/surface_method.h"

namespace meniscus {

std::span<const SurfaceParameter> bvhParameters();
std::unique_ptr<SurfaceMethod> makeBvh(const SurfaceParameters& values);

}  // namespace meniscus

#pragma once
// Method "mesh": the surface as triangles (core/mesh/surface_mesh.h), made once and rasterized. What a pixel
// shows is the exact intersection of its ray with the triangle that covers it; how far the triangles are from
// the surface depends on the spacing of their grid.

#include "render/surface_method.h"

namespace meniscus {

std::span<const SurfaceParameter> meshParameters();
std::unique_ptr<SurfaceMethod> makeMesh(const SurfaceParameters& values);

}  // namespace meniscus

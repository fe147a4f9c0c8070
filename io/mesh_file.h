#pragma once
// Surfaces as polygons in files that other programs read: binary PLY and binary glTF 2.0 (.glb).
//
// Positions are Å in the structure's own coordinates. PLY: x, y, z (float, double if float32 would round them
// by more than 1e-3 Å), nx, ny, nz, red, green, blue (sRGB), atom (1, 2, ... in the file's order); all
// surfaces as one list. glTF: a node for each surface with the origin as its translation; COLOR_0 in linear
// light, 16 bits. One unit is 1 Å.

#include <filesystem>
#include <glm/vec3.hpp>
#include <vector>

#include "core/mesh/surface_mesh.h"

namespace meniscus {

/// Throws UsageError, naming `option`, unless the name ends in .ply or .glb.
void requireMeshName(const char* option, const std::filesystem::path& path);

/// `origin`: Primitives::origin. Throws InputError if the file cannot be written or, for glTF, would have
/// more than 4 GiB.
void writeMeshFile(const std::filesystem::path& path, const std::vector<SurfaceMesh>& surfaces,
                   const glm::dvec3& origin);

}  // namespace meniscus

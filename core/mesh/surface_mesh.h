#pragma once
// The surface of a field of metaballs as triangles: marching cubes on a sparse grid (core/mesh/cube_cases.h).
//
// A grid of cubes that covers all supports is halved again and again; a part in which the field is proven to
// have one sign is left out (core/mesh/active_blocks.h), so the cost follows the surface, not the box. What
// is smaller than a cube may be lost. Vertices are moved along their edges onto the surface itself; normals
// are those of the field. The mesh is closed, and every edge belongs to two triangles.

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/metaball_field.h"

namespace meniscus {

struct MeshVertex {
  glm::vec3 position;   ///< relative to Primitives::origin [Å]
  glm::vec3 normal;     ///< unit, world axes, outwards
  std::uint32_t color;  ///< 0xRRGGBB, sRGB: of the balls, blended by what they add to the field
  std::uint32_t id;     ///< of the ball that adds most
};
static_assert(sizeof(MeshVertex) == 32);

struct SurfaceMesh {
  std::vector<MeshVertex> vertices;
  std::vector<glm::uvec3> triangles;  ///< anticlockwise seen from outside
};

struct MeshOptions {
  double spacing = 0.5;  ///< side of a cube [Å], > 0
  /// Of memory, while it is made. The same on every machine: what is refused here is refused there.
  std::uint64_t mostBytes = std::uint64_t{4} << 30;
};

/// The same bytes for the same field and options, on any number of processors. Throws InputError as
/// requireValid(), or naming the spacing if the mesh would take more than mostBytes or its grid more than
/// 2^20 cubes along one side.
SurfaceMesh meshSurface(const MetaballField& field, const MeshOptions& options);

}  // namespace meniscus

#pragma once
// Closed surfaces made of triangles, in the layout in which they are uploaded.

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace meniscus {

struct TriangleVertex {
  glm::vec3 position;  ///< relative to Primitives::origin [Å]
  glm::vec3 normal;    ///< of the surface that the triangles stand for: unit, outward
};

struct TriangleCorners {
  std::uint32_t a, b, c;  ///< indices of vertices, counter-clockwise seen from outside
};

struct TriangleSurface {
  std::uint32_t color;  ///< 0xRRGGBB, sRGB
  std::uint32_t id;     ///< 1-based
};

struct TriangleMesh {
  std::vector<TriangleVertex> vertices;
  std::vector<TriangleCorners> triangles;
  std::vector<TriangleSurface> surfaces;  ///< one for each triangle
  bool empty() const { return triangles.empty(); }
};

}  // namespace meniscus

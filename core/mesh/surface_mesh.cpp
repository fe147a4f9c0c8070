#include "core/mesh/surface_mesh.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <glm/common.hpp>
#include <limits>

#include "core/error.h"
#include "core/mesh/active_blocks.h"
#include "core/mesh/cube_cases.h"
#include "core/mesh/field_sum.h"

namespace meniscus {

namespace {

using namespace mesh;

constexpr int kNodes = kBlockSide + 1;  // along a side of a block
// Of one block while a mesh is made: its vertices and triangles twice, its list of balls. Measured: 1.3 kB on
// grids that are fine for their balls, where it matters, 3.2 kB on coarse ones.
constexpr std::uint64_t kBytesPerBlock = 2048;

// A vertex as a block's triangles name it: one on an edge of the grid, which belongs to the block of its
// lesser node, or one of the block's own within a cube.
using Corner = std::uint16_t;
constexpr Corner kMiddle = 0x8000;

Corner edgeCorner(const glm::ivec3& node, int axis) {
  int owner = 0, at = 0;
  for (int i = 0; i < 3; ++i) {
    if (node[i] == kBlockSide) {
      owner |= 1 << i;
    } else {
      at |= node[i] << 2 * i;
    }
  }
  return static_cast<Corner>(owner << 8 | axis << 6 | at);
}

struct BlockMesh {
  std::array<std::uint64_t, 3> edges{};  // by axis: of each node, whether its edge holds a vertex
  std::vector<MeshVertex> vertices;      // of the edges by axis and node; then those in cubes
  std::vector<Corner> corners;           // three a triangle
  std::size_t firstVertex = 0, firstTriangle = 0;

  std::size_t edgeCount() const {
    return static_cast<std::size_t>(std::popcount(edges[0]) + std::popcount(edges[1]) +
                                    std::popcount(edges[2]));
  }
  std::size_t rank(int axis, int node) const {
    int before = 0;
    for (int a = 0; a < axis; ++a) before += std::popcount(edges[static_cast<std::size_t>(a)]);
    const std::uint64_t below = (std::uint64_t{1} << node) - 1;
    return static_cast<std::size_t>(before + std::popcount(edges[static_cast<std::size_t>(axis)] & below));
  }
};

class BlockMesher {
 public:
  BlockMesher(const MetaballField& field, std::span<const WideBall> balls, const Grid& grid,
              const ActiveBlock& block, BlockMesh& out)
      : field_(field), balls_(balls), grid_(grid), block_(block), out_(out) {}

  void run() {
    sample();
    for (int axis = 0; axis < 3; ++axis) placeVertices(axis);
    for (int z = 0; z < kBlockSide; ++z)
      for (int y = 0; y < kBlockSide; ++y)
        for (int x = 0; x < kBlockSide; ++x) addCube({x, y, z});
  }

 private:
  static std::size_t index(const glm::ivec3& node) {
    return static_cast<std::size_t>((node.z * kNodes + node.y) * kNodes + node.x);
  }
  double value(const glm::ivec3& node) const { return values_[index(node)]; }
  glm::dvec3 place(const glm::ivec3& node) const {
    const glm::ivec3 at = block_.first + node;
    return {grid_.coordinate(0, at.x), grid_.coordinate(1, at.y), grid_.coordinate(2, at.z)};
  }

  void sample();
  void placeVertices(int axis);
  glm::dvec3 onEdge(const glm::ivec3& node, int axis) const;
  void addVertex(const glm::dvec3& at);
  void addCube(const glm::ivec3& cell);
  void addMiddle(const glm::ivec3& cell, const CubeCase& triangles, int which);
  glm::dvec3 towardsSurface(const glm::dvec3& from) const;

  const MetaballField& field_;
  std::span<const WideBall> balls_;
  const Grid& grid_;
  const ActiveBlock& block_;
  BlockMesh& out_;
  std::array<double, kNodes * kNodes * kNodes> values_{};
};

// A node that blocks share gets the same bits in each: its terms that are not zero are the same, in the same
// order.
void BlockMesher::sample() {
  values_.fill(-field_.level);
  for (const std::uint32_t i : block_.balls) {
    const WideBall& ball = balls_[i];
    std::array<std::array<double, kNodes>, 3> squares;
    for (int axis = 0; axis < 3; ++axis) {
      for (int n = 0; n < kNodes; ++n) {
        const double d = grid_.coordinate(axis, block_.first[axis] + n) - ball.center[axis];
        squares[static_cast<std::size_t>(axis)][static_cast<std::size_t>(n)] = d * d;
      }
    }
    std::size_t at = 0;
    for (std::size_t z = 0; z < kNodes; ++z) {
      for (std::size_t y = 0; y < kNodes; ++y) {
        for (std::size_t x = 0; x < kNodes; ++x, ++at) {
          const double r2 = squares[0][x] + (squares[1][y] + squares[2][z]);
          const double w = std::max(1 - r2 * ball.inverse2, 0.0);
          values_[at] += ball.coefficient * fastKernel(field_.kernel, w);
        }
      }
    }
  }
}

void BlockMesher::placeVertices(int axis) {
  for (int n = 0; n < kBlockSide * kBlockSide * kBlockSide; ++n) {
    const glm::ivec3 node(n & 3, n >> 2 & 3, n >> 4);
    glm::ivec3 next = node;
    ++next[axis];
    if ((value(node) > 0) == (value(next) > 0)) continue;
    out_.edges[static_cast<std::size_t>(axis)] |= std::uint64_t{1} << n;
    addVertex(onEdge(node, axis));
  }
}

// Regula falsi with halved ends (Dowell and Jarratt 1971), and halving where it is slow.
glm::dvec3 BlockMesher::onEdge(const glm::ivec3& node, int axis) const {
  glm::ivec3 next = node;
  ++next[axis];
  glm::dvec3 at = place(node);
  double low = at[axis], high = place(next)[axis], fLow = value(node), fHigh = value(next);
  const double enough = 1e-7 * grid_.spacing;
  int lastSide = 0;
  for (int i = 0; i < 60 && high - low > enough; ++i) {
    double x = low - fLow * (high - low) / (fHigh - fLow);
    if (i % 4 == 3 || !(x > low && x < high)) x = low + 0.5 * (high - low);
    at[axis] = x;
    const double f = fieldAt(field_, balls_, block_.balls, at);
    if (std::abs(f) < 1e-13 * field_.level) return at;
    const int side = (f > 0) == (fLow > 0) ? -1 : 1;
    if (side < 0) {
      low = x;
      fLow = f;
      if (lastSide < 0) fHigh *= 0.5;
    } else {
      high = x;
      fHigh = f;
      if (lastSide > 0) fLow *= 0.5;
    }
    lastSide = side;
  }
  at[axis] = std::clamp(low - fLow * (high - low) / (fHigh - fLow), low, high);
  return at;
}

void BlockMesher::addVertex(const glm::dvec3& at) {
  const SurfacePoint s = surfaceAt(field_, balls_, block_.balls, at);
  const double length = glm::length(s.outward);
  const glm::dvec3 normal = length > 0 ? s.outward / length : glm::dvec3(0, 0, 1);
  out_.vertices.push_back({glm::vec3(at), glm::vec3(normal), s.color, std::max(s.id, 1u)});
}

void BlockMesher::addCube(const glm::ivec3& cell) {
  const auto cornerAt = [&](int c) { return cell + glm::ivec3(c & 1, c >> 1 & 1, c >> 2); };
  unsigned inside = 0, joined = 0;
  for (int c = 0; c < 8; ++c)
    if (value(cornerAt(c)) > 0) inside |= 1u << c;
  if (inside == 0 || inside == 255) return;
  for (int face = 0; face < 6; ++face) {
    if (!isAmbiguous(inside, face)) continue;
    const std::array<int, 4> c = faceCorners(face);
    const double a = value(cornerAt(c[0])) * value(cornerAt(c[2])),
                 b = value(cornerAt(c[1])) * value(cornerAt(c[3]));
    const bool firstInside = (inside >> c[0] & 1u) != 0;
    if (firstInside ? a > b : b > a) joined |= 1u << face;
  }
  const CubeCase triangles = cubeCase(inside, joined);
  const std::size_t firstMiddle = out_.vertices.size() - out_.edgeCount();
  for (int i = 0; i < triangles.middles; ++i) addMiddle(cell, triangles, kFirstMiddle + i);
  for (const int corner : triangles.corners) {
    if (corner >= kFirstMiddle) {
      out_.corners.push_back(
          static_cast<Corner>(kMiddle | (firstMiddle + static_cast<std::size_t>(corner - kFirstMiddle))));
    } else {
      out_.corners.push_back(edgeCorner(cornerAt(edgeCorners(corner)[0]), corner / 4));
    }
  }
}

// From the middle of the vertices of a loop onto the surface.
void BlockMesher::addMiddle(const glm::ivec3& cell, const CubeCase& triangles, int which) {
  glm::dvec3 sum(0.0);
  int count = 0;
  for (std::size_t i = 0; i < triangles.corners.size(); i += 3) {
    if (triangles.corners[i + 2] != which) continue;
    const int edge = triangles.corners[i];
    const std::array<int, 2> c = edgeCorners(edge);
    sum += onEdge(cell + glm::ivec3(c[0] & 1, c[0] >> 1 & 1, c[0] >> 2), edge / 4);
    ++count;
  }
  addVertex(towardsSurface(sum / static_cast<double>(count)));
}

// Newton's method along the gradient, as long as F becomes smaller and the point stays close by.
glm::dvec3 BlockMesher::towardsSurface(const glm::dvec3& from) const {
  glm::dvec3 at = from;
  double f = fieldAt(field_, balls_, block_.balls, at);
  for (int i = 0; i < 16; ++i) {
    const glm::dvec3 outward = surfaceAt(field_, balls_, block_.balls, at).outward;
    const double square = glm::dot(outward, outward);
    if (!(square > 0)) break;
    const glm::dvec3 next = at + outward * (f / square);
    if (glm::length(next - from) > 0.5 * grid_.spacing) break;
    const double fNext = fieldAt(field_, balls_, block_.balls, next);
    if (!(std::abs(fNext) < std::abs(f))) break;
    at = next;
    f = fNext;
  }
  return at;
}

Grid gridAround(const MetaballField& field, double spacing) {
  const auto [low, high] = supportBox(field);
  // Off the supports by a share of a cube that no lattice has, so that few nodes lie on the surface.
  Grid grid{low - spacing * glm::dvec3(0.6180339887, 0.4142135624, 0.7320508076), spacing};
  const glm::dvec3 size = high - grid.base;
  const double cubes = std::max({size.x, size.y, size.z}) / spacing + 1;
  if (cubes > kMostGridSide)
    throw InputError(
        fmt::format("--mesh-spacing: {:g} A is too fine for a surface {:g} A wide; give at least {:g}",
                    spacing, cubes * spacing, cubes * spacing / kMostGridSide));
  while (grid.side < cubes) grid.side *= 2;
  return grid;
}

// The blocks' meshes in one.
SurfaceMesh joined(const std::vector<ActiveBlock>& blocks, std::vector<BlockMesh>& meshes) {
  std::size_t vertexCount = 0, triangleCount = 0;
  for (BlockMesh& block : meshes) {
    block.firstVertex = vertexCount;
    block.firstTriangle = triangleCount;
    vertexCount += block.vertices.size();
    triangleCount += block.corners.size() / 3;
  }
  MENISCUS_CHECK(vertexCount < std::numeric_limits<std::uint32_t>::max());
  SurfaceMesh mesh;
  mesh.vertices.resize(vertexCount);
  mesh.triangles.resize(triangleCount);
  const auto blockAt = [&](const glm::ivec3& first) {
    const auto at = std::lower_bound(blocks.begin(), blocks.end(), blockKey(first),
                                     [](const ActiveBlock& b, std::uint64_t key) { return b.key < key; });
    // An edge with two signs has its block: its ends are within it.
    MENISCUS_CHECK(at != blocks.end() && at->key == blockKey(first));
    return static_cast<std::size_t>(at - blocks.begin());
  };
  tbb::parallel_for(std::size_t{0}, meshes.size(), [&](std::size_t i) {
    BlockMesh& block = meshes[i];
    std::copy(block.vertices.begin(), block.vertices.end(),
              mesh.vertices.begin() + static_cast<std::ptrdiff_t>(block.firstVertex));
    std::array<const BlockMesh*, 8> owners{};
    const auto vertexOf = [&](Corner corner) {
      if ((corner & kMiddle) != 0) return block.firstVertex + block.edgeCount() + (corner & ~kMiddle);
      const std::size_t owner = corner >> 8;
      if (owners[owner] == nullptr)
        owners[owner] = &meshes[blockAt(blocks[i].first +
                                        kBlockSide * glm::ivec3(owner & 1, owner >> 1 & 1, owner >> 2))];
      return owners[owner]->firstVertex + owners[owner]->rank(corner >> 6 & 3, corner & 63);
    };
    for (std::size_t k = 0; k < block.corners.size(); ++k)
      mesh.triangles[block.firstTriangle + k / 3][static_cast<glm::length_t>(k % 3)] =
          static_cast<std::uint32_t>(vertexOf(block.corners[k]));
    block.vertices = {};  // what others look up stays
    block.corners = {};
  });
  return mesh;
}

}  // namespace

SurfaceMesh meshSurface(const MetaballField& field, const MeshOptions& options) {
  requireValid(field, "surface");
  MENISCUS_CHECK(options.spacing > 0);
  if (field.balls.empty()) return {};
  std::vector<WideBall> balls;
  balls.reserve(field.balls.size());
  for (const Metaball& ball : field.balls) {
    const double support2 = static_cast<double>(ball.support) * static_cast<double>(ball.support);
    balls.push_back({glm::dvec3(ball.center), support2, 1 / support2, static_cast<double>(ball.coefficient),
                     ball.color, ball.id});
  }
  const Grid grid = gridAround(field, options.spacing);
  const std::vector<ActiveBlock> blocks =
      findActiveBlocks(field, balls, grid, options.mostBytes / kBytesPerBlock);
  std::vector<BlockMesh> meshes(blocks.size());
  tbb::parallel_for(std::size_t{0}, blocks.size(),
                    [&](std::size_t i) { BlockMesher(field, balls, grid, blocks[i], meshes[i]).run(); });
  return joined(blocks, meshes);
}

}  // namespace meniscus

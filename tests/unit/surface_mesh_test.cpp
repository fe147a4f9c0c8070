// The surface as triangles: all cases of a cube, closed meshes, vertices on the surface.

#include "core/mesh/surface_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <set>

#include "core/error.h"
#include "core/generated_scenes.h"
#include "core/mesh/cube_cases.h"
#include "tests/support/exact_field.h"

namespace meniscus {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

// The faces of the cube that hold a vertex on an edge.
std::set<int> facesOf(int edge) {
  std::set<int> faces;
  for (int face = 0; face < 6; ++face) {
    const auto corners = mesh::faceCorners(face);
    const auto has = [&](int c) { return std::find(corners.begin(), corners.end(), c) != corners.end(); };
    const auto ends = mesh::edgeCorners(edge);
    if (has(ends[0]) && has(ends[1])) faces.insert(face);
  }
  return faces;
}

// The directed lines that a case draws on a face: edges of triangles that no other triangle has reversed.
std::set<std::pair<int, int>> openEdges(const mesh::CubeCase& triangles) {
  std::map<std::pair<int, int>, int> count;
  for (std::size_t i = 0; i < triangles.corners.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k)
      ++count[{triangles.corners[i + k], triangles.corners[i + (k + 1) % 3]}];
  std::set<std::pair<int, int>> open;
  for (const auto& [edge, times] : count) {
    EXPECT_EQ(times, 1) << "an edge twice in the same direction";
    if (count.find({edge.second, edge.first}) == count.end()) open.insert(edge);
  }
  return open;
}

// All 256 cases, with every choice of what is joined.
TEST(CubeCases, CloseUpAndAgreeWithTheirNeighbours) {
  int withMiddle = 0, cases = 0;
  for (unsigned inside = 0; inside < 256; ++inside) {
    for (unsigned joined = 0; joined < 64; ++joined) {
      const mesh::CubeCase triangles = mesh::cubeCase(inside, joined);
      ++cases;
      withMiddle += triangles.middles > 0 ? 1 : 0;
      // A vertex on every edge with two signs, and on no other.
      std::set<int> used, expected;
      for (const int corner : triangles.corners)
        if (corner < mesh::kFirstMiddle) used.insert(corner);
      for (int edge = 0; edge < 12; ++edge) {
        const auto ends = mesh::edgeCorners(edge);
        if (((inside >> ends[0] ^ inside >> ends[1]) & 1u) != 0) expected.insert(edge);
      }
      ASSERT_EQ(used, expected) << inside << ' ' << joined;
      // What is open lies in faces, one line for each pair of places where the face's outline is crossed.
      const auto open = openEdges(triangles);
      ASSERT_EQ(open.size(), expected.size());
      for (const auto& [from, to] : open) {
        std::set<int> shared;
        const std::set<int> a = facesOf(from), b = facesOf(to);
        std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::inserter(shared, shared.end()));
        ASSERT_EQ(shared.size(), 1u);
      }
      // No edge within the cube lies in a face.
      for (std::size_t i = 0; i < triangles.corners.size(); ++i) {
        const int from = triangles.corners[i], to = triangles.corners[i % 3 == 2 ? i - 2 : i + 1];
        if (from >= mesh::kFirstMiddle || to >= mesh::kFirstMiddle || open.count({from, to}) > 0) continue;
        if (open.count({to, from}) > 0) continue;
        std::set<int> shared;
        const std::set<int> a = facesOf(from), b = facesOf(to);
        std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::inserter(shared, shared.end()));
        ASSERT_TRUE(shared.empty()) << inside << ' ' << joined;
      }
      // The neighbour across each face, mirrored, draws the same lines in the other direction.
      for (int axis = 0; axis < 3; ++axis) {
        const int flip = 1 << axis;
        unsigned mirrored = 0;
        for (int c = 0; c < 8; ++c)
          if ((inside >> c & 1u) != 0) mirrored |= 1u << (c ^ flip);
        unsigned choices = joined & ~(3u << 2 * axis);
        choices |= (joined >> 2 * axis & 1u) << (2 * axis + 1) | (joined >> (2 * axis + 1) & 1u) << 2 * axis;
        std::set<std::pair<int, int>> lines, theirs;
        const auto mirror = [&](int edge) {
          if (edge / 4 == axis) return edge;
          const auto ends = mesh::edgeCorners(edge);
          for (int other = 0; other < 12; ++other)
            if (mesh::edgeCorners(other)[0] == (ends[0] ^ flip) && other / 4 == edge / 4) return other;
          ADD_FAILURE();
          return 0;
        };
        for (const auto& [from, to] : open) lines.insert({mirror(to), mirror(from)});
        theirs = openEdges(mesh::cubeCase(mirrored, choices));
        ASSERT_EQ(lines, theirs) << inside << ' ' << joined;
      }
    }
  }
  EXPECT_EQ(cases, 256 * 64);
  EXPECT_GT(withMiddle, 0);
}

TEST(CubeCases, OneCornerFacesOutwards) {
  const mesh::CubeCase one = mesh::cubeCase(1, 0);  // corner 0: edges 0, 4, 8 along x, y, z
  ASSERT_EQ(one.corners.size(), 3u);
  const std::size_t start =
      static_cast<std::size_t>(std::find(one.corners.begin(), one.corners.end(), 0) - one.corners.begin());
  EXPECT_EQ(one.corners[(start + 1) % 3], 4);
  EXPECT_EQ(one.corners[(start + 2) % 3], 8);
}

void expectClosed(const SurfaceMesh& mesh) {
  ASSERT_FALSE(mesh.triangles.empty());
  std::vector<Edge> edges;
  std::vector<bool> used(mesh.vertices.size());
  for (const glm::uvec3& t : mesh.triangles) {
    for (glm::length_t k = 0; k < 3; ++k) {
      ASSERT_LT(t[k], mesh.vertices.size());
      ASSERT_NE(t[k], t[(k + 1) % 3]);
      used[t[k]] = true;
      edges.emplace_back(t[k], t[(k + 1) % 3]);
    }
  }
  std::sort(edges.begin(), edges.end());
  EXPECT_EQ(std::adjacent_find(edges.begin(), edges.end()), edges.end()) << "an edge of three triangles";
  std::size_t alone = 0;
  for (const Edge& edge : edges)
    alone += std::binary_search(edges.begin(), edges.end(), Edge{edge.second, edge.first}) ? 0 : 1;
  EXPECT_EQ(alone, 0u) << "edges of one triangle";
  EXPECT_EQ(std::count(used.begin(), used.end(), false), 0) << "vertices of no triangle";
}

double volumeOf(const SurfaceMesh& mesh) {
  double volume = 0;
  for (const glm::uvec3& t : mesh.triangles)
    volume += glm::dot(glm::dvec3(mesh.vertices[t.x].position),
                       glm::cross(glm::dvec3(mesh.vertices[t.y].position),
                                  glm::dvec3(mesh.vertices[t.z].position))) /
              6;
  return volume;
}

// F in extended precision, and what it would change over `step` along the normal.
double fieldAt(const MetaballField& field, const glm::dvec3& at) {
  test::Real sum = -test::Real(field.level);
  for (const Metaball& ball : field.balls) {
    const glm::dvec3 v = at - glm::dvec3(ball.center);
    const test::Real w =
        1 - test::Real(glm::dot(v, v)) / (test::Real(ball.support) * test::Real(ball.support));
    sum += test::Real(ball.coefficient) * test::exactKernel(field.kernel, w);
  }
  return static_cast<double>(sum);
}

TEST(SurfaceMesh, VerticesLieOnTheSurfaceWithItsNormals) {
  for (const Kernel kernel : {Kernel{}, Kernel{KernelShape::quartic}, Kernel{KernelShape::power, 5}}) {
    const MetaballField field = test::randomField(kernel, 0.3, 60, 4, 4, 3);
    const SurfaceMesh mesh = meshSurface(field, {.spacing = 0.4});
    expectClosed(mesh);
    for (std::size_t i = 0; i < mesh.vertices.size(); i += 7) {
      const MeshVertex& v = mesh.vertices[i];
      const glm::dvec3 at(v.position), n(v.normal);
      EXPECT_NEAR(glm::length(n), 1, 1e-6);
      const double step = 1e-4,
                   slope = (fieldAt(field, at + step * n) - fieldAt(field, at - step * n)) / 2 / step;
      EXPECT_LT(slope, 0) << "outwards";
      if (slope > -1e-2) continue;  // nearly a saddle
      EXPECT_LT(std::abs(fieldAt(field, at) / slope), 3e-6) << i;
    }
  }
}

// Spacings from coarse to fine, fields with cavities, lattices whose surfaces touch the grid's own symmetry.
TEST(SurfaceMesh, EveryEdgeBelongsToTwoTriangles) {
  for (const unsigned seed : {1u, 2u, 3u})
    for (const double spacing : {2.5, 1.3, 0.7, 0.4})
      expectClosed(meshSurface(test::randomField({}, 0.3, 80, 4, 6, seed), {.spacing = spacing}));
  MetaballField lattice;
  for (unsigned i = 0; i < 512; ++i)
    lattice.balls.push_back(
        {(glm::vec3(i % 8, i / 8 % 8, i / 64) - 3.5f) * 1.5f, 2.5f, 0.4f, 0x808080, i + 1});
  for (const double spacing : {0.75, 1.5, 1.0}) expectClosed(meshSurface(lattice, {.spacing = spacing}));
  expectClosed(meshSurface(packedBalls(3000, 5)->surfaces.front(), {.spacing = 0.5}));
}

// Faces with a choice, of all kinds: random signs at the nodes of a coarse grid.
TEST(SurfaceMesh, NoiseIsClosedToo) {
  test::Random random(8);
  MetaballField field;
  field.level = 0.4;
  for (unsigned i = 0; i < 4000; ++i)
    field.balls.push_back(
        {glm::vec3(random.inBox(9)), 1.3f, static_cast<float>(random.signedLog(0.5, 1.5)), 0x808080, i + 1});
  const SurfaceMesh mesh = meshSurface(field, {.spacing = 1.1});
  expectClosed(mesh);
  EXPECT_GT(mesh.triangles.size(), 5000u);
}

TEST(SurfaceMesh, ASphereHasItsVolume) {
  MetaballField field;
  field.balls = {{{1, 2, 3}, 4, 1, 0x123456, 7}};
  const double radius = 4 * coreShare(field.kernel, field.level, 1),
               exact = 4.0 / 3 * M_PI * std::pow(radius, 3);
  double before = 0;
  for (const double spacing : {0.8, 0.4, 0.2}) {
    const SurfaceMesh mesh = meshSurface(field, {.spacing = spacing});
    expectClosed(mesh);
    // Euler: a sphere.
    EXPECT_EQ(mesh.vertices.size() - mesh.triangles.size() / 2, 2u);
    const double error = exact - volumeOf(mesh);
    EXPECT_GT(error, 0);
    if (before > 0) {
      EXPECT_NEAR(before / error, 4, 0.5) << "second order";
    }
    before = error;
    for (const MeshVertex& v : mesh.vertices) {
      EXPECT_NEAR(glm::length(glm::dvec3(v.position) - glm::dvec3(1, 2, 3)), radius, 1e-6);
      EXPECT_EQ(v.id, 7u);
      EXPECT_EQ(v.color, 0x123456u);
    }
  }
  EXPECT_LT(before / exact, 0.01);
}

// Two balls far apart: what lies between them costs nothing, and both are there.
TEST(SurfaceMesh, CostFollowsTheSurface) {
  MetaballField field;
  field.balls = {{{0, 0, 0}, 4, 1, 0, 1}, {{60000, 30000, 0}, 4, 1, 0, 2}};
  const SurfaceMesh mesh = meshSurface(field, {.spacing = 0.5, .mostBytes = 8u << 20});
  expectClosed(mesh);
  EXPECT_EQ(mesh.vertices.size() - mesh.triangles.size() / 2, 4u) << "two spheres";
}

TEST(SurfaceMesh, IsTheSameEveryTime) {
  const MetaballField field = test::randomField({}, 0.3, 80, 4, 0, 5);
  const SurfaceMesh a = meshSurface(field, {.spacing = 0.5}), b = meshSurface(field, {.spacing = 0.5});
  EXPECT_EQ(a.triangles, b.triangles);
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  for (std::size_t i = 0; i < a.vertices.size(); ++i)
    EXPECT_EQ(a.vertices[i].position, b.vertices[i].position);
}

TEST(SurfaceMesh, NothingAboveTheMaximumAndNothingWithoutBalls) {
  MetaballField field;
  EXPECT_TRUE(meshSurface(field, {}).vertices.empty());
  field.balls = {{{0, 0, 0}, 4, 0.4f, 0, 1}};
  EXPECT_TRUE(meshSurface(field, {}).vertices.empty());
}

std::string refusalOf(const MetaballField& field, const MeshOptions& options) {
  try {
    meshSurface(field, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "made";
}

TEST(SurfaceMesh, WhatIsTooLargeIsRefusedByItsSpacing) {
  MetaballField field;
  field.balls = {{{0, 0, 0}, 1000, 1, 0, 1}};
  EXPECT_NE(refusalOf(field, {.spacing = 0.1, .mostBytes = 64u << 20}).find("--mesh-spacing: with 0.1 A"),
            std::string::npos);
  field.balls.push_back({{1e9f, 0, 0}, 4, 1, 0, 2});
  EXPECT_NE(refusalOf(field, {.spacing = 0.5}).find("--mesh-spacing: 0.5 A is too fine"), std::string::npos);
  field.balls.back().center.x = std::numeric_limits<float>::infinity();
  EXPECT_NE(refusalOf(field, {.spacing = 0.5}).find("not finite"), std::string::npos);
}

}  // namespace
}  // namespace meniscus

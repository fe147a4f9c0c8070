#pragma once
// Marching cubes (Lorensen and Cline 1987, doi 10.1145/37402.37422): which triangles a cube holds, by the
// signs at its corners and by what is joined on faces where two opposite corners are inside and two are not.
// The lists are derived from the rules below, not copied from a table.
//
// Neighbours that agree on a face's signs and on what is joined draw the same lines on it, in opposite
// directions. No triangle has an edge between two vertices of the same face but those lines, so every edge of
// the mesh belongs to exactly two triangles. What is joined is the asymptotic decider's word (Nielson and
// Hamann 1991, doi 10.1109/VISUAL.1991.175782); the inside of a cube never has a tunnel.
//
// Corner c lies at (c & 1, c >> 1 & 1, c >> 2). Edge 4 a + k runs along axis a; bit 0 of k is its place on
// axis a + 1, bit 1 on axis a + 2 (both modulo 3). Face 2 a + s is that of the larger (s = 1) or smaller end
// of axis a.

#include <array>
#include <cstdint>
#include <span>

namespace meniscus::mesh {

inline constexpr int kFirstMiddle = 12;

/// Corners (bit c: corner c is inside), and faces on which the two inside corners are joined (bit f); bits of
/// faces that have no choice are ignored.
struct CubeCase {
  /// Three of each triangle, seen anticlockwise from the outside: edges 0..11, or a vertex of its own in the
  /// middle of a loop, kFirstMiddle and on.
  std::span<const std::uint8_t> corners;
  int middles;  ///< such vertices: 0, 1 or 2
};

CubeCase cubeCase(unsigned inside, unsigned joined);

/// The corners of a face in order around it, anticlockwise seen from outside the cube.
std::array<int, 4> faceCorners(int face);

/// Whether neither two neighbouring corners of the face are both inside nor both outside.
bool isAmbiguous(unsigned inside, int face);

/// The two corners of an edge, the smaller coordinate first.
std::array<int, 2> edgeCorners(int edge);

}  // namespace meniscus::mesh

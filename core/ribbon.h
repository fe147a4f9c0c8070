#pragma once
// Cartoons: backbones as ribbons. M. Carson, Ribbon models of macromolecules, J. Mol. Graphics 5 (1987),
// doi 10.1016/0263-7855(87)80010-3, for the direction of a ribbon: across the planes of the peptides.
// Deviations: cubic splines through the CA atoms (Catmull and Rom 1974), strands smoothed; normals are those
// of the swept surface, not of its triangles.

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/backbone.h"
#include "core/molecule.h"

namespace meniscus {

enum class RibbonStyle : std::uint8_t {
  cartoon,  ///< helices and strands flat, strands with arrows, the rest tubes; bases as rungs
  putty     ///< tubes, the thicker the larger the B factor
};

/// In the molecule's own coordinates [Å].
struct Ribbon {
  struct Vertex {
    glm::dvec3 position, normal;
  };
  struct Triangle {
    std::uint32_t a, b, c;  ///< counter-clockwise seen from outside
    std::uint32_t atom;     ///< trace atom of the residue that it stands for
  };
  /// A ball that lies within the ribbon.
  struct Ball {
    glm::dvec3 center;
    double radius;
    std::uint32_t atom;
  };
  /// A rod with round ends, from a backbone to the middle of a base.
  struct Rung {
    glm::dvec3 from, to;
    double radius;
    std::uint32_t fromAtom, toAtom;
  };
  std::vector<Vertex> vertices;
  std::vector<Triangle> triangles;
  std::vector<Ball> filling;  ///< stands for the ribbon where balls are easier than triangles
  std::vector<Ball> lone;     ///< residues without neighbours
  std::vector<Rung> rungs;
};

/// The ribbons of the residues whose trace atoms (core/backbone.h) are chosen: `chosen` by atom, empty = all.
/// What is not chosen still bends its neighbours. `size` scales all widths.
Ribbon makeRibbon(const Molecule& molecule, const std::vector<Backbone>& backbones,
                  const std::vector<bool>& chosen, RibbonStyle style, double size);

}  // namespace meniscus

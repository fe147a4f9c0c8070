#pragma once
// What a Scene becomes: plain arrays of quadrics, in the layout in which they are uploaded. They do not know
// why they exist.

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/camera_fit.h"
#include "core/scene.h"
#include "core/view.h"

namespace meniscus {

struct SpherePrimitive {
  glm::vec3 center;     ///< relative to Primitives::origin [Å]
  float radius;         ///< [Å]
  std::uint32_t color;  ///< 0xRRGGBB, sRGB
  std::uint32_t id;     ///< 1-based; 0 is the background
};

/// Solid cylinder with flat ends, coloured by halves: a's half and b's half.
struct CylinderPrimitive {
  glm::vec3 a;  ///< relative to Primitives::origin [Å]
  float radius;
  glm::vec3 b;
  std::uint32_t colorA, colorB;
  std::uint32_t idA, idB;
};

struct Primitives {
  glm::dvec3 origin{0.0};  ///< world position of (0,0,0) [Å], near the middle of the scene
  std::vector<SpherePrimitive> spheres;
  std::vector<CylinderPrimitive> cylinders;

  BoundingSphere bounds() const;  ///< world space
};

/// All objects of a scene. Ids number the atoms of the first placement of the first object 1, 2, ..., and go
/// on. Throws InputError if more than 2^32 - 1 ids would be needed.
Primitives buildPrimitives(const Scene& scene);

/// Whether an object's representation draws bonds; if none does, nobody needs to find them.
bool needsBonds(Representation representation);

/// The spheres that a camera must fit to show the whole object: its atoms in every placement with the radius
/// that is drawn; of `atoms` only (indices into the molecule, ascending) if that is not empty.
std::vector<FitSphere> fitSpheres(const SceneObject& object, const std::vector<std::uint32_t>& atoms = {});

}  // namespace meniscus

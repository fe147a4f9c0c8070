#pragma once
// What a Scene becomes: plain arrays of quadrics and metaballs, in the layout in which they are uploaded.
// They do not know why they exist.

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/camera_fit.h"
#include "core/metaball_field.h"
#include "core/render_settings.h"
#include "core/rigid_motion.h"
#include "core/scene.h"
#include "core/triangle_mesh.h"
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

/// Three perpendicular semi-axes, of which the third is given by its length.
struct EllipsoidPrimitive {
  glm::vec3 center;     ///< relative to Primitives::origin [Å]
  float shortest;       ///< length of the third semi-axis [Å]
  glm::vec3 axisA;      ///< longest semi-axis [Å]
  glm::vec3 axisB;      ///< perpendicular to axisA, at least as long as the third [Å]
  std::uint32_t color;  ///< 0xRRGGBB, sRGB
  std::uint32_t id;
};

struct QuadricCounts {
  std::size_t spheres = 0, cylinders = 0, ellipsoids = 0;
  std::size_t all() const { return spheres + cylinders + ellipsoids; }
};

struct Quadrics {
  std::vector<SpherePrimitive> spheres;
  std::vector<CylinderPrimitive> cylinders;
  std::vector<EllipsoidPrimitive> ellipsoids;

  std::size_t quadricCount() const { return spheres.size() + cylinders.size() + ellipsoids.size(); }
};

/// One of the places in which a unit stands.
struct QuadricCopy {
  RigidMotion motion;         ///< of the unit's points, to relative to Primitives::origin
  std::uint32_t idShift = 0;  ///< is added to the ids of the unit
};

/// Quadrics that stand in several places. Their points are relative to one of their own, so that float32 is
/// as exact in every place, however far from the others.
struct QuadricUnit : Quadrics {
  std::vector<QuadricCopy> copies;
};

struct Primitives : Quadrics {
  glm::dvec3 origin{0.0};                ///< world position of (0,0,0) [Å], near the middle of the scene
  std::vector<QuadricUnit> units;        ///< beside the quadrics that stand in one place
  std::vector<MetaballField> surfaces;   ///< one per object drawn so, none of them empty
  TriangleMesh mesh;                     ///< of all ribbons
  std::vector<SpherePrimitive> filling;  ///< balls within the mesh, which stand for it in ambient occlusion
  std::vector<std::uint32_t> groups;     ///< by id; [0] = 0 and nobody else's; empty = not asked for

  bool noQuadrics() const { return quadricCount() == 0 && units.empty(); }
  bool empty() const { return noQuadrics() && surfaces.empty() && mesh.empty(); }
  /// Nothing beside the surfaces.
  bool onlySurfaces() const { return noQuadrics() && mesh.empty(); }
  /// Of all copies.
  QuadricCounts counts() const;
  /// That quadrics and their copies take in memory.
  std::uint64_t quadricBytes() const;
  BoundingSphere bounds() const;  ///< world space
  /// The smallest radius of what there is to see [Å]: of a metaball half its support, of an ellipsoid its
  /// shortest; 0 if there are triangles, infinity if there is nothing.
  double thinnestRadius() const;
};

/// The same without units: every copy's quadrics by themselves, for what draws no copies.
Primitives copiesApart(const Primitives& primitives);

/// What becomes of the atoms and bonds of an object that stands in several places.
enum class Copies : std::uint8_t { apart, shared };

/// All objects of a scene; residues or chains get Primitives::groups, which are different in every placement.
/// Ids number the atoms of the first placement of the first object 1, 2, ..., and go on; an object of the
/// same molecule and placements as the one before shares its ids; dashed lines come last. Copies::shared:
/// placements of the same residues become one unit, if it has so many atoms that this saves memory; surfaces
/// and ribbons are always apart. Throws InputError if more than 2^32 - 1 ids or quadrics would be needed.
Primitives buildPrimitives(const Scene& scene, LineGroups groups = LineGroups::none,
                           Copies copies = Copies::apart);

/// How many ids buildPrimitives() gives.
std::size_t countIds(const Scene& scene);

/// An atom of a scene, in one of its placements.
struct PlacedAtom {
  std::shared_ptr<const Molecule> molecule;
  std::uint32_t atom = 0;
  glm::dvec3 position{0.0};  ///< world [Å]
};

/// The atom that buildPrimitives() gives this id; nothing for the background and what is no atom.
std::optional<PlacedAtom> atomOfId(const Scene& scene, std::uint32_t id);

/// Whether an object's representation draws bonds; if none does, nobody needs to find them.
bool needsBonds(Representation representation);
/// Whether its atoms are drawn one by one, as quadrics, whose copies may share their memory.
bool drawsQuadrics(Representation representation);

/// The spheres that a camera must fit to show the whole object: its atoms in every placement with the radius
/// that is drawn; of `atoms` only (indices into the molecule, ascending) if that is not empty.
std::vector<FitSphere> fitSpheres(const SceneObject& object, const std::vector<std::uint32_t>& atoms = {});

/// The same, appended; placements of the same residues share them.
void addFitSpheres(const SceneObject& object, const std::vector<std::uint32_t>& atoms, FitSpheres& out);
void addFitSpheres(std::span<const SceneObject> objects, FitSpheres& out);

}  // namespace meniscus

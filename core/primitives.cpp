#include "core/primitives.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

#include "core/atom_colors.h"
#include "core/error.h"

namespace meniscus {

namespace {

constexpr std::uint32_t kNotDrawn = 0;

float drawnRadius(const SceneObject& object, std::size_t atom) {
  const float vdw = vanDerWaalsRadius(object.molecule->elements[atom], object.radii);
  switch (object.representation) {
    case Representation::spacefill:
      return vdw;
    case Representation::ballAndStick:
      return vdw * static_cast<float>(object.ballScale);
    case Representation::licorice:
      return static_cast<float>(object.licoriceRadius);
  }
  return vdw;
}

glm::dvec3 placed(const Placement& placement, const glm::dvec3& position) {
  return glm::dvec3(placement.transform * glm::dvec4(position, 1.0));
}

// Calls f(atom) for each atom that a placement holds.
template <typename F>
void forEachAtom(const Molecule& molecule, const Placement& placement, F f) {
  for (const IndexRange& range : placement.residues) {
    for (std::uint32_t r = range.first; r < range.end(); ++r) {
      const IndexRange& atoms = molecule.residues[r].atoms;
      for (std::uint32_t a = atoms.first; a < atoms.end(); ++a) f(a);
    }
  }
}

// Centre of the box around everything that is drawn.
glm::dvec3 middleOf(const Scene& scene) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const SceneObject& object : scene.objects) {
    for (const Placement& placement : object.placements) {
      forEachAtom(*object.molecule, placement, [&](std::uint32_t atom) {
        const glm::dvec3 p = placed(placement, object.molecule->positions[atom]);
        low = glm::min(low, p);
        high = glm::max(high, p);
      });
    }
  }
  return low.x <= high.x ? (low + high) * 0.5 : glm::dvec3(0.0);
}

// Adds one placement of an object; `ids` is scratch: the id of each atom drawn by this placement.
void addPlacement(const SceneObject& object, const Placement& placement, const std::vector<Rgb>& colors,
                  std::vector<std::uint32_t>& ids, std::uint32_t firstId, Primitives& out) {
  const Molecule& molecule = *object.molecule;
  const bool bonds = needsBonds(object.representation);
  std::vector<glm::vec3> centers(bonds ? molecule.atomCount() : 0);
  if (bonds) ids.assign(molecule.atomCount(), kNotDrawn);

  forEachAtom(molecule, placement, [&](std::uint32_t atom) {
    const glm::vec3 center(placed(placement, molecule.positions[atom]) - out.origin);
    const std::uint32_t id = firstId + atom;
    out.spheres.push_back({center, drawnRadius(object, atom), colors[atom], id});
    if (bonds) {
      centers[atom] = center;
      ids[atom] = id;
    }
  });
  if (!bonds) return;
  const auto radius = static_cast<float>(
      object.representation == Representation::licorice ? object.licoriceRadius : object.stickRadius);
  for (const Bond& bond : molecule.bonds) {
    if (ids[bond.a] == kNotDrawn || ids[bond.b] == kNotDrawn) continue;
    out.cylinders.push_back(
        {centers[bond.a], radius, centers[bond.b], colors[bond.a], colors[bond.b], ids[bond.a], ids[bond.b]});
  }
}

}  // namespace

bool needsBonds(Representation representation) {
  return representation != Representation::spacefill;
}

Primitives buildPrimitives(const Scene& scene) {
  Primitives out;
  out.origin = middleOf(scene);
  std::size_t count = 0, ids = 0;
  for (const SceneObject& object : scene.objects) {
    for (const Placement& placement : object.placements) {
      forEachAtom(*object.molecule, placement, [&](std::uint32_t) { ++count; });
      ids += object.molecule->atomCount();
    }
  }
  if (ids > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError(
        "the scene has more than 4,294,967,294 atoms; draw a part of it (--select, fewer copies)");
  }
  out.spheres.reserve(count);

  std::uint32_t nextId = 1;
  std::vector<std::uint32_t> scratch;
  for (const SceneObject& object : scene.objects) {
    const std::vector<Rgb> colors = colorAtoms(*object.molecule, object.coloring);
    for (const Placement& placement : object.placements) {
      addPlacement(object, placement, colors, scratch, nextId, out);
      nextId += static_cast<std::uint32_t>(object.molecule->atomCount());
    }
  }
  return out;
}

BoundingSphere Primitives::bounds() const {
  if (spheres.empty() && cylinders.empty()) return {origin, 0.0};
  glm::vec3 low(std::numeric_limits<float>::infinity()), high(-low);
  const auto grow = [&](glm::vec3 p, float r) {
    low = glm::min(low, p - r);
    high = glm::max(high, p + r);
  };
  for (const SpherePrimitive& s : spheres) grow(s.center, s.radius);
  for (const CylinderPrimitive& c : cylinders) {
    grow(c.a, c.radius);
    grow(c.b, c.radius);
  }
  const glm::vec3 middle = (low + high) * 0.5f;
  double radius = 0;
  for (const SpherePrimitive& s : spheres) {
    radius = std::max(radius, static_cast<double>(glm::length(s.center - middle) + s.radius));
  }
  for (const CylinderPrimitive& c : cylinders) {
    const float reach = std::max(glm::length(c.a - middle), glm::length(c.b - middle));
    radius = std::max(radius, static_cast<double>(reach + c.radius));
  }
  return {origin + glm::dvec3(middle), radius};
}

std::vector<FitSphere> fitSpheres(const SceneObject& object, const std::vector<std::uint32_t>& atoms) {
  std::vector<FitSphere> out;
  std::vector<bool> chosen;
  if (!atoms.empty()) {
    chosen.resize(object.molecule->atomCount());
    for (const std::uint32_t atom : atoms) chosen[atom] = true;
  }
  for (const Placement& placement : object.placements) {
    forEachAtom(*object.molecule, placement, [&](std::uint32_t atom) {
      if (!chosen.empty() && !chosen[atom]) return;
      out.push_back({placed(placement, object.molecule->positions[atom]),
                     static_cast<double>(drawnRadius(object, atom))});
    });
  }
  return out;
}

}  // namespace meniscus

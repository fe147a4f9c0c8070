#include "core/ribbon_primitives.h"

#include <glm/geometric.hpp>

namespace meniscus {
namespace {

constexpr double kTraceRadius = 0.35;  // of the backbone's sticks [Å]
constexpr double kRibbonReach = 1.7;   // the widest part of a ribbon, an arrow's root [Å]

glm::vec3 placed(const Placement& placement, const glm::dvec3& position, const glm::dvec3& origin) {
  return glm::vec3(glm::dvec3(placement.transform * glm::dvec4(position, 1.0)) - origin);
}

/// By atom: whether a placement holds it; empty = all.
std::vector<bool> atomsOf(const Molecule& molecule, const Placement& placement) {
  const bool all = placement.residues.size() == 1 && placement.residues[0].first == 0 &&
                   placement.residues[0].count == molecule.residues.size();
  if (all) return {};
  std::vector<bool> atoms(molecule.atomCount());
  for (const IndexRange& range : placement.residues)
    for (std::uint32_t r = range.first; r < range.end(); ++r)
      for (std::uint32_t a = molecule.residues[r].atoms.first; a < molecule.residues[r].atoms.end(); ++a)
        atoms[a] = true;
  return atoms;
}

/// By atom: whether the object draws it; empty = all.
std::vector<bool> chosenAtoms(const SceneObject& object) {
  if (object.atoms.empty()) return {};
  std::vector<bool> chosen(object.molecule->atomCount());
  for (const std::uint32_t atom : object.atoms) chosen[atom] = true;
  return chosen;
}

bool holds(const std::vector<bool>& atoms, std::uint32_t atom) {
  return atoms.empty() || atoms[atom];
}

}  // namespace

bool followsBackbone(Representation representation) {
  return representation == Representation::cartoon || representation == Representation::backbone ||
         representation == Representation::putty;
}

std::vector<double> backboneReach(const SceneObject& object) {
  const std::vector<bool> chosen = chosenAtoms(object);
  std::vector<double> reach(object.molecule->atomCount(), -1.0);
  const double trace = object.representation == Representation::backbone ? kTraceRadius : kRibbonReach;
  for (const Backbone& backbone : findBackbones(*object.molecule)) {
    for (const BackboneResidue& b : backbone.residues) {
      if (!holds(chosen, b.trace)) continue;
      reach[b.trace] = trace * object.ribbonScale;
      if (b.base != kNoAtom && object.representation == Representation::cartoon)
        reach[b.base] = kTraceRadius * object.ribbonScale;
    }
  }
  return reach;
}

BackboneObject::BackboneObject(const SceneObject& object) : object_(object) {
  if (!followsBackbone(object.representation)) return;
  chosen_ = chosenAtoms(object);
  backbones_ = findBackbones(*object.molecule);
  if (object.representation == Representation::backbone) return;
  ribbon_ =
      makeRibbon(*object.molecule, backbones_, chosen_,
                 object.representation == Representation::putty ? RibbonStyle::putty : RibbonStyle::cartoon,
                 object.ribbonScale);
}

void BackboneObject::addPlacement(const Placement& placement, const std::vector<Rgb>& colors,
                                  std::uint32_t firstId, Primitives& out) const {
  const std::vector<bool> inPlace = atomsOf(*object_.molecule, placement);
  if (object_.representation == Representation::backbone) {
    addTrace(placement, inPlace, colors, firstId, out);
  } else {
    addRibbon(placement, inPlace, colors, firstId, out);
  }
}

void BackboneObject::addTrace(const Placement& placement, const std::vector<bool>& inPlace,
                              const std::vector<Rgb>& colors, std::uint32_t firstId, Primitives& out) const {
  const auto radius = static_cast<float>(kTraceRadius * object_.ribbonScale);
  for (const Backbone& backbone : backbones_) {
    std::uint32_t last = kNoAtom;
    for (const BackboneResidue& b : backbone.residues) {
      const bool drawn = holds(chosen_, b.trace) && holds(inPlace, b.trace);
      const std::uint32_t before = last;
      last = drawn ? b.trace : kNoAtom;
      if (!drawn) continue;
      const glm::vec3 center = placed(placement, object_.molecule->positions[b.trace], out.origin);
      out.spheres.push_back({center, radius, colors[b.trace], firstId + b.trace});
      if (before == kNoAtom) continue;
      out.cylinders.push_back({placed(placement, object_.molecule->positions[before], out.origin), radius,
                               center, colors[before], colors[b.trace], firstId + before, firstId + b.trace});
    }
  }
}

void BackboneObject::addRibbon(const Placement& placement, const std::vector<bool>& inPlace,
                               const std::vector<Rgb>& colors, std::uint32_t firstId, Primitives& out) const {
  const glm::dmat3 turn(placement.transform);
  constexpr std::uint32_t kNotPlaced = 0xFFFFFFFFu;
  std::vector<std::uint32_t> place(ribbon_.vertices.size(), kNotPlaced);
  const auto vertex = [&](std::uint32_t i) {
    if (place[i] != kNotPlaced) return place[i];
    const Ribbon::Vertex& v = ribbon_.vertices[i];
    out.mesh.vertices.push_back(
        {placed(placement, v.position, out.origin), glm::vec3(glm::normalize(turn * v.normal))});
    return place[i] = static_cast<std::uint32_t>(out.mesh.vertices.size() - 1);
  };
  for (const Ribbon::Triangle& t : ribbon_.triangles) {
    if (!holds(inPlace, t.atom)) continue;
    const std::uint32_t a = vertex(t.a), b = vertex(t.b), c = vertex(t.c);
    out.mesh.triangles.push_back({a, b, c});
    out.mesh.surfaces.push_back({colors[t.atom], firstId + t.atom});
  }
  const auto ball = [&](const Ribbon::Ball& b) {
    return SpherePrimitive{placed(placement, b.center, out.origin), static_cast<float>(b.radius),
                           colors[b.atom], firstId + b.atom};
  };
  for (const Ribbon::Ball& b : ribbon_.filling)
    if (holds(inPlace, b.atom)) out.filling.push_back(ball(b));
  for (const Ribbon::Ball& b : ribbon_.lone)
    if (holds(inPlace, b.atom)) out.spheres.push_back(ball(b));
  for (const Ribbon::Rung& r : ribbon_.rungs) {
    if (!holds(inPlace, r.fromAtom)) continue;
    const glm::vec3 from = placed(placement, r.from, out.origin), to = placed(placement, r.to, out.origin);
    const auto radius = static_cast<float>(r.radius);
    out.cylinders.push_back(
        {from, radius, to, colors[r.fromAtom], colors[r.toAtom], firstId + r.fromAtom, firstId + r.toAtom});
    out.spheres.push_back({to, radius, colors[r.toAtom], firstId + r.toAtom});
  }
}

}  // namespace meniscus

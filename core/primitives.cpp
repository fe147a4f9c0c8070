#include "core/primitives.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/atom_colors.h"
#include "core/displacement.h"
#include "core/error.h"
#include "core/ribbon_primitives.h"

namespace meniscus {

namespace {

constexpr std::uint32_t kNotDrawn = 0;

// Radius of an atom without a displacement among ellipsoids [Å].
constexpr double kUnknownDisplacement = 0.1;

// Ellipsoids of an object's atoms at its probability; empty for the other representations.
class Ellipsoids {
 public:
  explicit Ellipsoids(const SceneObject& object) {
    if (object.representation != Representation::ellipsoids) return;
    const double scale = displacementScale(object.probability);
    displacements_ = displacementsOf(*object.molecule);
    for (Displacement& d : displacements_)
      d.axes = d.source == DisplacementSource::none ? glm::dmat3(kUnknownDisplacement) : d.axes * scale;
  }
  float longest(std::size_t atom) const {
    return static_cast<float>(glm::length(displacements_[atom].axes[0]));
  }
  bool isSphere(std::size_t atom) const { return displacements_[atom].isotropic; }
  const glm::dmat3& axes(std::size_t atom) const { return displacements_[atom].axes; }

 private:
  std::vector<Displacement> displacements_;
};

float drawnRadius(const SceneObject& object, const Ellipsoids& ellipsoids, std::size_t atom) {
  const float plain = vanDerWaalsRadius(object.molecule->elements[atom], object.radii);
  const float vdw = plain * static_cast<float>(object.radiusScale);
  switch (object.representation) {
    case Representation::spacefill:
      return vdw;
    case Representation::ballAndStick:
      return plain * static_cast<float>(object.ballScale);
    case Representation::licorice:
      return static_cast<float>(object.licoriceRadius);
    case Representation::ellipsoids:
      return ellipsoids.longest(atom);
    default:
      break;
  }
  return vdw;
}

// Where the fields of several atoms meet, the surface lies outside their spheres. Measured along rays over
// proteins, DNA and C60: on average 1.02 to 1.04 radii from the nearest centre at blend 1.3, 1.21 to 1.35 at
// 2, 1.8 to 2.04 at 3, 4.03 to 4.46 at 6. A picture must hold the outermost part, and no lone atom reaches so
// far.
double fitRadius(const SceneObject& object, const Ellipsoids& ellipsoids, std::size_t atom) {
  const double radius = static_cast<double>(drawnRadius(object, ellipsoids, atom));
  if (object.representation != Representation::surface) return radius;
  const double over = object.surface.blend - 1;
  return radius * std::min(1 + (0.4 + 0.08 * over) * over, object.surface.blend);
}

float bondRadius(const SceneObject& object) {
  switch (object.representation) {
    case Representation::licorice:
      return static_cast<float>(object.licoriceRadius);
    case Representation::ellipsoids:
      return static_cast<float>(object.ellipsoidStickRadius);
    default:
      return static_cast<float>(object.stickRadius);
  }
}

glm::dvec3 placed(const Placement& placement, const glm::dvec3& position) {
  return glm::dvec3(placement.transform * glm::dvec4(position, 1.0));
}

// Calls f(atom) for each atom of an object that a placement holds.
template <typename F>
void forEachAtom(const SceneObject& object, const Placement& placement, F f) {
  const bool all = object.atoms.empty();
  for (const IndexRange& range : placement.residues) {
    for (std::uint32_t r = range.first; r < range.end(); ++r) {
      const IndexRange& atoms = object.molecule->residues[r].atoms;
      auto chosen =
          all ? object.atoms.end() : std::lower_bound(object.atoms.begin(), object.atoms.end(), atoms.first);
      for (std::uint32_t a = atoms.first; a < atoms.end(); ++a) {
        if (all) {
          f(a);
        } else if (chosen != object.atoms.end() && *chosen == a) {
          f(a);
          ++chosen;
        }
      }
    }
  }
}

// Centre of the box around everything that is drawn.
glm::dvec3 middleOf(const Scene& scene) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const SceneObject& object : scene.objects) {
    for (const Placement& placement : object.placements) {
      forEachAtom(object, placement, [&](std::uint32_t atom) {
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
                  const Ellipsoids& ellipsoids, std::vector<std::uint32_t>& ids, std::uint32_t firstId,
                  Primitives& out) {
  const Molecule& molecule = *object.molecule;
  const bool bonds = needsBonds(object.representation);
  const glm::dmat3 turn(placement.transform);
  std::vector<glm::vec3> centers(bonds ? molecule.atomCount() : 0);
  if (bonds) ids.assign(molecule.atomCount(), kNotDrawn);

  forEachAtom(object, placement, [&](std::uint32_t atom) {
    const glm::vec3 center(placed(placement, molecule.positions[atom]) - out.origin);
    const std::uint32_t id = firstId + atom;
    if (object.representation == Representation::surface) {
      const float support = drawnRadius(object, ellipsoids, atom) * static_cast<float>(object.surface.blend);
      out.surfaces.back().balls.push_back({center, support, 1.0f, colors[atom], id});
      return;
    }
    if (object.representation == Representation::ellipsoids && !ellipsoids.isSphere(atom)) {
      const glm::dmat3 axes = turn * ellipsoids.axes(atom);
      out.ellipsoids.push_back({center, static_cast<float>(glm::length(axes[2])), glm::vec3(axes[0]),
                                glm::vec3(axes[1]), colors[atom], id});
    } else {
      out.spheres.push_back({center, drawnRadius(object, ellipsoids, atom), colors[atom], id});
    }
    if (bonds) {
      centers[atom] = center;
      ids[atom] = id;
    }
  });
  if (!bonds) return;
  const float radius = bondRadius(object);
  for (const Bond& bond : molecule.bonds) {
    if (ids[bond.a] == kNotDrawn || ids[bond.b] == kNotDrawn) continue;
    out.cylinders.push_back(
        {centers[bond.a], radius, centers[bond.b], colors[bond.a], colors[bond.b], ids[bond.a], ids[bond.b]});
  }
}

// Whether an object's atoms are those of the object before it, only drawn in another way.
bool sharesIds(const Scene& scene, std::size_t object) {
  return object > 0 && scene.objects[object].molecule == scene.objects[object - 1].molecule &&
         scene.objects[object].placements == scene.objects[object - 1].placements;
}

MetaballField emptyField(const SurfaceShape& shape) {
  MetaballField field;
  field.kernel = shape.kernel;
  field.level = shape.level.value_or(levelOfBlend(shape.kernel, shape.blend));
  return field;
}

// Dashes of a dashed line and the gaps between them [Å], longer in lines of more dashes than anybody sees.
constexpr double kDash = 0.3, kGap = 0.2, kMostDashes = 10000;

void addDashes(const DashedLine& line, std::uint32_t id, Primitives& out) {
  const double length = glm::length(line.to - line.from);
  const glm::dvec3 step = length > 0 ? (line.to - line.from) / length : glm::dvec3(0.0);
  const double longer = std::max(1.0, length / (kMostDashes * (kDash + kGap)));
  const double dash = longer * kDash, period = longer * (kDash + kGap);
  const auto count = static_cast<std::size_t>(std::ceil(length / period));
  for (std::size_t i = 0; i < count; ++i) {
    const double from = static_cast<double>(i) * period;
    const glm::vec3 a(line.from + from * step - out.origin);
    const glm::vec3 b(line.from + std::min(from + dash, length) * step - out.origin);
    if (a != b)
      out.cylinders.push_back({a, static_cast<float>(line.radius), b, line.color, line.color, id, id});
  }
}

// Adds the groups of all ids of one placement.
void addGroups(const Molecule& molecule, LineGroups groups, std::uint32_t& nextGroup,
               std::vector<std::uint32_t>& out) {
  const bool chains = groups == LineGroups::chains;
  for (std::size_t atom = 0; atom < molecule.atomCount(); ++atom) {
    out.push_back(nextGroup + (chains ? molecule.chainOf(atom) : molecule.residueOf[atom]));
  }
  nextGroup += static_cast<std::uint32_t>(chains ? molecule.chains.size() : molecule.residues.size());
}

}  // namespace

std::size_t countIds(const Scene& scene) {
  std::size_t ids = scene.dashes.size();
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    if (!sharesIds(scene, i)) ids += object.molecule->atomCount() * object.placements.size();
  }
  return ids;
}

std::optional<PlacedAtom> atomOfId(const Scene& scene, std::uint32_t id) {
  std::uint64_t first = 1;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    if (sharesIds(scene, i)) continue;
    const std::uint64_t atoms = object.molecule->atomCount();
    if (id >= first && id < first + atoms * object.placements.size()) {
      const auto atom = static_cast<std::uint32_t>((id - first) % atoms);
      const Placement& placement = object.placements[(id - first) / atoms];
      return PlacedAtom{object.molecule, atom, placed(placement, object.molecule->positions[atom])};
    }
    first += atoms * object.placements.size();
  }
  return std::nullopt;
}

bool needsBonds(Representation representation) {
  return representation != Representation::spacefill && representation != Representation::surface &&
         !followsBackbone(representation);
}

Primitives buildPrimitives(const Scene& scene, LineGroups groups) {
  Primitives out;
  out.origin = middleOf(scene);
  std::size_t spheres = 0;
  for (const SceneObject& object : scene.objects) {
    for (const Placement& placement : object.placements) {
      if (object.representation != Representation::ellipsoids &&
          object.representation != Representation::surface && !followsBackbone(object.representation))
        forEachAtom(object, placement, [&](std::uint32_t) { ++spheres; });
    }
  }
  if (countIds(scene) > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError(
        "the scene has more than 4,294,967,294 atoms; draw a part of it (--select, fewer copies)");
  }
  out.spheres.reserve(spheres);

  const bool grouped = groups == LineGroups::residues || groups == LineGroups::chains;
  if (grouped) out.groups.assign(1, 0);
  std::uint32_t firstId = 1, nextId = 1, nextGroup = 1;
  std::vector<std::uint32_t> scratch;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    const std::vector<Rgb> colors =
        object.colors.empty() ? colorAtoms(*object.molecule, object.coloring) : object.colors;
    const Ellipsoids ellipsoids(object);
    const BackboneObject backbone(object);
    const auto atoms = static_cast<std::uint32_t>(object.molecule->atomCount());
    const bool shared = sharesIds(scene, i);
    if (!shared) firstId = nextId;
    if (object.representation == Representation::surface) out.surfaces.push_back(emptyField(object.surface));
    std::uint32_t id = firstId;
    for (const Placement& placement : object.placements) {
      if (followsBackbone(object.representation)) {
        backbone.addPlacement(placement, colors, id, out);
      } else {
        addPlacement(object, placement, colors, ellipsoids, scratch, id, out);
      }
      if (grouped && !shared) addGroups(*object.molecule, groups, nextGroup, out.groups);
      id += atoms;
    }
    nextId = id;
    if (!out.surfaces.empty() && out.surfaces.back().balls.empty()) out.surfaces.pop_back();
  }
  for (const DashedLine& line : scene.dashes) {
    if (grouped) out.groups.push_back(nextGroup++);
    addDashes(line, nextId++, out);
  }
  return out;
}

double Primitives::thinnestRadius() const {
  if (!mesh.empty()) return 0;
  float least = std::numeric_limits<float>::infinity();
  for (const SpherePrimitive& s : spheres) least = std::min(least, s.radius);
  for (const CylinderPrimitive& c : cylinders) least = std::min(least, c.radius);
  for (const EllipsoidPrimitive& e : ellipsoids) least = std::min(least, e.shortest);
  for (const MetaballField& field : surfaces)
    for (const Metaball& b : field.balls) least = std::min(least, 0.5f * b.support);
  return static_cast<double>(least);
}

BoundingSphere Primitives::bounds() const {
  if (empty()) return {origin, 0.0};
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
  for (const EllipsoidPrimitive& e : ellipsoids) grow(e.center, glm::length(e.axisA));
  for (const TriangleVertex& v : mesh.vertices) grow(v.position, 0);
  for (const MetaballField& field : surfaces)
    for (const Metaball& b : field.balls) grow(b.center, b.support);
  const glm::vec3 middle = (low + high) * 0.5f;
  double radius = 0;
  for (const SpherePrimitive& s : spheres) {
    radius = std::max(radius, static_cast<double>(glm::length(s.center - middle) + s.radius));
  }
  for (const CylinderPrimitive& c : cylinders) {
    const float reach = std::max(glm::length(c.a - middle), glm::length(c.b - middle));
    radius = std::max(radius, static_cast<double>(reach + c.radius));
  }
  for (const EllipsoidPrimitive& e : ellipsoids) {
    radius = std::max(radius, static_cast<double>(glm::length(e.center - middle) + glm::length(e.axisA)));
  }
  for (const TriangleVertex& v : mesh.vertices)
    radius = std::max(radius, static_cast<double>(glm::length(v.position - middle)));
  for (const MetaballField& field : surfaces) {
    for (const Metaball& b : field.balls)
      radius = std::max(radius, static_cast<double>(glm::length(b.center - middle) + b.support));
  }
  return {origin + glm::dvec3(middle), radius};
}

void addFitSpheres(std::span<const SceneObject> objects, std::vector<FitSphere>& out) {
  for (const SceneObject& object : objects) {
    const std::vector<FitSphere> some = fitSpheres(object);
    out.insert(out.end(), some.begin(), some.end());
  }
}

std::vector<FitSphere> fitSpheres(const SceneObject& object, const std::vector<std::uint32_t>& atoms) {
  std::vector<FitSphere> out;
  const Ellipsoids ellipsoids(object);
  const bool ribbons = followsBackbone(object.representation);
  const std::vector<double> reach = ribbons ? backboneReach(object) : std::vector<double>();
  std::vector<bool> chosen;
  if (!atoms.empty()) {
    chosen.resize(object.molecule->atomCount());
    for (const std::uint32_t atom : atoms) chosen[atom] = true;
  }
  for (const Placement& placement : object.placements) {
    forEachAtom(object, placement, [&](std::uint32_t atom) {
      if (!chosen.empty() && !chosen[atom]) return;
      const double radius = ribbons ? reach[atom] : fitRadius(object, ellipsoids, atom);
      if (radius >= 0) out.push_back({placed(placement, object.molecule->positions[atom]), radius});
    });
  }
  return out;
}

}  // namespace meniscus

#include "core/primitives.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <utility>

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

struct PointBox {
  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};

  void grow(const glm::dvec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  bool empty() const { return !(low.x <= high.x); }
  glm::dvec3 middle() const { return (low + high) * 0.5; }
};

// Of the atoms that a placement holds, where the molecule is.
PointBox boxOf(const SceneObject& object, const Placement& placement) {
  PointBox box;
  forEachAtom(object, placement, [&](std::uint32_t atom) { box.grow(object.molecule->positions[atom]); });
  return box;
}

// Centre of the box around everything that is drawn.
glm::dvec3 middleOf(const Scene& scene) {
  PointBox all;
  for (const SceneObject& object : scene.objects) {
    for (const std::vector<std::uint32_t>& alike : alikePlacements(object.placements)) {
      const PointBox here = boxOf(object, object.placements[alike.front()]);
      if (here.empty()) continue;
      const glm::dvec3 half = (here.high - here.low) * 0.5;
      for (const std::uint32_t i : alike) {
        const Placement& placement = object.placements[i];
        // The box, turned with its atoms, and a box around that: most placements add nothing.
        const glm::dvec3 middle = placed(placement, here.middle());
        glm::dvec3 reach(0.0);
        for (int k = 0; k < 3; ++k) reach += glm::abs(glm::dvec3(placement.transform[k])) * half[k];
        if (glm::all(glm::lessThanEqual(all.low, middle - reach)) &&
            glm::all(glm::greaterThanEqual(all.high, middle + reach)))
          continue;
        forEachAtom(object, placement, [&](std::uint32_t atom) {
          all.grow(placed(placement, object.molecule->positions[atom]));
        });
      }
    }
  }
  return all.empty() ? glm::dvec3(0.0) : all.middle();
}

// How the atoms of an object look, wherever it stands.
struct Look {
  std::vector<Rgb> colors;
  Ellipsoids ellipsoids;

  explicit Look(const SceneObject& object)
      : colors(object.colors.empty() ? colorAtoms(*object.molecule, object.coloring) : object.colors),
        ellipsoids(object) {}
};

// Adds one placement of an object, relative to `origin`.
void addQuadrics(const SceneObject& object, const Placement& placement, const Look& look,
                 std::uint32_t firstId, const glm::dvec3& origin, Quadrics& out) {
  const Molecule& molecule = *object.molecule;
  const bool bonds = needsBonds(object.representation);
  const glm::dmat3 turn(placement.transform);
  std::vector<glm::vec3> centers(bonds ? molecule.atomCount() : 0);
  std::vector<std::uint32_t> ids(centers.size(), kNotDrawn);

  forEachAtom(object, placement, [&](std::uint32_t atom) {
    const glm::vec3 center(placed(placement, molecule.positions[atom]) - origin);
    const std::uint32_t id = firstId + atom;
    if (object.representation == Representation::ellipsoids && !look.ellipsoids.isSphere(atom)) {
      const glm::dmat3 axes = turn * look.ellipsoids.axes(atom);
      out.ellipsoids.push_back({center, static_cast<float>(glm::length(axes[2])), glm::vec3(axes[0]),
                                glm::vec3(axes[1]), look.colors[atom], id});
    } else {
      out.spheres.push_back({center, drawnRadius(object, look.ellipsoids, atom), look.colors[atom], id});
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
    out.cylinders.push_back({centers[bond.a], radius, centers[bond.b], look.colors[bond.a],
                             look.colors[bond.b], ids[bond.a], ids[bond.b]});
  }
}

void addBalls(const SceneObject& object, const Placement& placement, const Look& look, std::uint32_t firstId,
              const glm::dvec3& origin, MetaballField& out) {
  forEachAtom(object, placement, [&](std::uint32_t atom) {
    const glm::vec3 center(placed(placement, object.molecule->positions[atom]) - origin);
    const float support =
        drawnRadius(object, look.ellipsoids, atom) * static_cast<float>(object.surface.blend);
    out.balls.push_back({center, support, 1.0f, look.colors[atom], firstId + atom});
  });
}

// A unit of fewer quadrics takes hardly more memory in every place than its copy does.
constexpr std::size_t kLeastUnit = 64;
// The most by which the columns of a placement's matrix may differ from unit length and right angles [1]:
// matrices in files are rounded to six digits.
constexpr double kMostSkew = 1e-5;

bool isRigid(const glm::dmat4& transform) {
  const glm::dmat3 turn(transform), product = glm::transpose(turn) * turn;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row)
      if (!(std::abs(product[column][row] - (row == column ? 1.0 : 0.0)) <= kMostSkew)) return false;
  }
  return true;
}

// Adds all placements of an object; those of the same residues as units, where that is worth it.
void addShared(const SceneObject& object, const Look& look, std::uint32_t firstId, Primitives& out) {
  const auto atoms = static_cast<std::uint32_t>(object.molecule->atomCount());
  for (const std::vector<std::uint32_t>& alike : alikePlacements(object.placements)) {
    Placement once{glm::dmat4(1.0), object.placements[alike.front()].residues};
    const PointBox box = boxOf(object, once);
    if (box.empty()) continue;
    const glm::dvec3 middle = box.middle();
    QuadricUnit unit;
    if (alike.size() > 1) addQuadrics(object, once, look, firstId, middle, unit);
    const bool worthIt = unit.quadricCount() >= kLeastUnit;
    for (const std::uint32_t i : alike) {
      const Placement& placement = object.placements[i];
      if (worthIt && isRigid(placement.transform)) {
        unit.copies.push_back(
            {{glm::dmat3(placement.transform), placed(placement, middle) - out.origin}, i * atoms});
      } else {
        addQuadrics(object, placement, look, firstId + i * atoms, out.origin, out);
      }
    }
    if (!unit.copies.empty()) out.units.push_back(std::move(unit));
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

// Spheres of all placements.
std::size_t countSpheres(const Scene& scene) {
  std::size_t count = 0;
  for (const SceneObject& object : scene.objects) {
    if (!drawsQuadrics(object.representation) || object.representation == Representation::ellipsoids)
      continue;
    for (const Placement& placement : object.placements)
      forEachAtom(object, placement, [&](std::uint32_t) { ++count; });
  }
  return count;
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

bool drawsQuadrics(Representation representation) {
  return representation != Representation::surface && !followsBackbone(representation);
}

Primitives buildPrimitives(const Scene& scene, LineGroups groups, Copies copies) {
  Primitives out;
  out.origin = middleOf(scene);
  if (countIds(scene) > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError(
        "the scene has more than 4,294,967,294 atoms; draw a part of it (--select, fewer copies)");
  }
  if (copies == Copies::apart) out.spheres.reserve(countSpheres(scene));
  const bool grouped = groups == LineGroups::residues || groups == LineGroups::chains;
  if (grouped) out.groups.assign(1, 0);
  std::uint32_t firstId = 1, nextId = 1, nextGroup = 1;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    const Look look(object);
    const BackboneObject backbone(object);
    const auto atoms = static_cast<std::uint32_t>(object.molecule->atomCount());
    const bool shared = sharesIds(scene, i);
    if (!shared) firstId = nextId;
    if (object.representation == Representation::surface) out.surfaces.push_back(emptyField(object.surface));
    const bool asUnits = copies == Copies::shared && drawsQuadrics(object.representation);
    if (asUnits) addShared(object, look, firstId, out);
    nextId = firstId;
    for (const Placement& placement : object.placements) {
      if (followsBackbone(object.representation)) {
        backbone.addPlacement(placement, look.colors, nextId, out);
      } else if (object.representation == Representation::surface) {
        addBalls(object, placement, look, nextId, out.origin, out.surfaces.back());
      } else if (!asUnits) {
        addQuadrics(object, placement, look, nextId, out.origin, out);
      }
      if (grouped && !shared) addGroups(*object.molecule, groups, nextGroup, out.groups);
      nextId += atoms;
    }
    if (!out.surfaces.empty() && out.surfaces.back().balls.empty()) out.surfaces.pop_back();
  }
  for (const DashedLine& line : scene.dashes) {
    if (grouped) out.groups.push_back(nextGroup++);
    addDashes(line, nextId++, out);
  }
  if (out.counts().all() > std::numeric_limits<std::uint32_t>::max()) {
    throw InputError(
        "the scene has more than 4,294,967,295 atoms and bonds; draw a part of it (--select, fewer copies)");
  }
  return out;
}

void addFitSpheres(const SceneObject& object, const std::vector<std::uint32_t>& atoms, FitSpheres& out) {
  const Ellipsoids ellipsoids(object);
  const bool ribbons = followsBackbone(object.representation);
  const std::vector<double> reach = ribbons ? backboneReach(object) : std::vector<double>();
  std::vector<bool> chosen;
  if (!atoms.empty()) {
    chosen.resize(object.molecule->atomCount());
    for (const std::uint32_t atom : atoms) chosen[atom] = true;
  }
  for (const std::vector<std::uint32_t>& alike : alikePlacements(object.placements)) {
    std::vector<FitSphere> spheres;
    forEachAtom(object, object.placements[alike.front()], [&](std::uint32_t atom) {
      if (!chosen.empty() && !chosen[atom]) return;
      const double radius = ribbons ? reach[atom] : fitRadius(object, ellipsoids, atom);
      if (radius >= 0) spheres.push_back({object.molecule->positions[atom], radius});
    });
    std::vector<glm::dmat4> places;
    for (const std::uint32_t i : alike) places.push_back(object.placements[i].transform);
    out.add(std::move(spheres), std::move(places));
  }
}

void addFitSpheres(std::span<const SceneObject> objects, FitSpheres& out) {
  for (const SceneObject& object : objects) addFitSpheres(object, {}, out);
}

std::vector<FitSphere> fitSpheres(const SceneObject& object, const std::vector<std::uint32_t>& atoms) {
  FitSpheres spheres;
  addFitSpheres(object, atoms, spheres);
  std::vector<FitSphere> out;
  out.reserve(spheres.size());
  spheres.forEach([&](const FitSphere& s) { out.push_back(s); });
  return out;
}

}  // namespace meniscus

// Ribbons are closed surfaces with the normals of what they stand for.

#include "core/ribbon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <map>
#include <tuple>

#include "core/assembly.h"
#include "core/primitives.h"
#include "tests/unit/structure_files.h"

namespace meniscus::test {
namespace {

Ribbon ribbonOf(const Molecule& molecule, const std::vector<bool>& chosen = {},
                RibbonStyle style = RibbonStyle::cartoon) {
  return makeRibbon(molecule, findBackbones(molecule), chosen, style, 1);
}

/// Every edge, by the places of its ends, is met as often in one direction as in the other: no crack
/// anywhere.
void expectClosed(const Ribbon& ribbon) {
  using Point = std::tuple<double, double, double>;
  std::map<Point, int> pointIndex;
  std::map<std::pair<int, int>, int> edges;
  const auto indexOf = [&](std::uint32_t v) {
    const glm::dvec3 p = ribbon.vertices[v].position;
    return pointIndex.try_emplace({p.x, p.y, p.z}, static_cast<int>(pointIndex.size())).first->second;
  };
  for (const Ribbon::Triangle& t : ribbon.triangles) {
    const std::array<int, 3> at{indexOf(t.a), indexOf(t.b), indexOf(t.c)};
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = at[i], b = at[(i + 1) % 3];
      edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  std::size_t open = 0;
  for (const auto& [edge, sum] : edges) open += sum != 0 ? 1 : 0;
  EXPECT_EQ(open, 0u) << "of " << edges.size();
}

/// Share of the triangles that do not face the way their corners' normals do: those of folds.
double foldedShare(const Ribbon& ribbon) {
  std::size_t folded = 0;
  for (const Ribbon::Triangle& t : ribbon.triangles) {
    const Ribbon::Vertex &a = ribbon.vertices[t.a], &b = ribbon.vertices[t.b], &c = ribbon.vertices[t.c];
    const glm::dvec3 n = glm::cross(b.position - a.position, c.position - a.position);
    const bool away = std::min({glm::dot(n, a.normal), glm::dot(n, b.normal), glm::dot(n, c.normal)}) < -1e-9;
    folded += away ? 1 : 0;
  }
  return static_cast<double>(folded) / static_cast<double>(ribbon.triangles.size());
}

double volumeOf(const Ribbon& ribbon) {
  double volume = 0;
  for (const Ribbon::Triangle& t : ribbon.triangles)
    volume += glm::dot(ribbon.vertices[t.a].position,
                       glm::cross(ribbon.vertices[t.b].position, ribbon.vertices[t.c].position)) /
              6;
  return volume;
}

TEST(Ribbon, isClosedAndItsNormalsPointOutward) {
  for (const char* name :
       {"1ubq.pdb", "1cbs.cif.gz", "133d.pdb", "1lcd.cif.gz", "2hhb.pdb.gz", "3al1.pdb.gz"}) {
    SCOPED_TRACE(name);
    const Molecule molecule = readMolecule(name);
    for (const RibbonStyle style : {RibbonStyle::cartoon, RibbonStyle::putty}) {
      const Ribbon ribbon = ribbonOf(molecule, {}, style);
      ASSERT_GT(ribbon.triangles.size(), 1000u);
      expectClosed(ribbon);
      EXPECT_GT(volumeOf(ribbon), 40);
      for (const Ribbon::Vertex& v : ribbon.vertices) ASSERT_NEAR(glm::length(v.normal), 1, 1e-9);
      EXPECT_LT(foldedShare(ribbon), 0.01);  // on the inner side of sharp turns, within the ribbon
    }
  }
}

TEST(Ribbon, partsAreClosedTooAndTheWholeBendsThem) {
  const Molecule molecule = readMolecule("1ubq.pdb");
  std::vector<bool> chosen(molecule.atomCount());
  for (std::uint32_t a = molecule.residues[20].atoms.first; a < molecule.residues[45].atoms.end(); ++a)
    chosen[a] = true;
  const Ribbon part = ribbonOf(molecule, chosen);
  expectClosed(part);
  EXPECT_LT(part.triangles.size(), ribbonOf(molecule).triangles.size());
  for (const Ribbon::Triangle& t : part.triangles) EXPECT_TRUE(chosen[t.atom]);
}

TEST(Ribbon, passesItsTraceAtomsAndFillingLiesWithin) {
  const Molecule molecule = readMolecule("2hhb.pdb.gz");  // helices and coils only: the path is not smoothed
  const Ribbon ribbon = ribbonOf(molecule);
  std::vector<double> nearest(molecule.atomCount(), 1e9);
  for (const Ribbon::Ball& ball : ribbon.filling)
    nearest[ball.atom] =
        std::min(nearest[ball.atom], glm::distance(ball.center, molecule.positions[ball.atom]));
  std::size_t checked = 0;
  for (std::uint32_t atom = 0; atom < molecule.atomCount(); ++atom) {
    if (nearest[atom] > 1e8) continue;
    EXPECT_LT(nearest[atom], 1e-6);
    ++checked;
  }
  EXPECT_GT(checked, 500u);
  std::size_t balls = 0, reachingOut = 0;
  for (std::size_t i = 0; i < ribbon.filling.size(); i += 197) {
    const Ribbon::Ball& ball = ribbon.filling[i];
    double outside = 1e9;
    for (const Ribbon::Vertex& v : ribbon.vertices) {
      const double distance = glm::distance(v.position, ball.center);
      if (distance > 1e-9) outside = std::min(outside, distance);  // the middle of a cap lies within
    }
    ++balls;
    reachingOut += outside < 0.85 * ball.radius ? 1 : 0;
  }
  EXPECT_GT(balls, 50u);
  EXPECT_LE(reachingOut, balls / 20) << balls;  // folds, and where pieces end in each other
}

TEST(Ribbon, becomesPrimitivesOfEveryPlacement) {
  auto molecule = std::make_shared<Molecule>(readMolecule("133d.pdb"));
  SceneObject object;
  object.molecule = molecule;
  object.representation = Representation::cartoon;
  object.placements = placeOnce(*molecule);
  Scene scene;
  scene.objects = {object};
  const Primitives one = buildPrimitives(scene);
  EXPECT_EQ(one.cylinders.size(), 12u);  // rungs
  EXPECT_EQ(one.mesh.surfaces.size(), one.mesh.triangles.size());
  object.placements.push_back(object.placements[0]);
  object.placements[1].transform[3].x = 100;
  scene.objects = {object};
  const Primitives two = buildPrimitives(scene);
  EXPECT_EQ(two.mesh.triangles.size(), 2 * one.mesh.triangles.size());
  const auto atoms = static_cast<std::uint32_t>(molecule->atomCount());
  EXPECT_EQ(two.mesh.surfaces.back().id, one.mesh.surfaces.back().id + atoms);
  EXPECT_GT(two.bounds().radius, one.bounds().radius + 40);

  object.placements.resize(1);
  object.representation = Representation::backbone;
  scene.objects = {object};
  const Primitives trace = buildPrimitives(scene);
  EXPECT_EQ(trace.spheres.size(), 12u);
  EXPECT_EQ(trace.cylinders.size(), 10u);
}

// What a placement leaves out neither takes memory nor widens the shadow map.
TEST(Ribbon, ofAPartOfTheMoleculeIsNoLargerThanThat) {
  SceneObject object;
  const auto molecule = std::make_shared<const Molecule>(readMolecule("2hhb.pdb.gz"));
  object.molecule = molecule;
  object.representation = Representation::cartoon;
  object.placements = {{glm::dmat4(1.0), {molecule->chains[0].residues}}};
  Scene scene;
  scene.objects = {object};
  const Primitives part = buildPrimitives(scene);
  ASSERT_FALSE(part.mesh.empty());
  std::vector<bool> used(part.mesh.vertices.size());
  for (const TriangleCorners& t : part.mesh.triangles) used[t.a] = used[t.b] = used[t.c] = true;
  EXPECT_EQ(std::count(used.begin(), used.end(), false), 0);
  scene.objects[0].placements = placeOnce(*molecule);
  EXPECT_LT(part.bounds().radius, 0.8 * buildPrimitives(scene).bounds().radius);
}

}  // namespace
}  // namespace meniscus::test

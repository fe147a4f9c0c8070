// What a scene becomes: which primitives, where, in which colours, with which ids.

#include "core/primitives.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <set>

#include "core/atom_colors.h"
#include "core/reference_tracer.h"
#include "tests/support/random.h"

namespace meniscus {
namespace {

using test::Random;

// A chain of atoms C N O C N O ..., one per residue, each bonded to the next.
std::shared_ptr<Molecule> stringOfAtoms(std::uint32_t count, glm::dvec3 offset = glm::dvec3(0.0)) {
  auto m = std::make_shared<Molecule>();
  Random random(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    m->positions.push_back(offset + glm::dvec3(1.4 * i, 0, 0) + random.inBox(0.5));
    m->elements.push_back(static_cast<std::uint8_t>(6 + i % 3));
    m->bFactors.push_back(0);
    m->residueOf.push_back(i);
    Residue residue;
    residue.atoms = {i, 1};
    m->residues.push_back(residue);
    if (i > 0) m->bonds.push_back({i - 1, i});
  }
  m->chains.push_back({"A", {0, count}});
  return m;
}

SceneObject objectOf(std::shared_ptr<const Molecule> molecule, Representation representation) {
  SceneObject object;
  object.placements = placeOnce(*molecule);
  object.molecule = std::move(molecule);
  object.representation = representation;
  return object;
}

Primitives build(std::vector<SceneObject> objects) {
  Scene scene;
  scene.objects = std::move(objects);
  return buildPrimitives(scene);
}

glm::dvec3 world(const Primitives& p, glm::vec3 point) {
  return p.origin + glm::dvec3(point);
}

TEST(BuildPrimitives, MakesFewDashesOfTheLongestLine) {
  Scene scene;
  scene.dashes.push_back({{0, 0, 0}, {1e7, 0, 0}});
  EXPECT_LE(buildPrimitives(scene).cylinders.size(), 10000u);
  scene.dashes = {{{0, 0, 0}, {1, 0, 0}}};
  EXPECT_EQ(buildPrimitives(scene).cylinders.size(), 2u);
}

TEST(BuildPrimitives, SpacefillIsOneVanDerWaalsSpherePerAtomAndNoBond) {
  const auto m = stringOfAtoms(7);
  const Primitives p = build({objectOf(m, Representation::spacefill)});
  ASSERT_EQ(p.spheres.size(), 7u);
  EXPECT_TRUE(p.cylinders.empty());
  const std::vector<Rgb> colors = colorAtoms(*m, {});
  for (std::uint32_t i = 0; i < 7; ++i) {
    EXPECT_EQ(p.spheres[i].id, i + 1);
    EXPECT_EQ(p.spheres[i].color, colors[i]);
    EXPECT_EQ(p.spheres[i].radius, vanDerWaalsRadius(m->elements[i], RadiusSet::bondi));
    EXPECT_LT(glm::length(world(p, p.spheres[i].center) - m->positions[i]), 1e-6);
  }
  EXPECT_FALSE(needsBonds(Representation::spacefill));
}

TEST(BuildPrimitives, RadiiComeFromTheSetThatIsAskedFor) {
  SceneObject object = objectOf(stringOfAtoms(3), Representation::spacefill);
  object.radii = RadiusSet::alvarez;
  const Primitives p = build({object});
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(p.spheres[i].radius, vanDerWaalsRadius(object.molecule->elements[i], RadiusSet::alvarez));
  }
}

TEST(BuildPrimitives, BallAndStickHasACylinderPerBondInItsAtomsColours) {
  SceneObject object = objectOf(stringOfAtoms(6), Representation::ballAndStick);
  object.ballScale = 0.3;
  object.stickRadius = 0.12;
  const Primitives p = build({object});
  ASSERT_EQ(p.spheres.size(), 6u);
  ASSERT_EQ(p.cylinders.size(), 5u);
  for (std::uint32_t i = 0; i < 5; ++i) {
    const CylinderPrimitive& c = p.cylinders[i];
    EXPECT_EQ(c.idA, i + 1);
    EXPECT_EQ(c.idB, i + 2);
    EXPECT_EQ(c.a, p.spheres[i].center) << "no gap between ball and stick";
    EXPECT_EQ(c.b, p.spheres[i + 1].center);
    EXPECT_EQ(c.colorA, p.spheres[i].color);
    EXPECT_EQ(c.colorB, p.spheres[i + 1].color);
    EXPECT_EQ(c.radius, 0.12f);
    EXPECT_NEAR(p.spheres[i].radius, 0.3f * vanDerWaalsRadius(object.molecule->elements[i], RadiusSet::bondi),
                1e-6f);
  }
}

TEST(BuildPrimitives, LicoriceHasOneRadius) {
  SceneObject object = objectOf(stringOfAtoms(6), Representation::licorice);
  object.licoriceRadius = 0.2;
  const Primitives p = build({object});
  ASSERT_EQ(p.cylinders.size(), 5u);
  for (const SpherePrimitive& s : p.spheres) EXPECT_EQ(s.radius, 0.2f);
  for (const CylinderPrimitive& c : p.cylinders) EXPECT_EQ(c.radius, 0.2f);
  EXPECT_TRUE(needsBonds(Representation::licorice));
  EXPECT_TRUE(needsBonds(Representation::ballAndStick));
}

TEST(BuildPrimitives, PlacementsMoveAtomsAndKeepIdsApart) {
  const auto m = stringOfAtoms(4);
  SceneObject object = objectOf(m, Representation::licorice);
  const glm::dmat4 turn =
      glm::rotate(glm::translate(glm::dmat4(1.0), {30.0, -5.0, 2.0}), 1.0, {0.0, 1.0, 1.0});
  object.placements.push_back({turn, {{0, 4}}});
  const Primitives p = build({object});
  ASSERT_EQ(p.spheres.size(), 8u);
  ASSERT_EQ(p.cylinders.size(), 6u);
  std::set<std::uint32_t> ids;
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec3 expected(turn * glm::dvec4(m->positions[i], 1.0));
    EXPECT_LT(glm::length(world(p, p.spheres[4 + i].center) - expected), 1e-5);
    EXPECT_EQ(p.spheres[4 + i].color, p.spheres[i].color);
  }
  for (const SpherePrimitive& s : p.spheres) EXPECT_TRUE(ids.insert(s.id).second);
  EXPECT_FALSE(ids.contains(0)) << "0 is the background";
  EXPECT_EQ(p.cylinders[3].idA, p.spheres[4].id) << "bonds join the atoms of their own copy";
}

TEST(BuildPrimitives, APartOfAMoleculeHasTheBondsWithinIt) {
  SceneObject object = objectOf(stringOfAtoms(10), Representation::ballAndStick);
  object.placements = {{glm::dmat4(1.0), {{1, 2}, {5, 3}}}};  // residues 1-2 and 5-7
  const Primitives p = build({object});
  ASSERT_EQ(p.spheres.size(), 5u);
  std::vector<std::uint32_t> ids;
  for (const SpherePrimitive& s : p.spheres) ids.push_back(s.id);
  EXPECT_EQ(ids, (std::vector<std::uint32_t>{2, 3, 6, 7, 8})) << "an id is the atom's place in the molecule";
  ASSERT_EQ(p.cylinders.size(), 3u);
  EXPECT_EQ(p.cylinders[0].idA, 2u);
  EXPECT_EQ(p.cylinders[1].idA, 6u);
  EXPECT_EQ(p.cylinders[2].idB, 8u);
}

TEST(BuildPrimitives, SeveralObjectsNumberTheirAtomsOneAfterTheOther) {
  SceneObject second = objectOf(stringOfAtoms(2), Representation::licorice);
  second.coloring = {.scheme = ColorScheme::uniform, .uniform = 0x010203};
  const Primitives p = build({objectOf(stringOfAtoms(3), Representation::spacefill), second});
  ASSERT_EQ(p.spheres.size(), 5u);
  for (std::uint32_t i = 0; i < 5; ++i) EXPECT_EQ(p.spheres[i].id, i + 1);
  EXPECT_EQ(p.spheres[4].color, 0x010203u);
  ASSERT_EQ(p.cylinders.size(), 1u);
  EXPECT_EQ(p.cylinders[0].idA, 4u);
}

TEST(BuildPrimitives, NothingIsAValidScene) {
  const Primitives p = build({});
  EXPECT_TRUE(p.spheres.empty());
  EXPECT_EQ(p.origin, glm::dvec3(0.0));
  EXPECT_EQ(p.bounds().radius, 0.0);
  EXPECT_EQ(build({objectOf(std::make_shared<Molecule>(), Representation::licorice)}).bounds().radius, 0.0);
}

TEST(BuildPrimitives, AMoleculeAMillionAngstromAwayKeepsItsShape) {
  for (const glm::dvec3 offset : {glm::dvec3(1e6), glm::dvec3(-1e6, 1e6, 3e6)}) {
    const auto m = stringOfAtoms(100, offset);
    const Primitives p = build({objectOf(m, Representation::ballAndStick)});
    for (std::size_t i = 0; i < 100; ++i) {
      EXPECT_LT(glm::length(world(p, p.spheres[i].center) - m->positions[i]), 1e-5);
      EXPECT_LT(glm::length(p.spheres[i].center), 100.0f) << "centred on the origin";
    }
  }
}

TEST(Bounds, EncloseEverything) {
  Random random(9);
  for (int round = 0; round < 200; ++round) {
    Primitives p;
    p.origin = random.inBox(1e6);
    const double extent = random.logUniform(0.1, 1e3);
    for (int i = 0; i < 20; ++i) {
      const glm::vec3 a(random.inBox(extent)), b(random.inBox(extent));
      const auto radius = static_cast<float>(random.logUniform(0.01, 10));
      if (round % 3 != 1) p.spheres.push_back({a, radius, 0, 1});
      if (round % 3 != 0) p.cylinders.push_back({a, radius, b, 0, 0, 1, 2});
    }
    const BoundingSphere bounds = p.bounds();
    const double slack = 1e-6 * bounds.radius;  // some roundings to float32, which makeView() allows for
    const auto expectInside = [&](glm::vec3 point, float radius) {
      EXPECT_LE(glm::length(world(p, point) - bounds.center) + static_cast<double>(radius),
                bounds.radius + slack);
    };
    for (const SpherePrimitive& s : p.spheres) expectInside(s.center, s.radius);
    for (const CylinderPrimitive& c : p.cylinders) {
      expectInside(c.a, c.radius);
      expectInside(c.b, c.radius);
    }
    EXPECT_LT(bounds.radius, 1.8 * extent + 20) << "and not much more";
  }
}

TEST(FitSpheres, AreTheDrawnSpheresOfEveryPlacement) {
  SceneObject object = objectOf(stringOfAtoms(5), Representation::ballAndStick);
  object.placements.push_back({glm::translate(glm::dmat4(1.0), {0.0, 0.0, 50.0}), {{2, 2}}});
  const Primitives p = build({object});
  const std::vector<FitSphere> fit = fitSpheres(object);
  ASSERT_EQ(fit.size(), p.spheres.size());
  for (std::size_t i = 0; i < fit.size(); ++i) {
    EXPECT_LT(glm::length(world(p, p.spheres[i].center) - fit[i].center), 1e-5);
    EXPECT_EQ(fit[i].radius, static_cast<double>(p.spheres[i].radius));
  }
}

TEST(FitSpheres, OfSomeAtomsTakeTheseAtomsOfEveryPlacement) {
  const auto m = stringOfAtoms(6);
  SceneObject object = objectOf(m, Representation::spacefill);
  object.placements.push_back({glm::translate(glm::dmat4(1.0), {0.0, 0.0, 50.0}), {{0, 3}}});
  const std::vector<FitSphere> fit = fitSpheres(object, {1, 4});
  ASSERT_EQ(fit.size(), 3u) << "atom 4 is not part of the second placement";
  EXPECT_EQ(fit[0].center, m->positions[1]);
  EXPECT_EQ(fit[1].center, m->positions[4]);
  EXPECT_EQ(fit[2].center, m->positions[1] + glm::dvec3(0, 0, 50));
}

// An object in many places of two kinds, one of them not rigid.
SceneObject assemblyOf(Representation representation) {
  SceneObject object = objectOf(stringOfAtoms(90), representation);
  Random random(4);
  for (std::uint32_t i = 0; i < 20; ++i) {
    const glm::dmat4 turn = glm::mat4_cast(random.rotation());
    object.placements.push_back(
        {glm::translate(glm::dmat4(1.0), random.inBox(500)) * turn, {{0, 80 + i % 2}}});
  }
  object.placements.push_back({glm::scale(glm::dmat4(1.0), {1.1, 1, 1}), {{0, 80}}});
  object.placements.push_back({glm::dmat4(1.0), {{3, 4}}});
  return object;
}

TEST(BuildPrimitives, CopiesOfTheSameResiduesAreOneUnit) {
  for (const Representation representation :
       {Representation::spacefill, Representation::ballAndStick, Representation::ellipsoids}) {
    Scene scene;
    scene.objects = {assemblyOf(representation)};
    const Primitives apart = buildPrimitives(scene),
                     shared = buildPrimitives(scene, LineGroups::none, Copies::shared);
    ASSERT_EQ(shared.units.size(), 2u) << "of 80 and of 81 residues";
    for (const QuadricUnit& unit : shared.units) EXPECT_EQ(unit.copies.size(), 10u);
    EXPECT_EQ(shared.spheres.size(), 90u + 80 + 4) << "in one place; not rigid; too few";
    const QuadricCounts counts = shared.counts();
    EXPECT_EQ(counts.spheres, apart.spheres.size());
    EXPECT_EQ(counts.cylinders, apart.cylinders.size());
    EXPECT_LT(shared.quadricBytes() * 2, apart.quadricBytes());

    Primitives again = copiesApart(shared);
    EXPECT_TRUE(again.units.empty());
    const auto byId = [](const auto& a, const auto& b) { return a.id < b.id; };
    std::sort(again.spheres.begin(), again.spheres.end(), byId);
    ASSERT_EQ(again.spheres.size(), apart.spheres.size());
    for (std::size_t i = 0; i < apart.spheres.size(); ++i) {
      const SpherePrimitive &a = apart.spheres[i], &b = again.spheres[i];
      ASSERT_EQ(a.id, b.id);
      ASSERT_EQ(a.color, b.color);
      ASSERT_EQ(a.radius, b.radius);
      ASSERT_LT(glm::length(a.center - b.center), 1e-4f);
    }
    const auto bondBefore = [](const CylinderPrimitive& a, const CylinderPrimitive& b) {
      return a.idA < b.idA;
    };
    std::sort(again.cylinders.begin(), again.cylinders.end(), bondBefore);
    ASSERT_EQ(again.cylinders.size(), apart.cylinders.size());
    for (std::size_t i = 0; i < apart.cylinders.size(); ++i) {
      const CylinderPrimitive &a = apart.cylinders[i], &b = again.cylinders[i];
      ASSERT_EQ(a.idA, b.idA);
      ASSERT_EQ(a.idB, b.idB);
      ASSERT_EQ(a.colorA, b.colorA);
      ASSERT_LT(glm::length(a.a - b.a) + glm::length(a.b - b.b), 2e-4f);
    }
    const BoundingSphere one = apart.bounds(), other = shared.bounds();
    EXPECT_LT(glm::length(one.center - other.center), 1e-3);
    EXPECT_NEAR(one.radius, other.radius, 1e-3);
  }
}

TEST(BuildPrimitives, CopiesTakeTheMemoryOfTheirUnit) {
  SceneObject object = objectOf(stringOfAtoms(20000), Representation::spacefill);
  object.placements.resize(500, object.placements.front());
  Scene scene;
  scene.objects = {object};
  const Primitives shared = buildPrimitives(scene, LineGroups::none, Copies::shared);
  EXPECT_EQ(shared.counts().spheres, 10'000'000u);
  EXPECT_LT(shared.quadricBytes(), 2 * 20000 * sizeof(SpherePrimitive) + 2 * 500 * sizeof(QuadricCopy));
}

TEST(BuildPrimitives, ASurfaceIsOneFieldOfAllPlacements) {
  const auto m = stringOfAtoms(4);
  SceneObject object = objectOf(m, Representation::surface);
  object.placements.push_back({glm::translate(glm::dmat4(1.0), {0.0, 0.0, 20.0}), {{1, 2}}});
  object.surface.blend = 1.5;
  object.surface.kernel = {KernelShape::power, 4};
  const Primitives p = build({object});
  EXPECT_TRUE(p.spheres.empty());
  EXPECT_TRUE(p.cylinders.empty());
  EXPECT_FALSE(p.empty());
  ASSERT_EQ(p.surfaces.size(), 1u);
  const MetaballField& field = p.surfaces[0];
  EXPECT_EQ(field.kernel, (Kernel{KernelShape::power, 4}));
  EXPECT_EQ(field.level, levelOfBlend(field.kernel, 1.5));
  ASSERT_EQ(field.balls.size(), 6u);
  const std::vector<Rgb> colors = colorAtoms(*m, {});
  const std::uint32_t atoms[] = {0, 1, 2, 3, 1, 2};
  for (std::size_t i = 0; i < 6; ++i) {
    const Metaball& ball = field.balls[i];
    const float radius = vanDerWaalsRadius(m->elements[atoms[i]], RadiusSet::bondi);
    EXPECT_FLOAT_EQ(ball.support, radius * 1.5f);
    EXPECT_EQ(ball.coefficient, 1.0f);
    EXPECT_EQ(ball.color, colors[atoms[i]]);
    EXPECT_EQ(ball.id, i < 4 ? i + 1 : 5 + atoms[i]);
    const glm::dvec3 place = m->positions[atoms[i]] + glm::dvec3(0, 0, i < 4 ? 0 : 20);
    EXPECT_LT(glm::length(world(p, ball.center) - place), 1e-5);
    EXPECT_LE(glm::length(place - p.bounds().center) + static_cast<double>(ball.support),
              p.bounds().radius + 1e-4);
  }
  object.surface.level = 0.25;
  EXPECT_EQ(build({object}).surfaces[0].level, 0.25);
  EXPECT_FALSE(needsBonds(Representation::surface));
  EXPECT_TRUE(build({objectOf(std::make_shared<Molecule>(), Representation::surface)}).empty());
}

TEST(BuildPrimitives, ObjectsOfOneMoleculeShareItsIds) {
  const auto m = stringOfAtoms(6);
  SceneObject surface = objectOf(m, Representation::surface), sticks = objectOf(m, Representation::licorice);
  surface.atoms = {0, 1, 2, 5};
  sticks.atoms = {3, 4};
  Scene scene;
  scene.objects = {surface, sticks, objectOf(stringOfAtoms(2), Representation::spacefill)};
  const Primitives p = buildPrimitives(scene, LineGroups::residues);
  EXPECT_EQ(countIds(scene), 8u);
  EXPECT_EQ(p.groups.size(), 9u);
  ASSERT_EQ(p.surfaces.size(), 1u);
  std::vector<std::uint32_t> ids;
  for (const Metaball& ball : p.surfaces[0].balls) ids.push_back(ball.id);
  EXPECT_EQ(ids, (std::vector<std::uint32_t>{1, 2, 3, 6}));
  ASSERT_EQ(p.spheres.size(), 4u);
  EXPECT_EQ(p.spheres[0].id, 4u);
  EXPECT_EQ(p.spheres[1].id, 5u);
  EXPECT_EQ(p.spheres[2].id, 7u) << "another molecule";
  ASSERT_EQ(p.cylinders.size(), 1u) << "the bonds to what is drawn otherwise are not drawn";
  EXPECT_EQ(fitSpheres(sticks).size(), 2u);
  sticks.placements.push_back(sticks.placements.front());
  scene.objects = {surface, sticks};
  EXPECT_EQ(countIds(scene), 18u) << "other placements are other atoms";
}

TEST(FitSpheres, HoldASurfaceThatBulges) {
  constexpr int kSide = 48;
  auto m = std::make_shared<Molecule>();
  Random random(5);
  for (std::uint32_t i = 0; i < 40; ++i) {
    m->positions.push_back(random.inBox(4));
    m->elements.push_back(6);
    m->residueOf.push_back(0);
  }
  m->bFactors.resize(40);
  Residue residue;
  residue.atoms = {0, 40};
  m->residues.push_back(residue);
  m->chains.push_back({"A", {0, 1}});
  for (const double blend : {1.1, 2.0, 3.0, 6.0}) {
    SceneObject object = objectOf(m, Representation::surface);
    object.surface.blend = blend;
    const Primitives p = build({object});
    const View view = makeView(fitted({}, {kSide, kSide}, fitSpheres(object)), {kSide, kSide}, p.bounds());
    const std::vector<double> distance =
        traceReference(p.surfaces, p.origin, view, {.grazing = false}).distance;
    std::size_t hits = 0;
    for (std::size_t i = 0; i < distance.size(); ++i) {
      if (std::isinf(distance[i])) continue;
      ++hits;
      const std::size_t x = i % kSide, y = i / kSide;
      EXPECT_TRUE(x > 0 && y > 0 && x + 1 < kSide && y + 1 < kSide) << "blend " << blend;
    }
    EXPECT_GT(hits, distance.size() / 4) << "blend " << blend;
  }
}

TEST(BuildPrimitives, GroupsNumberResiduesOrChainsOfEveryPlacement) {
  const auto m = stringOfAtoms(3);
  SceneObject object = objectOf(m, Representation::spacefill);
  object.placements.push_back(object.placements.front());
  Scene scene;
  scene.objects = {object};
  using Groups = std::vector<std::uint32_t>;
  EXPECT_TRUE(buildPrimitives(scene).groups.empty());
  EXPECT_TRUE(buildPrimitives(scene, LineGroups::atoms).groups.empty()) << "ids are enough";
  EXPECT_EQ(buildPrimitives(scene, LineGroups::residues).groups, (Groups{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(buildPrimitives(scene, LineGroups::chains).groups, (Groups{0, 1, 1, 1, 2, 2, 2}));
}

}  // namespace
}  // namespace meniscus

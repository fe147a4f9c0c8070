// Displacement ellipsoids: probabilities, tensors of every kind, what is drawn for them, what is noted.

#include "core/displacement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/primitives.h"
#include "core/symmetric_eigen.h"
#include "tests/support/random.h"

namespace meniscus {
namespace {

using test::Random;

constexpr double kIsotropic = 8 * M_PI * M_PI;  // B = 8 pi^2 U

// One residue of carbons in a row, each bonded to the next, without displacements.
std::shared_ptr<Molecule> rowOfAtoms(std::uint32_t count) {
  auto m = std::make_shared<Molecule>();
  for (std::uint32_t i = 0; i < count; ++i) {
    m->positions.emplace_back(1.5 * i, 0, 0);
    m->elements.push_back(6);
    m->names.emplace_back("C" + std::to_string(i + 1));
    m->bFactors.push_back(0);
    m->residueOf.push_back(0);
    if (i > 0) m->bonds.push_back({i - 1, i});
  }
  Residue residue;
  residue.name = "LIG";
  residue.number = 7;
  residue.atoms = {0, count};
  m->residues.push_back(residue);
  m->chains.push_back({"A", {0, 1}});
  m->anisotropies.resize(count);
  return m;
}

Anisotropy tensorOf(const glm::dmat3& turn, const glm::dvec3& squares) {
  const glm::dmat3 u =
      turn * glm::dmat3({squares.x, 0, 0}, {0, squares.y, 0}, {0, 0, squares.z}) * glm::transpose(turn);
  Anisotropy a;
  a.u11 = static_cast<float>(u[0][0]);
  a.u22 = static_cast<float>(u[1][1]);
  a.u33 = static_cast<float>(u[2][2]);
  a.u12 = static_cast<float>(u[0][1]);
  a.u13 = static_cast<float>(u[0][2]);
  a.u23 = static_cast<float>(u[1][2]);
  return a;
}

SceneObject objectOf(std::shared_ptr<const Molecule> molecule) {
  SceneObject object;
  object.placements = placeOnce(*molecule);
  object.molecule = std::move(molecule);
  object.representation = Representation::ellipsoids;
  return object;
}

Primitives primitivesOf(const SceneObject& object) {
  Scene scene;
  scene.objects.push_back(object);
  return buildPrimitives(scene);
}

// Square roots of quantiles of chi-square with three degrees of freedom.
TEST(DisplacementScale, HasTheKnownValues) {
  const std::pair<double, double> known[] = {{0.5, 1.5381722},  // 1.5382 in ORTEP-III
                                             {0.9, 2.5002777}, {0.95, 2.7954835}, {0.99, 3.3682142},
                                             {0.1, 0.7644438}, {0.999, 4.0331422}};
  for (const auto& [probability, scale] : known)
    EXPECT_NEAR(displacementScale(probability), scale, 2e-6) << probability;
}

TEST(DisplacementScale, InvertsTheProbability) {
  for (double p = 1e-9; p < 0.9999; p = p * 1.37 + 1e-10) {
    const double s = displacementScale(p);
    // Simpson's rule over the density of the distance.
    constexpr int kSteps = 2000;
    double sum = 0;
    for (int i = 0; i <= kSteps; ++i) {
      const double x = s * i / kSteps;
      const double weight = i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2;
      sum += weight * std::sqrt(2 / M_PI) * x * x * std::exp(-0.5 * x * x);
    }
    EXPECT_NEAR(sum * s / kSteps / 3, p, 1e-10 * p) << p;
  }
  double before = 0;
  for (const double p : {1e-300, 1e-12, 0.1, 0.5, 0.9, 1 - 1e-9, 1 - 1e-15, std::nextafter(1.0, 0.0)}) {
    const double s = displacementScale(p);
    EXPECT_TRUE(std::isfinite(s));
    EXPECT_GT(s, before) << p;
    before = s;
  }
  EXPECT_NEAR(displacementScale(1e-9), std::cbrt(3e-9 * std::sqrt(M_PI / 2)), 1e-8);
}

TEST(SymmetricEigen, RebuildsTheMatrix) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const glm::dmat3 turn = glm::mat3_cast(random.rotation());
    const glm::dvec3 values(random.signedLog(1e-6, 1e3), random.signedLog(1e-6, 1e3),
                            random.signedLog(1e-6, 1e3));
    const glm::dmat3 m =
        turn * glm::dmat3({values.x, 0, 0}, {0, values.y, 0}, {0, 0, values.z}) * glm::transpose(turn);
    const SymmetricEigen e = symmetricEigen(0.5 * (m + glm::transpose(m)));
    const double size = std::max({std::abs(values.x), std::abs(values.y), std::abs(values.z)});
    for (int k = 0; k < 3; ++k) {
      EXPECT_LT(glm::length(m * e.vectors[k] - e.values[k] * e.vectors[k]), 1e-13 * size);
      EXPECT_NEAR(glm::length(e.vectors[k]), 1, 1e-13);
    }
  }
}

TEST(Displacements, ArePrincipalAxesOfTheTensorLongestFirst) {
  Random random(2);
  auto m = rowOfAtoms(200);
  for (Anisotropy& a : m->anisotropies) {
    a = tensorOf(glm::mat3_cast(random.rotation()),
                 {random.uniform(0.01, 1), random.uniform(0.01, 1), random.uniform(0.01, 1)});
  }
  const std::vector<Displacement> all = displacementsOf(*m);
  ASSERT_EQ(all.size(), 200u);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Displacement& d = all[i];
    EXPECT_EQ(d.source, DisplacementSource::tensor);
    EXPECT_FALSE(d.isotropic);
    const glm::dmat3 u = d.axes * glm::transpose(d.axes);
    const Anisotropy& a = m->anisotropies[i];
    EXPECT_NEAR(u[0][0], static_cast<double>(a.u11), 1e-7);
    EXPECT_NEAR(u[1][2], static_cast<double>(a.u23), 1e-7);
    EXPECT_NEAR(u[0][2], static_cast<double>(a.u13), 1e-7);
    EXPECT_GE(glm::length(d.axes[0]), glm::length(d.axes[1]));
    EXPECT_GE(glm::length(d.axes[1]), glm::length(d.axes[2]));
    EXPECT_NEAR(glm::dot(d.axes[0], d.axes[1]), 0, 1e-14);
  }
}

TEST(Displacements, FallBackToBAndToTheIsotropicPart) {
  auto m = rowOfAtoms(6);
  m->bFactors = {20, 0, 20, 20, -3, NAN};
  m->anisotropies[2] = tensorOf(glm::dmat3(1.0), {0.3, 0.2, -0.05});   // not positive definite
  m->anisotropies[3] = tensorOf(glm::dmat3(1.0), {0.1, -0.2, -0.05});  // nor is its trace
  const std::vector<Displacement> d = displacementsOf(*m);
  EXPECT_EQ(d[0].source, DisplacementSource::isotropicB);
  EXPECT_NEAR(d[0].axes[0].x, std::sqrt(20 / kIsotropic), 1e-12);
  EXPECT_TRUE(d[0].isotropic);
  EXPECT_EQ(d[1].source, DisplacementSource::none) << "B = 0 says nothing";
  EXPECT_EQ(d[2].source, DisplacementSource::isotropicPart);
  EXPECT_TRUE(d[2].isotropic);
  EXPECT_NEAR(d[2].axes[1].y, std::sqrt(0.15), 1e-7);
  EXPECT_EQ(d[3].source, DisplacementSource::none);
  EXPECT_EQ(d[4].source, DisplacementSource::none);
  EXPECT_EQ(d[5].source, DisplacementSource::none);

  Logger logger;
  noteOddDisplacements(*m, logger);
  EXPECT_EQ(logger.notes(),
            (std::vector<std::string>{
                "2 displacement tensors are not positive definite, first C3 of LIG 7 A; drawn as the "
                "isotropic part",
                "4 atoms have no displacement, first C2 of LIG 7 A; drawn as small spheres"}));
}

TEST(Displacements, AFlatTensorIsNotPositiveDefinite) {
  auto m = rowOfAtoms(1);
  m->anisotropies[0] = tensorOf(glm::mat3_cast(glm::angleAxis(1.0, glm::dvec3(0.6, 0.8, 0))), {0.3, 0.2, 0});
  EXPECT_EQ(displacementsOf(*m)[0].source, DisplacementSource::isotropicPart);
  Logger logger;
  noteOddDisplacements(*m, logger);
  ASSERT_EQ(logger.notes().size(), 1u);
  EXPECT_EQ(
      logger.notes()[0],
      "1 displacement tensor is not positive definite, first C1 of LIG 7 A; drawn as the isotropic part");
}

TEST(Displacements, APredictedModelsBIsNone) {
  auto m = rowOfAtoms(2);
  m->anisotropies.clear();
  m->bFactors = {90, 80};
  Logger logger;
  noteOddDisplacements(*m, logger);
  EXPECT_TRUE(logger.notes().empty());
  m->predicted = true;
  for (const Displacement& d : displacementsOf(*m)) EXPECT_EQ(d.source, DisplacementSource::none);
  noteOddDisplacements(*m, logger);
  ASSERT_EQ(logger.notes().size(), 1u);
  EXPECT_NE(logger.notes()[0].find("confidence"), std::string::npos);
}

TEST(BuildEllipsoids, SpheresStaySpheres) {
  auto m = rowOfAtoms(4);
  m->bFactors = {30, 30, 30, 0};
  m->anisotropies[1] = tensorOf(glm::dmat3(1.0), {0.4, 0.1, 0.2});
  m->anisotropies[2] = tensorOf(glm::dmat3(1.0), {0.25, 0.25, 0.25});
  SceneObject object = objectOf(m);
  object.probability = 0.9;
  object.ellipsoidStickRadius = 0.05;
  const Primitives p = primitivesOf(object);
  const double scale = 2.5002777;
  ASSERT_EQ(p.spheres.size(), 3u);
  EXPECT_NEAR(static_cast<double>(p.spheres[0].radius), scale * std::sqrt(30 / kIsotropic), 1e-5);
  EXPECT_NEAR(static_cast<double>(p.spheres[1].radius), scale * 0.5, 1e-5);
  EXPECT_EQ(p.spheres[2].radius, 0.1f) << "no displacement: small, at any probability";
  ASSERT_EQ(p.ellipsoids.size(), 1u);
  const EllipsoidPrimitive& e = p.ellipsoids[0];
  EXPECT_EQ(e.id, 2u);
  EXPECT_NEAR(std::abs(static_cast<double>(e.axisA.x)), scale * std::sqrt(0.4), 1e-5);
  EXPECT_NEAR(std::abs(static_cast<double>(e.axisB.z)), scale * std::sqrt(0.2), 1e-5);
  EXPECT_NEAR(static_cast<double>(e.shortest), scale * std::sqrt(0.1), 1e-5);
  ASSERT_EQ(p.cylinders.size(), 3u);
  EXPECT_EQ(p.cylinders[0].radius, 0.05f);
  EXPECT_EQ(p.cylinders[0].idB, 2u);
  EXPECT_EQ(p.cylinders[1].a, e.center);
  EXPECT_TRUE(needsBonds(Representation::ellipsoids));
}

TEST(BuildEllipsoids, NothingIsAllocatedForThoseWithoutTensors) {
  auto m = rowOfAtoms(3);
  m->anisotropies.clear();
  m->bFactors = {10, 20, 30};
  const Primitives p = primitivesOf(objectOf(m));
  EXPECT_EQ(p.spheres.size(), 3u);
  EXPECT_EQ(p.ellipsoids.capacity(), 0u);
}

TEST(BuildEllipsoids, PlacementsTurnTheTensors) {
  auto m = rowOfAtoms(1);
  m->anisotropies[0] =
      tensorOf(glm::mat3_cast(glm::angleAxis(0.7, glm::dvec3(0.6, 0, 0.8))), {0.4, 0.1, 0.2});
  SceneObject object = objectOf(m);
  const glm::dmat4 turn =
      glm::rotate(glm::translate(glm::dmat4(1.0), {9.0, -5.0, 2.0}), 1.1, {0.0, 1.0, 1.0});
  object.placements.push_back({turn, {{0, 1}}});
  const Primitives p = primitivesOf(object);
  ASSERT_EQ(p.ellipsoids.size(), 2u);
  const glm::dmat3 rotation(turn);
  EXPECT_LT(glm::length(rotation * glm::dvec3(p.ellipsoids[0].axisA) - glm::dvec3(p.ellipsoids[1].axisA)),
            1e-6);
  EXPECT_LT(glm::length(rotation * glm::dvec3(p.ellipsoids[0].axisB) - glm::dvec3(p.ellipsoids[1].axisB)),
            1e-6);
  EXPECT_NEAR(p.ellipsoids[0].shortest, p.ellipsoids[1].shortest, 1e-6f);
}

TEST(BuildEllipsoids, BoundsAndCameraHoldTheLongestAxis) {
  auto m = rowOfAtoms(2);
  m->bFactors = {20, 20};
  m->anisotropies[1] = tensorOf(glm::dmat3(1.0), {0.1, 4.0, 0.2});
  const SceneObject object = objectOf(m);
  const Primitives p = primitivesOf(object);
  const std::vector<FitSphere> fit = fitSpheres(object);
  ASSERT_EQ(fit.size(), 2u);
  EXPECT_NEAR(fit[1].radius, 2 * displacementScale(0.5), 1e-6);
  const BoundingSphere bounds = p.bounds();
  for (const FitSphere& s : fit)
    EXPECT_LE(glm::length(s.center - bounds.center) + s.radius, bounds.radius * (1 + 1e-6));
  Primitives alone;
  alone.ellipsoids = p.ellipsoids;
  EXPECT_FALSE(alone.empty());
  EXPECT_GT(alone.bounds().radius, 3.0);
}

}  // namespace
}  // namespace meniscus

// Cameras from data: nothing outside the picture, nothing wasted, the same picture whatever the order of the
// atoms.

#include "core/camera_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <limits>
#include <vector>

#include "tests/support/random.h"

namespace meniscus {
namespace {

using test::Random;

// Without symmetry: a stretched, bent cloud.
std::vector<FitSphere> cloud(Random& random, int count, glm::dvec3 offset = glm::dvec3(0.0)) {
  const glm::dvec3 extent(random.uniform(20, 40), random.uniform(10, 18), random.uniform(3, 8));
  const glm::dquat turn = random.rotation();
  std::vector<FitSphere> out;
  for (int i = 0; i < count; ++i) {
    glm::dvec3 p = random.inBox(1);
    p += 0.5 * p * p;  // skewed along each axis
    out.push_back({offset + turn * (p * extent), random.uniform(0.5, 2.5)});
  }
  return out;
}

// Room [share of the picture's half size] between the spheres and the picture's edges; negative: cut off.
// Written from the definition of a view: a sphere is inside a plane of the frustum if its centre is at least
// a radius away from it.
struct Room {
  double left, right, bottom, top, front;
};
Room roomAround(const Camera& camera, ImageSize size, const std::vector<FitSphere>& spheres) {
  const View view = makeView(camera, size, {camera.target, 1});
  const double halfX = 0.5 * size.width * view.pixelSize, halfY = 0.5 * size.height * view.pixelSize;
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Room room{kFar, kFar, kFar, kFar, kFar};
  for (const FitSphere& s : spheres) {
    const glm::dvec3 p = view.rotation * (s.center - view.pivot);
    // Largest |slope| of a tangent plane through the eye (perspective), or the silhouette's edge
    // (orthographic).
    const auto edge = [&](double at, double sign) {
      if (view.projection == Projection::orthographic) return sign * at + s.radius;
      const double depth = view.distance - p.z;
      return std::tan(std::atan2(sign * at, depth) + std::asin(s.radius / std::hypot(at, depth)));
    };
    room.right = std::min(room.right, 1 - edge(p.x, 1) / halfX);
    room.left = std::min(room.left, 1 - edge(p.x, -1) / halfX);
    room.top = std::min(room.top, 1 - edge(p.y, 1) / halfY);
    room.bottom = std::min(room.bottom, 1 - edge(p.y, -1) / halfY);
    room.front = std::min(room.front, view.distance - p.z - s.radius);
  }
  return room;
}

class Fitted : public testing::TestWithParam<Projection> {};
INSTANTIATE_TEST_SUITE_P(Projections, Fitted,
                         testing::Values(Projection::perspective, Projection::orthographic),
                         [](const auto& tested) {
                           return tested.param == Projection::perspective ? "perspective" : "orthographic";
                         });

TEST_P(Fitted, EverythingIsInsideWithTheMarginAndOneAxisIsTight) {
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    const glm::dvec3 offset = i % 3 == 0 ? glm::dvec3(1e6, -1e6, 1e6) : random.inBox(100);
    const std::vector<FitSphere> spheres = cloud(random, 60, offset);
    Camera camera;
    camera.projection = GetParam();
    camera.orientation = random.rotation();
    camera.fovY = random.uniform(0.05, 1.6);
    const ImageSize size{static_cast<int>(random.uniform(50, 3000)),
                         static_cast<int>(random.uniform(50, 3000))};
    const double margin = random.uniform(0, 0.3);
    const Camera fit = fitted(camera, size, spheres, margin);
    const Room room = roomAround(fit, size, spheres);
    const double slack =
        1e-7;  // 1e6 Å away, positions have 1e-10 Å: 1e-12 of the picture; the rest is the tangents'
    EXPECT_GE(std::min({room.left, room.right, room.bottom, room.top}), margin - slack);
    EXPECT_NEAR(std::min({room.left, room.right, room.bottom, room.top}), margin, slack)
        << "larger than needed";
    // Both sides of the tight axis touch: the molecule sits in the middle.
    const bool tightX = std::min(room.left, room.right) < std::min(room.bottom, room.top);
    EXPECT_NEAR(tightX ? room.left : room.bottom, tightX ? room.right : room.top, 2 * slack);
    if (GetParam() == Projection::perspective) {
      EXPECT_GT(room.front, 0);
    }
  }
}

TEST_P(Fitted, KeepsWhatItIsNotAskedToChange) {
  Random random(2);
  Camera camera;
  camera.projection = GetParam();
  camera.orientation = random.rotation();
  camera.fovY = 0.7;
  camera.zoom = 3;
  const Camera fit = fitted(camera, {400, 300}, cloud(random, 20));
  EXPECT_EQ(fit.projection, camera.projection);
  EXPECT_EQ(fit.fovY, camera.fovY);
  EXPECT_EQ(fit.zoom, camera.zoom);
  EXPECT_EQ(fit.orientation, camera.orientation);
  const Camera unchanged = fitted(camera, {400, 300}, {});
  EXPECT_EQ(unchanged.distance, camera.distance);
  EXPECT_EQ(unchanged.target, camera.target);
}

TEST_P(Fitted, OneSphereIsCentredAndFillsTheShorterSide) {
  Camera camera;
  camera.projection = GetParam();
  for (const double radius : {1e-3, 1.7, 1e4}) {
    const std::vector<FitSphere> one{{{1e6, 2, 3}, radius}};
    for (const ImageSize size : {ImageSize{800, 600}, ImageSize{300, 900}, ImageSize{1, 1}}) {
      const Camera fit = fitted(camera, size, one);
      const glm::dvec3 off = glm::mat3_cast(fit.orientation) * (fit.target - one[0].center);
      EXPECT_NEAR(off.x, 0, 1e-9 * radius + 1e-9);
      EXPECT_NEAR(off.y, 0, 1e-9 * radius + 1e-9);
      const Room room = roomAround(fit, size, one);
      EXPECT_NEAR(std::min(room.left, room.bottom), 0.04, 1e-5);
    }
  }
}

TEST_P(Fitted, APointWithoutExtentGivesAFiniteView) {
  Camera camera;
  camera.projection = GetParam();
  const Camera fit = fitted(camera, {10, 10}, std::vector<FitSphere>{{{5, 6, 7}, 0.0}});
  EXPECT_EQ(fit.target, glm::dvec3(5, 6, 7));
  EXPECT_GT(fit.distance, 0);
  EXPECT_LT(fit.distance, 1);
  const View view = makeView(fit, {10, 10}, {{5, 6, 7}, 0});
  EXPECT_GT(view.nearZ, view.farZ);
  EXPECT_GT(view.pixelSize, 0);
}

// Variances along the screen's axes after an orientation.
glm::dvec3 variances(const glm::dquat& orientation, const std::vector<FitSphere>& spheres) {
  glm::dvec3 mean(0.0), sum(0.0);
  for (const FitSphere& s : spheres) mean += s.center / static_cast<double>(spheres.size());
  for (const FitSphere& s : spheres) {
    const glm::dvec3 p = orientation * (s.center - mean);
    sum += p * p;
  }
  return sum;
}

TEST(PrincipalAxes, AreARotationWithTheLongestExtentAcrossOrUp) {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const std::vector<FitSphere> spheres = cloud(random, 50, random.inBox(1000));
    for (const bool tall : {false, true}) {
      const glm::dquat q = principalAxes(spheres, tall);
      EXPECT_NEAR(glm::length(q), 1.0, 1e-12);
      EXPECT_NEAR(glm::determinant(glm::mat3_cast(q)), 1.0, 1e-12);
      const glm::dvec3 v = variances(q, spheres);
      EXPECT_GE(tall ? v.y : v.x, tall ? v.x : v.y);
      EXPECT_GE(std::min(v.x, v.y), v.z);
      // No rotation has a larger variance along the screen's long side: the axes are principal.
      const glm::dvec3 other = variances(glm::angleAxis(0.01, random.direction()) * q, spheres);
      EXPECT_GE((tall ? v.y : v.x) * (1 + 1e-12), tall ? other.y : other.x);
      EXPECT_LE(v.z * (1 - 1e-12), other.z);
    }
  }
}

double angleBetween(const glm::dquat& a, const glm::dquat& b) {
  return 2 * std::acos(std::min(1.0, std::abs(glm::dot(a, b))));
}

TEST(PrincipalAxes, DoNotDependOnTheOrderOfAtoms) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    std::vector<FitSphere> spheres = cloud(random, 80);
    const glm::dquat before = principalAxes(spheres, i % 2 == 0);
    for (std::size_t k = spheres.size(); k-- > 1;) std::swap(spheres[k], spheres[random.index(k + 1)]);
    EXPECT_LT(angleBetween(before, principalAxes(spheres, i % 2 == 0)), 1e-7);
  }
}

// The picture of a rotated and shifted molecule is the picture of the molecule.
TEST(PrincipalAxes, GiveTheSamePictureOfARotatedMolecule) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const std::vector<FitSphere> spheres = cloud(random, 80);
    const glm::dquat turn = random.rotation();
    const glm::dvec3 shift = random.inBox(i % 2 == 0 ? 10 : 1e5);
    std::vector<FitSphere> moved;
    for (const FitSphere& s : spheres) moved.push_back({turn * s.center + shift, s.radius});
    const bool tall = i % 3 == 0;
    EXPECT_LT(angleBetween(principalAxes(spheres, tall), principalAxes(moved, tall) * turn), 1e-6) << i;
  }
}

TEST(PrincipalAxes, DegenerateInputsGiveARotation) {
  const auto expectRotation = [](const std::vector<FitSphere>& spheres) {
    for (const bool tall : {false, true}) {
      const glm::dquat q = principalAxes(spheres, tall);
      EXPECT_NEAR(glm::length(q), 1.0, 1e-12) << spheres.size() << " spheres";
    }
  };
  expectRotation({});
  expectRotation({{{1, 2, 3}, 1}});
  expectRotation({{{1, 2, 3}, 1}, {{1, 2, 3}, 1}});                                        // one place
  expectRotation({{{0, 0, 0}, 1}, {{1, 1, 1}, 1}});                                        // a line
  expectRotation({{{1, 0, 0}, 1}, {{-1, 0, 0}, 1}, {{0, 1, 0}, 1}, {{0, -1, 0}, 1}});      // a square
  expectRotation({{{1, 1, 1}, 1}, {{-1, -1, 1}, 1}, {{-1, 1, -1}, 1}, {{1, -1, -1}, 1}});  // a tetrahedron
  EXPECT_EQ(principalAxes(std::vector<FitSphere>{{{1, 2, 3}, 1}}, false), glm::dquat(1, 0, 0, 0));
  // A line along any direction lies across the picture (or up).
  const std::vector<FitSphere> line{{{0, 0, 0}, 1}, {{1, 2, -2}, 1}, {{4, 8, -8}, 1}};
  const glm::dvec3 along = glm::normalize(glm::dvec3(1, 2, -2));
  EXPECT_NEAR(std::abs((principalAxes(line, false) * along).x), 1, 1e-9);
  EXPECT_NEAR(std::abs((principalAxes(line, true) * along).y), 1, 1e-9);
}

void expectNear(glm::dvec3 a, glm::dvec3 b, double most = 1e-12) {
  EXPECT_LT(glm::length(a - b), most);
}

// Copies are summed by the moments of one: as each by itself, and not rigid ones alike.
TEST(PrincipalAxes, OfCopiesAreThoseOfAllTheirSpheres) {
  Random random(6);
  for (int i = 0; i < 50; ++i) {
    FitSpheres copies;
    std::vector<FitSphere> each;
    for (int group = 0; group < 3; ++group) {
      const std::vector<FitSphere> spheres = cloud(random, 20, random.inBox(100));
      std::vector<glm::dmat4> places;
      for (int k = 0; k < 4; ++k) {
        glm::dmat4 place = glm::mat4_cast(random.rotation());
        if (i % 2 == 0) place *= 1 + 0.1 * k;
        place[3] = glm::dvec4(random.inBox(50), 1);
        places.push_back(place);
        for (const FitSphere& s : spheres) each.push_back(FitGroup::placed(s, place));
      }
      copies.add(spheres, places);
    }
    for (const bool tall : {false, true})
      EXPECT_LT(angleBetween(principalAxes(copies, tall), principalAxes(each, tall)), 1e-7);
  }
}

// Moments that rounding alone tells apart: the axes of the coordinates, however atoms are ordered or rounded.
TEST(PrincipalAxes, OfWhatIsRoundFollowTheCoordinates) {
  Random random(7);
  const auto noise = [&] { return random.inBox(1e-8); };
  std::vector<FitSphere> cube, rod, disc;
  for (int k = 0; k < 8; ++k) {
    const glm::dvec3 corner(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
    cube.push_back({10.0 * corner + noise(), 1});
    rod.push_back({glm::dvec3(1, 1, 5) * corner + noise(), 1});
    disc.push_back({glm::dvec3(5, 1, 5) * corner + noise(), 1});
  }
  const auto rows = [](const std::vector<FitSphere>& spheres) {
    return glm::transpose(glm::mat3_cast(principalAxes(spheres, false)));
  };
  expectNear(rows(cube)[0], {1, 0, 0}, 1e-12);
  expectNear(rows(cube)[1], {0, 1, 0}, 1e-12);
  expectNear(rows(rod)[0], {0, 0, 1}, 1e-7);
  expectNear(rows(rod)[1], {1, 0, 0}, 1e-7);
  expectNear(glm::abs(rows(disc)[2]), {0, 1, 0}, 1e-7);
  expectNear(rows(disc)[0], {1, 0, 0}, 1e-7);
}

TEST(LookDownAxis, PutsTheNamedAxesOnTheScreen) {
  const glm::dvec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dquat q = lookDownAxis(axis);
    expectNear(q * axes[axis], {0, 0, 1});  // towards the viewer: seen from its positive end
    expectNear(q * axes[(axis + 1) % 3], {1, 0, 0});
    expectNear(q * axes[(axis + 2) % 3], {0, 1, 0});
  }
}

TEST(RotatedBy, TurnsAboutTheScreensAxesInTheOrderXyz) {
  const glm::dquat none(1, 0, 0, 0);
  expectNear(rotatedBy(none, {90, 0, 0}) * glm::dvec3(0, 1, 0), {0, 0, 1});
  expectNear(rotatedBy(none, {0, 90, 0}) * glm::dvec3(0, 0, 1), {1, 0, 0});
  expectNear(rotatedBy(none, {0, 0, 90}) * glm::dvec3(1, 0, 0), {0, 1, 0});
  expectNear(rotatedBy(none, {90, 90, 0}) * glm::dvec3(0, 1, 0), {1, 0, 0});  // up -> viewer -> right
  // The screen's axes, not the molecule's: what is on the screen turns.
  Random random(6);
  const glm::dquat start = random.rotation();
  expectNear(rotatedBy(start, {0, 0, 30}) * glm::dvec3(1, 2, 3),
             glm::angleAxis(glm::radians(30.0), glm::dvec3(0, 0, 1)) * (start * glm::dvec3(1, 2, 3)));
  EXPECT_LT(angleBetween(rotatedBy(start, {0, 0, 0}), start), 1e-7);
  EXPECT_LT(angleBetween(rotatedBy(start, {360, 720, -360}), start), 1e-7);
}

// Copies that are kept once, against every copy by itself; one of the places is not rigid.
TEST(CameraFit, CopiesCountAsEachByItself) {
  Random random(7);
  for (int i = 0; i < 20; ++i) {
    const std::vector<FitSphere> unit = cloud(random, 40);
    std::vector<glm::dmat4> places;
    for (int k = 0; k < 30; ++k)
      places.push_back(glm::translate(glm::dmat4(1.0), random.inBox(300)) *
                       glm::mat4_cast(random.rotation()));
    places.push_back(glm::scale(glm::dmat4(1.0), {6, 1, 1}));
    FitSpheres shared;
    shared.add(unit, places);
    std::vector<FitSphere> apart;
    for (const glm::dmat4& place : places)
      for (const FitSphere& s : unit)
        apart.push_back({glm::dvec3(place * glm::dvec4(s.center, 1)), s.radius});
    ASSERT_EQ(shared.size(), apart.size());
    EXPECT_LT(angleBetween(principalAxes(shared, false), principalAxes(apart, false)), 1e-7);
    Camera camera;
    camera.orientation = random.rotation();
    camera.projection = i % 2 == 0 ? Projection::perspective : Projection::orthographic;
    const Camera a = fitted(camera, {300, 200}, shared), b = fitted(camera, {300, 200}, apart);
    EXPECT_EQ(a.distance, b.distance);
    EXPECT_EQ(a.target, b.target);
  }
}

}  // namespace
}  // namespace meniscus

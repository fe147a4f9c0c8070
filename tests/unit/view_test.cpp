// Rays of a view, and the planes that makeView() fits to what is drawn.

#include "core/view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/support/random.h"

namespace meniscus {
namespace {

using test::Random;

constexpr ImageSize kSize{640, 480};

Camera randomCamera(Random& random, Projection projection) {
  Camera camera;
  camera.projection = projection;
  camera.fovY = random.uniform(0.01, 2.5);
  camera.orientation = random.rotation();
  camera.target = random.inBox(100);
  camera.distance = random.logUniform(0.1, 1e4);
  camera.zoom = random.logUniform(0.1, 10);
  return camera;
}

glm::dvec3 viewPoint(const View& view, glm::dvec3 world) {
  return view.rotation * (world - view.pivot);
}

// Where the pinhole camera of the header's text puts a view-space point, in pixels.
glm::dvec2 pixelOf(const View& view, glm::dvec3 p) {
  const double depth = view.projection == Projection::perspective ? view.distance - p.z : 1.0;
  return glm::dvec2(p.x, p.y) / depth / view.pixelSize + view.center;
}

TEST(RayThrough, HitsThePointsThatProjectToItsPixel) {
  Random random(1);
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    for (int i = 0; i < 2000; ++i) {
      const Camera camera = randomCamera(random, projection);
      const View view = makeView(camera, kSize, {camera.target, camera.distance * 0.5});
      const glm::dvec3 p = random.inBox(camera.distance * 0.4);
      const Ray ray = rayThrough(view, pixelOf(view, p));
      EXPECT_NEAR(glm::length(ray.direction), 1.0, 1e-14);
      EXPECT_LT(ray.direction.z, 0);
      EXPECT_LT(glm::length(glm::cross(p - ray.origin, ray.direction)), 1e-12 * camera.distance);
      EXPECT_GT(glm::dot(p - ray.origin, ray.direction), 0);
    }
  }
}

TEST(RayThrough, PerspectiveRaysStartAtTheEyeAndFillTheFieldOfView) {
  Camera camera;
  camera.distance = 20;
  camera.fovY = 1.0;
  const View view = makeView(camera, kSize, {{0, 0, 0}, 5});
  EXPECT_EQ(rayThrough(view, {3, 4}).origin, glm::dvec3(0, 0, 20));
  EXPECT_EQ(rayThrough(view, {320, 240}).direction, glm::dvec3(0, 0, -1));
  const glm::dvec3 top = rayThrough(view, {320, 480}).direction,
                   bottom = rayThrough(view, {320, 0}).direction;
  EXPECT_NEAR(std::acos(glm::dot(top, bottom)), 1.0, 1e-12);
  EXPECT_GT(top.y, 0) << "pixel y points up";
  EXPECT_GT(rayThrough(view, {640, 240}).direction.x, 0) << "pixel x points right";
}

TEST(RayThrough, OrthographicRaysStartOnTheNearPlane) {
  Camera camera;
  camera.projection = Projection::orthographic;
  camera.distance = 20;
  camera.fovY = 1.0;
  const View view = makeView(camera, kSize, {{0, 0, 0}, 5});
  const Ray ray = rayThrough(view, {320, 480});
  EXPECT_EQ(ray.direction, glm::dvec3(0, 0, -1));
  EXPECT_EQ(ray.origin.z, view.nearZ);
  EXPECT_NEAR(ray.origin.y, 20 * std::tan(0.5), 1e-12)
      << "the plane of the target fills the same field of view";
}

TEST(MakeView, ZoomScalesTheImageAndNothingElse) {
  Random random(2);
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    Camera camera = randomCamera(random, projection);
    camera.zoom = 1;
    const View one = makeView(camera, kSize, {camera.target, 3});
    camera.zoom = 4;
    const View four = makeView(camera, kSize, {camera.target, 3});
    EXPECT_NEAR(four.pixelSize, one.pixelSize / 4, 1e-15 * one.pixelSize);
    EXPECT_EQ(four.distance, one.distance);
    EXPECT_EQ(four.nearZ, one.nearZ);
    EXPECT_EQ(four.center, glm::dvec2(320, 240));
  }
}

TEST(MakeView, RotationIsRigidEvenIfTheOrientationIsNotOfUnitLength) {
  Camera camera;
  camera.orientation = glm::dquat(0.3, -2.0, 1.0, 5.0);
  const glm::dmat3 r = makeView(camera, kSize, {}).rotation;
  const glm::dmat3 product = r * glm::transpose(r);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(product[i][j], i == j ? 1.0 : 0.0, 1e-14);
  }
  EXPECT_NEAR(glm::determinant(r), 1.0, 1e-14);
}

TEST(MakeView, PlanesEncloseTheBoundsInFrontOfTheEye) {
  Random random(3);
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    for (int i = 0; i < 5000; ++i) {
      const Camera camera = randomCamera(random, projection);
      const BoundingSphere bounds{camera.target + random.inBox(3 * camera.distance),
                                  random.logUniform(1e-3, 1e4)};
      const View view = makeView(camera, kSize, bounds);
      const double z = viewPoint(view, bounds.center).z;
      ASSERT_GT(view.nearZ, view.farZ);
      if (projection == Projection::perspective) {
        ASSERT_LT(view.nearZ, view.distance);
      }
      const bool eyeBefore =
          projection == Projection::orthographic || z + bounds.radius < view.distance * 0.99;
      if (eyeBefore) {
        EXPECT_GE(view.nearZ, z + bounds.radius);
      }
      EXPECT_LE(view.farZ, z - bounds.radius);
      // and not far beyond: a distant plane costs depth precision
      EXPECT_LE(view.nearZ, z + bounds.radius * 1.01 + camera.distance * 1e-4);
    }
  }
}

TEST(MakeView, EyeInsideTheBoundsKeepsAThinNearPlane) {
  Camera camera;
  camera.distance = 1;
  const View view = makeView(camera, kSize, {{0, 0, 0}, 50});
  EXPECT_LT(view.nearZ, view.distance);
  EXPECT_GT(view.nearZ, view.distance - 1e-3) << "nothing that can be seen is cut off";
  EXPECT_LE(view.farZ, -50);
}

TEST(MakeView, EverythingBehindTheEyeIsStillAValidView) {
  Camera camera;
  camera.distance = 10;
  const View view = makeView(camera, kSize, {{0, 0, 100}, 5});
  EXPECT_LT(view.nearZ, 10);
  EXPECT_LT(view.farZ, view.nearZ);
  EXPECT_TRUE(std::isfinite(view.farZ));
}

TEST(MakeView, AFarPlaneOfTheUsersCutsTheScene) {
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    Camera camera;
    camera.projection = projection;
    camera.distance = 100;
    const BoundingSphere bounds{{0, 0, 0}, 20};
    const View whole = makeView(camera, kSize, bounds);
    EXPECT_FALSE(whole.cutsFar);
    camera.farthest = 121;  // behind everything
    EXPECT_EQ(makeView(camera, kSize, bounds), whole);
    camera.farthest = 95;
    View cut = whole;
    cut.farZ = 5;
    cut.cutsFar = true;
    EXPECT_EQ(makeView(camera, kSize, bounds), cut);
    for (const double before : {79.0, 1.0, 1e-3}) {  // all that is drawn lies behind it
      camera.farthest = before;
      const View nothing = makeView(camera, kSize, bounds);
      EXPECT_DOUBLE_EQ(nothing.farZ, 100 - before);
      EXPECT_GT(nothing.nearZ, nothing.farZ);
      EXPECT_GT(static_cast<float>(nothing.nearZ), static_cast<float>(nothing.farZ));
      if (projection == Projection::perspective) {
        EXPECT_LT(nothing.nearZ, nothing.distance);
      }
    }
  }
}

TEST(MakeView, AnEmptySceneIsAValidView) {
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    Camera camera;
    camera.projection = projection;
    const View view = makeView(camera, {1, 1}, {});
    EXPECT_GT(view.nearZ, view.farZ);
    EXPECT_GT(view.pixelSize, 0);
  }
}

TEST(MakeView, FarFromTheOriginKeepsItsDigits) {
  Camera camera;
  camera.target = {1e6, -1e6, 1e6};
  const View view = makeView(camera, kSize, {camera.target, 10});
  EXPECT_EQ(view.pivot, camera.target);
  EXPECT_NEAR(view.nearZ, 10, 0.01);
  EXPECT_NEAR(view.farZ, -10, 0.01);
}

}  // namespace
}  // namespace meniscus

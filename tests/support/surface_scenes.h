#pragma once
// Metaball surfaces that break methods, and the views that show where.

#include <filesystem>
#include <memory>
#include <vector>

#include "core/primitives.h"
#include "core/view.h"

namespace meniscus::test {

struct SurfaceScene {
  std::shared_ptr<Primitives> primitives;
  SurfaceScene(std::shared_ptr<Primitives> p) : primitives(std::move(p)) {}
  explicit SurfaceScene(const MetaballField& field) : primitives(std::make_shared<Primitives>()) {
    primitives->surfaces.push_back(field);
  }
};

struct SurfaceView {
  SurfaceScene scene;
  View view;
};

/// From the outside, all of it in the picture.
View viewOf(const SurfaceScene& scene, ImageSize size, Projection projection = Projection::perspective);

/// Balls of random radii in a ball, as dense as a protein, each with another colour.
SurfaceScene randomScene(unsigned count, unsigned seed);

/// A file of molecules/ as `meniscus render --representation surface` draws it.
SurfaceScene moleculeScene(const std::filesystem::path& file);
/// All of them, by name.
std::vector<std::filesystem::path> moleculeFiles();

/// 200 in one place (Kanamori et al. 2008, Figure 9 a and b).
SurfaceScene coincidentBalls();
/// `count` of them, each up to `apart` Å away from the same place in each direction; their sum is `sum`
/// there.
SurfaceScene nearlyCoincidentBalls(unsigned count, double apart, double sum);

/// A thousand along one ray; the surface lies behind hundreds that do not reach the level (Figure 9 c).
SurfaceView ballsAlongOneRay();

/// 8 x 8 x 8 balls, orthographic along an axis, rays through rows of centres: thousands of events at exactly
/// the same places.
SurfaceView latticeAlongAxis();
/// Perspective, down the same axis.
View latticeInPerspective(const SurfaceScene& lattice);

/// A cavity in a ball, seen from within it.
SurfaceView insideOfCavity();

/// Eyes inside balls and inside the surface; some cut open by the near plane.
std::vector<View> viewsFromInside(const SurfaceScene& scene);

/// Two fields, the ids of the second after those of the first.
SurfaceScene twoSurfaces();
/// Spheres in the midst of them.
std::vector<SpherePrimitive> spheresAmongSurfaces();

/// Supports from 1e-3 to 1e3 Å around the smallest ball, which lies in the middle.
SurfaceScene manyScales();
View viewOfScale(const SurfaceScene& scene, double radius);

/// The eye at 10,000 Å, all of the scene in the picture.
View viewFromAfar(const SurfaceScene& scene, ImageSize size);

/// A field of view of `degrees`; wide ones from the inside.
View viewOfAngle(const SurfaceScene& scene, double degrees);

/// Coincident balls of coefficient 1, the level at a share of `below` under their maximum; what is left fills
/// the picture.
SurfaceView nearMaximum(unsigned balls, double below);

/// Balls that reach the level at their centres alone, a ray through each: touching without crossing. In the
/// middle lie two more whose sum is the level to the last bit.
SurfaceView tangentRays();

}  // namespace meniscus::test

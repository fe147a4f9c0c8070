#pragma once
// Cameras from data: which way to look and how far to stand.

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <utility>
#include <vector>

#include "core/view.h"

namespace meniscus {

/// Centre [Å, world] and radius of something that should be in the picture.
struct FitSphere {
  glm::dvec3 center;
  double radius;
};

/// Those that stand together in several places, in coordinates of their own.
struct FitGroup {
  std::vector<FitSphere> spheres;
  std::vector<glm::dmat4> places;  ///< as in Placement::transform; radii stay what they are
  FitSphere ball;                  ///< encloses all spheres

  static FitSphere placed(const FitSphere& s, const glm::dmat4& place) {
    return {glm::dvec3(place * glm::dvec4(s.center, 1.0)), s.radius};
  }
  /// Encloses all spheres there.
  FitSphere ballIn(const glm::dmat4& place) const;
};

/// Many of them.
class FitSpheres {
 public:
  FitSpheres() = default;
  /// In one place.
  FitSpheres(std::vector<FitSphere> spheres) { add(std::move(spheres), {glm::dmat4(1.0)}); }
  void add(std::vector<FitSphere> spheres, std::vector<glm::dmat4> places);
  void add(const FitSpheres& others);

  const std::vector<FitGroup>& groups() const { return groups_; }  ///< none is empty
  bool empty() const { return groups_.empty(); }
  std::size_t size() const;  ///< in all places
  FitSphere front() const;
  /// Calls f(sphere) for each in each place.
  template <typename F>
  void forEach(F f) const {
    forEach([](const FitSphere&) { return false; }, f);
  }
  /// Leaves out what stands in places where without(a sphere around it) is true.
  template <typename Without, typename F>
  void forEach(Without without, F f) const {
    for (const FitGroup& group : groups_) {
      for (const glm::dmat4& place : group.places) {
        if (without(group.ballIn(place))) continue;
        for (const FitSphere& s : group.spheres) f(FitGroup::placed(s, place));
      }
    }
  }

 private:
  std::vector<FitGroup> groups_;
};

/// Looks along the shortest principal axis, the longest being horizontal (vertical if `tall`), signs chosen
/// by the third moments so that the result does not depend on the order of atoms. Where moments are alike to
/// a millionth, as those of a capsid, the nearest axes of the coordinates are taken instead. Identity for
/// fewer than two points.
glm::dquat principalAxes(const FitSpheres& spheres, bool tall);

/// Looks down the x, y or z axis (0, 1, 2) from its positive end; z: x right, y up; x: y right, z up; y: z
/// right, x up.
glm::dquat lookDownAxis(int axis);

/// Turns by degrees about the screen's x (right), y (up) and z (towards the viewer) axes, in this order.
glm::dquat rotatedBy(const glm::dquat& orientation, glm::dvec3 degrees);

/// Sets target and distance so that all spheres just fit into the picture with `margin` (share of the
/// picture's half size) left on each side. projection, fovY, zoom and orientation are kept.
Camera fitted(Camera camera, ImageSize size, const FitSpheres& spheres, double margin = 0.04);

}  // namespace meniscus

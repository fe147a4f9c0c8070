#pragma once
// Cameras from data: which way to look and how far to stand.

#include <glm/gtc/quaternion.hpp>
#include <span>

#include "core/view.h"

namespace meniscus {

/// Centre [Å, world] and radius of something that should be in the picture.
struct FitSphere {
  glm::dvec3 center;
  double radius;
};

/// Looks along the shortest principal axis, the longest being horizontal (vertical if `tall`), signs chosen
/// by the third moments so that the result does not depend on the order of atoms. Identity for fewer than two
/// points.
glm::dquat principalAxes(std::span<const FitSphere> spheres, bool tall);

/// Looks down the x, y or z axis (0, 1, 2) from its positive end; z: x right, y up; x: y right, z up; y: z
/// right, x up.
glm::dquat lookDownAxis(int axis);

/// Turns by degrees about the screen's x (right), y (up) and z (towards the viewer) axes, in this order.
glm::dquat rotatedBy(const glm::dquat& orientation, glm::dvec3 degrees);

/// Sets target and distance so that all spheres just fit into the picture with `margin` (share of the
/// picture's half size) left on each side. projection, fovY, zoom and orientation are kept.
Camera fitted(Camera camera, ImageSize size, std::span<const FitSphere> spheres, double margin = 0.04);

}  // namespace meniscus

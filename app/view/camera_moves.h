#pragma once
// What the mouse does to a camera. Pixels are those of a picture of `size`, x right, y up, from its lower
// left corner, as in core/view.h.

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "core/view.h"

namespace meniscus {

/// Size of a pixel in the plane through the target that faces the viewer [Å].
double pixelAtTarget(const Camera& camera, ImageSize size);

/// Turned about the target as a ball under the cursor would be, from one pixel to another: a sphere in the
/// middle of the picture with a hyperbolic sheet around it (Bell's trackball, as in Henriksen, Sporring,
/// Hornbaek 2004, doi 10.1109/TVCG.2004.1260772). Going back the same way undoes it.
Camera turned(Camera camera, ImageSize size, glm::dvec2 from, glm::dvec2 to);

/// Moved so that what lies in the target's plane follows the cursor.
Camera panned(Camera camera, ImageSize size, glm::dvec2 from, glm::dvec2 to);

/// Nearer (factor < 1) or farther; what lies in the target's plane under the cursor stays there. The near and
/// the far plane stay where they are in the scene.
Camera dollied(Camera camera, ImageSize size, glm::dvec2 cursor, double factor);

/// Looks at a sphere, from the same side, so that it fills the smaller side of the picture.
Camera focusedOn(Camera camera, ImageSize size, const BoundingSphere& sphere);

/// Moves the near plane into the scene by a share of its diameter, to the far plane at most; before its first
/// atom there is no plane.
Camera clippedBy(Camera camera, const BoundingSphere& scene, double share);

/// The same with the far plane, from behind.
Camera clippedBehindBy(Camera camera, const BoundingSphere& scene, double share);

/// Where a point of the world is seen; nothing if it is not before the eye.
std::optional<glm::dvec2> pixelOf(const Camera& camera, ImageSize size, const glm::dvec3& world);

}  // namespace meniscus

#pragma once
// Where a picture is seen from: the user's camera, or any other viewpoint such as a light. Double precision
// here; render/ hands the GPU floats split so that nothing is lost (shaders/shared/double_float.glsl).
//
// View space: x right, y up, z towards the viewer, origin at the pivot, a point on the optical axis near what
// is looked at. The eye of a perspective view is at (0, 0, distance). Pixel coordinates: x right, y up, pixel
// (i, j) covers [i, i+1) x [j, j+1), centre at + 0.5, (0, 0) = lower left corner of the whole picture.

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "core/image.h"

namespace meniscus {

enum class Projection : std::uint8_t { perspective, orthographic };

struct View {
  Projection projection = Projection::perspective;
  glm::dmat3 rotation{1.0};     ///< view axes from world axes: viewPoint = rotation * (world - pivot)
  glm::dvec3 pivot{0.0};        ///< world position of the view-space origin [Å]
  double distance = 100;        ///< eye to pivot [Å]; perspective only
  double pixelSize = 0.001;     ///< of one pixel: at unit depth (perspective), in Å (orthographic)
  glm::dvec2 center{512, 384};  ///< pixel coordinates of the optical axis
  ImageSize size;               ///< of the whole picture
  double nearZ = 1000;          ///< view-space z of the near plane [Å]: nothing above it is seen
  double farZ = -1000;          ///< view-space z of the far plane [Å]: everything drawn lies above it
  bool cutsFar = false;         ///< the scene goes on behind the far plane, but nothing of it is seen
  bool operator==(const View&) const = default;
};

/// Ray with unit direction, in view space; t is measured from origin [Å].
struct Ray {
  glm::dvec3 origin, direction;
};

/// Ray through pixel coordinates (see above). Perspective: from the eye. Orthographic: from the near plane.
Ray rayThrough(const View& view, glm::dvec2 pixel);

/// Sphere that encloses something [Å].
struct BoundingSphere {
  glm::dvec3 center{0.0};
  double radius = 0;
};

/// How the user looks at the scene.
struct Camera {
  Projection projection = Projection::perspective;
  double fovY = 0.5235987755982988;    ///< vertical field of view [rad], of zoom 1
  glm::dquat orientation{1, 0, 0, 0};  ///< world axes -> view axes
  glm::dvec3 target{0.0};              ///< world point in the middle of the picture [Å]
  double distance = 100;               ///< eye to target [Å] (orthographic: fixes the scale through fovY)
  std::optional<double> nearest;       ///< nothing closer to the eye's plane than this is seen [Å]
  std::optional<double> farthest;      ///< nothing farther from the eye's plane than this is seen [Å]
  double zoom = 1;                     ///< magnifies the picture about its middle; the viewpoint stays
};

/// The view of a camera onto a scene: near and far planes are fitted to `bounds` (all that is drawn).
View makeView(const Camera& camera, ImageSize size, const BoundingSphere& bounds);

}  // namespace meniscus

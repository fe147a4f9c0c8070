#include "app/option_camera.h"

#include <glm/trigonometric.hpp>

namespace meniscus {

Camera lensOf(const RenderOptions& options) {
  Camera camera;
  camera.projection = options.orthographic ? Projection::orthographic : Projection::perspective;
  camera.fovY = glm::radians(options.fovYDeg);
  camera.zoom = options.zoom;
  return camera;
}

Camera withViewpoint(Camera camera, const RenderOptions& options) {
  if (options.target) camera.target = *options.target;
  if (options.distance) camera.distance = *options.distance;
  if (options.nearest) camera.nearest = options.nearest;
  return camera;
}

}  // namespace meniscus

#include "app/option_camera.h"

#include <fmt/format.h>

#include <glm/trigonometric.hpp>

#include "core/error.h"

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
  if (options.farthest) camera.farthest = options.farthest;
  if (camera.nearest && camera.farthest && !(*camera.nearest < *camera.farthest))
    throw UsageError(fmt::format("--far: {} Angstrom is not behind the near plane, at {}, so nothing is seen",
                                 *camera.farthest, *camera.nearest));
  return camera;
}

}  // namespace meniscus

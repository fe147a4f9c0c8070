#pragma once
// What options say of a camera, whatever else decides where it is.

#include "app/render_options.h"
#include "core/view.h"

namespace meniscus {

/// Projection, opening and zoom.
Camera lensOf(const RenderOptions& options);

/// The camera with the target, distance, near and far plane that the options give, which have their way.
/// Throws UsageError if nothing lies between the planes.
Camera withViewpoint(Camera camera, const RenderOptions& options);

}  // namespace meniscus

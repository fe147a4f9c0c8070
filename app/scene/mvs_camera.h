#pragma once
// Where a MolViewSpec scene is seen from.

#include <optional>
#include <vector>

#include "app/render_options.h"
#include "app/scene/mvs_nodes.h"
#include "core/camera_fit.h"
#include "core/view.h"

namespace meniscus {

/// What the nodes camera and focus of a state ask for.
class MvsCamera {
 public:
  /// Reads a camera node. Throws InputError if the camera looks at itself or along `up`.
  void readCamera(const MvsNode& node, std::vector<std::string>& unsupported);
  /// Reads a focus node about these spheres.
  void readFocus(const MvsNode& node, const FitSpheres& spheres, std::vector<std::string>& unsupported);

  /// The camera for a picture of these options; where nothing is asked for, it looks along -z at `all`. A
  /// camera node wins over focus nodes, of which several share one picture; --orient, --target,
  /// --distance, --near and --far of the options have their way over both.
  Camera camera(const RenderOptions& options, const FitSpheres& all) const;

 private:
  Camera ownCamera(const RenderOptions& options, const FitSpheres& all) const;
  struct Reference {
    glm::dvec3 target, position, up;
    std::optional<double> near;
  };
  std::optional<Reference> reference_;
  std::optional<Camera> exact_;  ///< custom.meniscus of the camera node
  std::vector<BoundingSphere> focused_;
  glm::dquat focusOrientation_{1, 0, 0, 0};
};

/// The smallest sphere about the middle of their box that holds all spheres.
BoundingSphere boundsOf(const FitSpheres& spheres);

}  // namespace meniscus

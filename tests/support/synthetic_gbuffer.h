#pragma once
// A G-buffer with contents that are known exactly, to give to the passes that read it.

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/view.h"
#include "render/frame_graph.h"
#include "render/gbuffer.h"

namespace meniscus::test {

struct SurfaceSample {
  double z = 0;  ///< view space [Å]
  glm::dvec3 normal{0, 0, 1};
  std::uint32_t id = 1;
};

/// What the ray through a pixel meets; nothing = background.
using SurfaceFunction = std::function<std::optional<SurfaceSample>(const Ray&)>;

/// Orthographic, looking along -z at the middle of the picture.
View orthographicView(ImageSize size, double pixelSize, double nearZ = 100, double farZ = -100);
/// The same from a distance.
View perspectiveView(ImageSize size, double pixelSize, double distance, double nearZ, double farZ);

SurfaceFunction planeThrough(const glm::dvec3& point, const glm::dvec3& normal);
SurfaceFunction sphereAt(const glm::dvec3& center, double radius);

/// Textures of the whole of `view`; binds the view's uniforms.
class SyntheticGBuffer {
 public:
  SyntheticGBuffer(const View& view, const SurfaceFunction& surface);
  /// White where there is a surface.
  GBufferRefs import(FrameGraph& graph) const;
  const gl::Texture& depth() const { return depth_; }

 private:
  gl::Texture depth_, normal_, id_, albedo_;
  gl::Buffer view_;
};

/// Runs the graph and reads an R16, RG16, R32F or RGBA32F texture, rows from the bottom.
std::vector<double> run(FrameGraph& graph, TextureRef wanted);

}  // namespace meniscus::test

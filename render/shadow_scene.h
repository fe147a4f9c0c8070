#pragma once
// A scene's G-buffer and shadow map, drawn once, to be looked at through shadow passes of many settings: for
// measuring and for tests. Quadrics only.

#include <memory>
#include <vector>

#include "core/primitives.h"
#include "core/render_settings.h"
#include "core/scene.h"
#include "render/frame_graph.h"
#include "render/post/shadow.h"
#include "render/quadrics.h"
#include "render/shader_library.h"
#include "render/view_block.h"

namespace meniscus {

class ShadowScene {
 public:
  /// Needs a current context. `penumbra` [Å]: the map reaches so far beyond what is seen; texelSize [Å]: of
  /// the map, a pixel's if 0.
  ShadowScene(const Primitives& primitives, const View& view, const DirectionalLight& key,
              double penumbra = 2, double texelSize = 0);

  /// Share of the key light that arrives, rows from the bottom; 0 on the background. `sample` of
  /// `sampleCount`: see ShadowUniforms::set.
  std::vector<float> visibility(const ShadowSettings& settings, int sample = 0, int sampleCount = 1);
  /// Processor time of the last pass, of all threads together [ms].
  double passMs() const { return passMs_; }

  const View& light() const { return map_.light; }
  /// What the pixels show, rows from the bottom: depth value (0 = background), distance [Å] along the unit
  /// ray, and normal as stored.
  const std::vector<float>& depth() const { return depth_; }
  const std::vector<float>& distance() const { return distance_; }
  const std::vector<glm::vec3>& normal() const { return normal_; }

 private:
  View view_;
  Tile tile_;
  ShaderLibrary shaders_{{}};
  TexturePool pool_;
  QuadricBuffers quadrics_;
  gl::Buffer viewUniforms_;
  ShadowUniforms shadowUniforms_;
  RenderStats stats_;
  std::unique_ptr<FrameGraph> mapGraph_, sceneGraph_;  // own what was drawn
  GBufferRefs gbuffer_;
  ShadowMap map_;
  std::vector<float> depth_, distance_;
  std::vector<glm::vec3> normal_;
  double passMs_ = 0;
};

}  // namespace meniscus

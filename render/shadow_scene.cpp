#include "render/shadow_scene.h"

#include <glad/gl.h>

#include <algorithm>
#include <ctime>

#include "core/light_view.h"
#include "core/shared_math.h"

namespace meniscus {

ShadowScene::ShadowScene(const Primitives& primitives, const View& view, const DirectionalLight& key,
                         double penumbra, double texelSize)
    : view_(view), tile_{0, 0, view.size.width, view.size.height} {
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glDisable(GL_DITHER);
  quadrics_.upload(primitives);
  viewUniforms_ = gl::Buffer::updatable(sizeof(f32::ViewBlock));
  const auto setView = [&](const View& v, const Tile& tile) {
    const f32::ViewBlock block = makeViewBlock(v, primitives.origin, tile, {0, 0});
    viewUniforms_.update(&block);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, viewUniforms_.object.name());
  };

  const BoundingSphere bounds = primitives.bounds();
  const gl::Limits limits = gl::queryLimits();
  const int maxSize = std::min({8192, limits.textureSize, limits.viewportWidth, limits.viewportHeight});
  if (texelSize == 0) texelSize = pixelFootprint(view, bounds);
  const View light = makeLightView(view, key, bounds, texelSize, maxSize, penumbra);
  const Tile whole{0, 0, light.size.width, light.size.height};
  setView(light, whole);
  mapGraph_ = std::make_unique<FrameGraph>(pool_);
  GBufferRefs map;
  map.depth =
      mapGraph_->create("shadow map", {gl::TextureFormat::depth32f, light.size.width, light.size.height});
  addQuadrics(*mapGraph_, quadrics_, shaders_, map);
  mapGraph_->want(map.depth);
  mapGraph_->execute(stats_, false);
  map_ = {light, &mapGraph_->texture(map.depth)};

  setView(view, tile_);
  sceneGraph_ = std::make_unique<FrameGraph>(pool_);
  gbuffer_ = createGBuffer(*sceneGraph_, tile_.width, tile_.height);
  addQuadrics(*sceneGraph_, quadrics_, shaders_, gbuffer_);
  sceneGraph_->want(gbuffer_.depth);
  sceneGraph_->want(gbuffer_.normal);
  sceneGraph_->want(gbuffer_.distance);
  sceneGraph_->execute(stats_, false);

  const auto pixels = static_cast<std::size_t>(tile_.width) * static_cast<std::size_t>(tile_.height);
  std::vector<std::uint16_t> encoded(2 * pixels);
  depth_.resize(pixels);
  distance_.resize(pixels);
  const auto read = [&](TextureRef ref, void* out) {
    sceneGraph_->texture(ref).read(tile_.width, tile_.height, tile_.width, out);
  };
  read(gbuffer_.depth, depth_.data());
  read(gbuffer_.distance, distance_.data());
  read(gbuffer_.normal, encoded.data());
  for (std::size_t i = 0; i < encoded.size(); i += 2)
    normal_.push_back(f32::decodeNormal(glm::vec2(encoded[i], encoded[i + 1]) / 65535.0f));
}

std::vector<float> ShadowScene::visibility(const ShadowSettings& settings, int sample, int sampleCount) {
  shadowUniforms_.set(settings, view_, map_, sample, sampleCount);
  FrameGraph graph(pool_);
  GBufferRefs gbuffer;
  gbuffer.depth = graph.import("depth", sceneGraph_->texture(gbuffer_.depth), Clear::none);
  gbuffer.normal = graph.import("normal", sceneGraph_->texture(gbuffer_.normal), Clear::none);
  const TextureRef result =
      addShadow(graph, settings, map_, shadowUniforms_, shaders_, gbuffer, tile_.width, tile_.height);
  graph.want(result);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, viewUniforms_.object.name());  // another's may be there by now
  glFinish();
  const std::clock_t start = std::clock();
  graph.execute(stats_, false);
  glFinish();
  passMs_ = 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  std::vector<std::uint16_t> stored(depth_.size());
  graph.texture(result).read(tile_.width, tile_.height, tile_.width, stored.data());
  std::vector<float> out(stored.size());
  std::transform(stored.begin(), stored.end(), out.begin(),
                 [](std::uint16_t v) { return static_cast<float>(v) / 65535.0f; });
  return out;
}

}  // namespace meniscus

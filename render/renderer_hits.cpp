// What rays meet, without light.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/error.h"
#include "render/gl/context.h"
#include "render/picture_parts.h"
#include "render/renderer_impl.h"

namespace meniscus {

HitImage Renderer::renderHits(const View& view, HitChannels channels, const SurfaceSettings& surface,
                              QuadricMethod quadrics) {
  Impl& r = *impl_;
  r.prepare(view, quadrics, false, surface);
  const int width = view.size.width, height = view.size.height;
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  HitImage image;
  image.size = view.size;
  std::vector<std::uint16_t> encoded;
  if (channels.distance) image.distance.resize(pixels);
  if (channels.id) image.id.resize(pixels);
  if (channels.normal) encoded.resize(2 * pixels);

  const TileSize tileSize = chooseTileSize(view.size, 16, r.options.maxTileSize);
  for (int y = 0; y < height; y += tileSize.height) {
    for (int x = 0; x < width; x += tileSize.width) {
      const Tile tile{x, y, std::min(tileSize.width, width - x), std::min(tileSize.height, height - y)};
      r.setView(view, tile, {0, 0});
      FrameGraph graph(r.pool);
      const GBufferRefs gbuffer = createGBuffer(graph, tile.width, tile.height);
      r.addScene(graph, view, tile, {0, 0}, gbuffer, Surfaces::opaque);
      graph.leaveOut("pass shade", "no colour is wanted");
      const auto fetch = [&](TextureRef ref, auto* out, std::size_t perPixel) {
        const std::size_t first =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
        graph.texture(ref).read(tile.width, tile.height, width, out + perPixel * first);
      };
      if (channels.distance) graph.want(gbuffer.distance);
      if (channels.normal) graph.want(gbuffer.normal);
      if (channels.id) graph.want(gbuffer.id);
      r.execute(graph);
      if (channels.distance) fetch(gbuffer.distance, image.distance.data(), 1);
      if (channels.normal) fetch(gbuffer.normal, encoded.data(), 2);
      if (channels.id) fetch(gbuffer.id, image.id.data(), 1);
      ++r.stats.tiles;
    }
  }
  requireContextAlive();
  for (std::size_t i = 0; i < encoded.size(); i += 2) {
    const bool miss =
        encoded[i] == 0 && encoded[i + 1] == 0;  // cleared; no normal towards the viewer is stored so
    image.normal.push_back(miss ? glm::vec3(0.0f)
                                : f32::decodeNormal(glm::vec2(encoded[i], encoded[i + 1]) / 65535.0f));
  }
  return image;
}

SurfaceLayerImage Renderer::renderLayers(const View& view, const SurfaceSettings& surface) {
  MENISCUS_CHECK(surface.translucent());
  Impl& r = *impl_;
  r.prepare(view, QuadricMethod::automatic, false, surface);
  const Tile tile{0, 0, view.size.width, view.size.height};
  const std::size_t pixels = static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height);
  r.setView(view, tile, {0, 0});
  FrameGraph graph(r.pool);
  const GBufferRefs gbuffer = createGBuffer(graph, tile.width, tile.height);
  r.addScene(graph, view, tile, {0, 0}, gbuffer, Surfaces::apart);
  const SurfaceLayerRefs layers =
      r.surfaces.addLayers(graph, r.shaders, {view, r.primitives->origin, tile, {0, 0}, gbuffer, {}});
  for (const TextureRef& layer : layers.of) graph.want(layer);
  r.execute(graph);
  SurfaceLayerImage image;
  std::vector<glm::uvec4> texels(pixels);
  for (std::size_t i = 0; i < layers.of.size(); ++i) {
    graph.texture(layers.of[i]).read(tile.width, tile.height, tile.width, texels.data());
    if (i == image.layers.size()) {
      for (const glm::uvec4& texel : texels) image.rest.push_back(texel.w);
      continue;
    }
    HitImage& hits = image.layers[i];
    hits.size = view.size;
    for (const glm::uvec4& texel : texels) {
      const bool miss = texel.w == 0;
      const glm::vec2 normal(static_cast<float>(texel.y & 0xFFFFu), static_cast<float>(texel.y >> 16));
      hits.distance.push_back(miss ? std::numeric_limits<float>::infinity() : std::bit_cast<float>(texel.z));
      hits.normal.push_back(miss ? glm::vec3(0.0f) : f32::decodeNormal(normal / 65535.0f));
      hits.id.push_back(texel.w);
    }
  }
  return image;
}

}  // namespace meniscus

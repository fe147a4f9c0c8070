#include "render/layers.h"

#include <array>
#include <cmath>
#include <cstring>

#include "core/shared_math.h"
#include "core/srgb.h"

namespace meniscus {

namespace {

// Writes the values of one pixel after the other.
class PixelCursor {
 public:
  explicit PixelCursor(std::byte* at) : at_(at) {}
  void put(const void* bytes, std::size_t count) {
    std::memcpy(at_, bytes, count);
    at_ += count;
  }
  void put(float value) { put(&value, sizeof(value)); }

 private:
  std::byte* at_;
};

// Share of a distance along the ray through a pixel that lies along the optical axis.
double alongAxis(const View& view, int x, int y) {
  if (view.projection == Projection::orthographic) return 1;
  const double slopeX = (x + 0.5 - view.center.x) * view.pixelSize,
               slopeY = (y + 0.5 - view.center.y) * view.pixelSize;
  return 1 / std::sqrt(1 + slopeX * slopeX + slopeY * slopeY);
}

}  // namespace

void wantLayers(FrameGraph& graph, const Layers& layers, const GBufferRefs& gbuffer) {
  if (layers.albedo) graph.want(gbuffer.albedo);
  if (layers.normal) graph.want(gbuffer.normal);
  if (layers.depth || layers.distance) graph.want(gbuffer.distance);
  if (layers.id) graph.want(gbuffer.id);
}

void readLayers(const FrameGraph& graph, const Layers& layers, const GBufferRefs& gbuffer, const Tile& tile,
                LayerTexels& out) {
  const auto fetch = [&](bool wanted, TextureRef ref, auto& values, std::size_t perPixel) {
    values.resize(
        wanted ? perPixel * static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height) : 0);
    if (wanted) graph.texture(ref).read(tile.width, tile.height, tile.width, values.data());
  };
  fetch(layers.albedo, gbuffer.albedo, out.albedo, 4);
  fetch(layers.normal, gbuffer.normal, out.normal, 2);
  fetch(layers.depth || layers.distance, gbuffer.distance, out.distance, 1);
  fetch(layers.id, gbuffer.id, out.id, 1);
}

void storeLayers(const PixelLayout& layout, const View& view, const Tile& tile, const LayerTexels& texels,
                 const std::vector<std::byte>& color, std::byte* band) {
  const std::array<double, 256>& linear = linearOfBytes();
  const Layers& layers = layout.layers;
  const std::size_t pixelBytes = bytesPerPixel(layout), colorBytes = bytesPerPixel(layout.format);
  std::size_t i = 0;
  for (int y = 0; y < tile.height; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(view.size.width) +
                            static_cast<std::size_t>(tile.x);
    for (int x = 0; x < tile.width; ++x, ++i) {
      PixelCursor pixel(band + pixelBytes * (row + static_cast<std::size_t>(x)));
      if (layers.color) pixel.put(color.data() + colorBytes * i, colorBytes);
      if (layers.albedo) {
        for (std::size_t c = 0; c < 3; ++c) pixel.put(static_cast<float>(linear[texels.albedo[4 * i + c]]));
      }
      if (layers.normal) {
        // A miss is cleared to zero; no normal towards the viewer is stored so.
        const glm::vec2 stored(texels.normal[2 * i], texels.normal[2 * i + 1]);
        const glm::vec3 normal =
            stored == glm::vec2(0.0f) ? glm::vec3(0.0f) : f32::decodeNormal(stored / 65535.0f);
        for (int c = 0; c < 3; ++c) pixel.put(normal[c]);
      }
      if (layers.depth)
        pixel.put(static_cast<float>(static_cast<double>(texels.distance[i]) *
                                     alongAxis(view, tile.x + x, tile.y + y)));
      if (layers.distance) pixel.put(texels.distance[i]);
      if (layers.id) pixel.put(&texels.id[i], sizeof(texels.id[i]));
    }
  }
}

}  // namespace meniscus

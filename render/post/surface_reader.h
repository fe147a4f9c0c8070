#pragma once
// A frame's G-buffer in main memory, kept there or read back, for what the processor computes of it
// (core/effects/), and what that gives.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/effects/surface_planes.h"
#include "core/tiles/tile_target.h"
#include "render/frame_graph.h"
#include "render/gbuffer.h"

namespace meniscus {

/// Channels beside depth and normal.
struct SurfaceChannels {
  bool albedo = false, id = false;
};

class SurfaceReader {
 public:
  /// What is read from now on is another frame's. shades: the processor shades it, too.
  void begin(const f32::ViewBlock& view, int width, int height, bool shades);
  /// Everything in the frame is cast by the processor, and these channels of this part of it are kept.
  void keepCast(const tiles::PlaneChannels& channels, tiles::Extent extent);
  const tiles::PlaneChannels& kept() const { return kept_; }
  tiles::Extent extent() const { return extent_; }
  /// Takes planes, of which those before have what is nearer, and gives others for them. Returns what is
  /// kept.
  const tiles::Planes& keep(tiles::Planes& planes, const tiles::PixelArea& target);
  /// Reads what has not been read of this frame.
  const effects::SurfacePlanes& read(const PassContext& context, const GBufferRefs& gbuffer,
                                     const SurfaceChannels& wanted = {});
  /// Takes away the depth that is kept, and gives other memory for it.
  void exchangeDepth(std::vector<float>& depth) { std::swap(cast_.depth, depth); }
  /// What an effect computes, pixel by pixel: if the processor shades the frame it stays in main memory.
  TextureRef createResult(FrameGraph& graph, const char* name, gl::TextureFormat format) const;
  /// Of a pass that writes nothing else.
  FrameGraph::Attachment attachment(TextureRef result) const {
    return {result, shades_ ? FrameGraph::kInMemory : 0};
  }
  /// Finishes such a result, which is read() in whole numbers or floats.
  template <typename T>
  void write(const PassContext& context, TextureRef result, const std::vector<T>& values) const {
    if (!shades_) context.texture(result).write(width_, height_, values.data(), 0, 0);
  }
  /// Reads what a pass drew or left in main memory, of which `values` must be the place.
  template <typename T>
  std::span<const T> fetch(const PassContext& context, TextureRef result, std::vector<T>& values) const {
    if (!result.valid()) return {};
    if (!context.isInMemory(result)) {
      const gl::Texture& texture = context.texture(result);
      values.resize(texture.bytes() / sizeof(T));
      texture.read(width_, height_, width_, values.data());
    }
    return values;
  }

  // Room for what effects compute: fresh memory for every frame would cost as much as the effect.
  effects::Shares visibility, lines, labels;
  std::vector<std::uint32_t> occlusion;
  std::vector<float> difference, traced;

 private:
  effects::SurfacePlanes planes_;
  tiles::Planes cast_;
  tiles::PlaneChannels kept_;
  tiles::Extent extent_ = tiles::Extent::whole;
  std::vector<float> depth_;
  std::vector<std::uint32_t> normal_, albedo_, id_;
  int width_ = 0, height_ = 0;
  bool shades_ = false;
};

/// Whether the processor computes effects, and why, for --explain.
struct EffectsChoice {
  bool processor = false;
  std::string reason;
};
/// wanted: nothing = where OpenGL runs on the processor. A context must be current.
EffectsChoice chooseEffects(std::optional<bool> wanted);

}  // namespace meniscus

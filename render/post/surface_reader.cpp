#include "render/post/surface_reader.h"

#include <utility>

#include "core/tiles/instruction_sets.h"

namespace meniscus {

void SurfaceReader::begin(const f32::ViewBlock& view, int width, int height, bool shades) {
  planes_ = {};
  planes_.view = view;
  planes_.width = width_ = width;
  planes_.height = height_ = height;
  shades_ = shades;
}

void SurfaceReader::keepCast(const tiles::PlaneChannels& channels, tiles::Extent extent) {
  kept_ = channels;
  extent_ = extent;
}

const tiles::Planes& SurfaceReader::keep(tiles::Planes& planes, const tiles::PixelArea& target) {
  static_assert(tiles::kPlanePadding >= effects::kMostLanes);
  if (planes_.depth.empty()) {
    std::swap(cast_, planes);
  } else {
    tiles::mergeNearer(cast_, planes);
  }
  planes_.x = cast_.area.x - target.x;
  planes_.y = cast_.area.y - target.y;
  planes_.width = cast_.area.width;
  planes_.height = cast_.area.height;
  planes_.depth = cast_.depth;
  planes_.albedo = cast_.albedo;
  planes_.normal = cast_.normal;
  planes_.id = cast_.id;
  return cast_;
}

const effects::SurfacePlanes& SurfaceReader::read(const PassContext& context, const GBufferRefs& gbuffer,
                                                  const SurfaceChannels& wanted) {
  const auto fetch = [&](TextureRef channel, auto& values, auto& plane) {
    if (!plane.empty()) return;
    values.resize(planes_.pixels() + effects::kMostLanes);
    context.texture(channel).read(width_, height_, width_, values.data());
    plane = values;
  };
  fetch(gbuffer.depth, depth_, planes_.depth);
  fetch(gbuffer.normal, normal_, planes_.normal);
  if (wanted.albedo) fetch(gbuffer.albedo, albedo_, planes_.albedo);
  if (wanted.id) fetch(gbuffer.id, id_, planes_.id);
  return planes_;
}

TextureRef SurfaceReader::createResult(FrameGraph& graph, const char* name, gl::TextureFormat format) const {
  return shades_ ? graph.createInMemory(name) : graph.create(name, {format, width_, height_});
}

EffectsChoice chooseEffects(std::optional<bool> wanted) {
  const gl::Device device = gl::queryDevice();
  const bool processor = wanted.value_or(device.software);
  if (!processor) return {false, wanted ? "as asked for" : device.name + " is a GPU"};
  return {true, "computed by " + tiles::instructionSet() +
                    " instructions: " + (wanted ? "as asked for" : device.name + " runs on the processor")};
}

}  // namespace meniscus

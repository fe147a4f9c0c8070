#include "render/post/surface_reader.h"

#include "core/tiles/instruction_sets.h"

namespace meniscus {

void SurfaceReader::begin(const f32::ViewBlock& view, int width, int height) {
  planes_.view = view;
  planes_.width = width;
  planes_.height = height;
  surface_ = ids_ = false;
}

const effects::SurfacePlanes& SurfaceReader::read(const PassContext& context, const GBufferRefs& gbuffer,
                                                  bool ids) {
  const auto fetch = [&](TextureRef channel, auto& plane) {
    plane.resize(planes_.pixels() + effects::kMostLanes);
    context.texture(channel).read(planes_.width, planes_.height, planes_.width, plane.data());
  };
  if (!surface_) {
    fetch(gbuffer.depth, planes_.depth);
    fetch(gbuffer.normal, planes_.normal);
    surface_ = true;
  }
  if (ids && !ids_) {
    fetch(gbuffer.id, planes_.id);
    ids_ = true;
  }
  return planes_;
}

void SurfaceReader::write(const PassContext& context, TextureRef target,
                          const effects::Shares& shares) const {
  context.texture(target).write(planes_.width, planes_.height, shares.data(), 0, 0);
}

EffectsChoice chooseEffects(std::optional<bool> wanted) {
  const gl::Device device = gl::queryDevice();
  const bool processor = wanted.value_or(device.software);
  if (!processor) return {false, wanted ? "as asked for" : device.name + " is a GPU"};
  return {true, "computed by " + tiles::instructionSet() +
                    " instructions: " + (wanted ? "as asked for" : device.name + " runs on the processor")};
}

}  // namespace meniscus

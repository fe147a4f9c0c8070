#include "render/tile_planes.h"

namespace meniscus {

tiles::PlaneChannels wantedPlanes(const PassContext& context, const GBufferRefs& gbuffer) {
  return {context.isLive(gbuffer.albedo), context.isLive(gbuffer.normal), context.isLive(gbuffer.id),
          context.isLive(gbuffer.distance)};
}

void writePlanes(const PassContext& context, const GBufferRefs& gbuffer, const tiles::Planes& planes,
                 const tiles::PixelArea& area) {
  const auto write = [&](TextureRef channel, const auto& plane) {
    if (!context.isLive(channel)) return;
    const tiles::PixelArea& part = planes.area;
    context.texture(channel).write(part.width, part.height, plane.data(), part.x - area.x, part.y - area.y);
  };
  write(gbuffer.depth, planes.depth);
  write(gbuffer.albedo, planes.albedo);
  write(gbuffer.normal, planes.normal);
  write(gbuffer.id, planes.id);
  write(gbuffer.distance, planes.distance);
}

}  // namespace meniscus

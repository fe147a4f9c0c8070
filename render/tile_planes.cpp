#include "render/tile_planes.h"

#include "render/post/surface_reader.h"

namespace meniscus {

tiles::PlaneChannels wantedPlanes(const PassContext& context, const GBufferRefs& gbuffer) {
  tiles::PlaneChannels wanted{context.isLive(gbuffer.albedo), context.isLive(gbuffer.normal),
                              context.isLive(gbuffer.id), context.isLive(gbuffer.distance)};
  if (gbuffer.planes.valid()) {
    const tiles::PlaneChannels& kept = gbuffer.memory->kept();
    wanted.albedo = wanted.albedo || kept.albedo;
    wanted.normal = wanted.normal || kept.normal;
    wanted.id = wanted.id || kept.id;
  }
  return wanted;
}

tiles::Extent wantedExtent(const GBufferRefs& gbuffer) {
  return gbuffer.planes.valid() ? gbuffer.memory->extent() : tiles::Extent::occupied;
}

void writePlanes(const PassContext& context, const GBufferRefs& gbuffer, tiles::Planes& planes,
                 const tiles::PixelArea& area) {
  const tiles::Planes& all = gbuffer.planes.valid() ? gbuffer.memory->keep(planes, area) : planes;
  const auto write = [&](TextureRef channel, const auto& plane) {
    if (!context.isLive(channel)) return;
    const tiles::PixelArea& part = all.area;
    context.texture(channel).write(part.width, part.height, plane.data(), part.x - area.x, part.y - area.y);
  };
  write(gbuffer.depth, all.depth);
  write(gbuffer.albedo, all.albedo);
  write(gbuffer.normal, all.normal);
  write(gbuffer.id, all.id);
  write(gbuffer.distance, all.distance);
}

}  // namespace meniscus

#include "render/gbuffer.h"

namespace meniscus {

GBufferRefs createGBuffer(FrameGraph& graph, int width, int height) {
  using gl::TextureFormat;
  GBufferRefs g;
  g.depth = graph.create("depth", {TextureFormat::depth32f, width, height});
  g.albedo = graph.create("albedo", {TextureFormat::rgba8, width, height});
  g.normal = graph.create("normal", {TextureFormat::rg16, width, height});
  g.id = graph.create("id", {TextureFormat::r32ui, width, height});
  g.distance = graph.create("distance", {TextureFormat::r32f, width, height}, Clear::infinity);
  return g;
}

}  // namespace meniscus

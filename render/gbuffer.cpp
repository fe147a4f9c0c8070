#include "render/gbuffer.h"

#include <utility>

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

std::vector<FrameGraph::Attachment> attachmentsOf(const GBufferRefs& g) {
  std::vector<FrameGraph::Attachment> writes{{g.depth, FrameGraph::kDepth}};
  for (const auto& [channel, location] :
       {std::pair{g.albedo, 0}, std::pair{g.normal, 1}, std::pair{g.id, 2}, std::pair{g.distance, 3}}) {
    if (channel.valid()) writes.push_back({channel, location});
  }
  if (g.planes.valid()) writes.push_back({g.planes, FrameGraph::kInMemory});
  return writes;
}

std::vector<TextureRef> surfaceOf(const GBufferRefs& g) {
  if (g.planes.valid()) return {g.planes};
  return {g.depth, g.normal};
}

ShaderFlags channelFlags(const PassContext& context, const GBufferRefs& g) {
  ShaderFlags flags;
  if (context.isLive(g.albedo)) flags.insert("ALBEDO");
  if (context.isLive(g.normal)) flags.insert("NORMAL");
  if (context.isLive(g.id)) flags.insert("ID");
  if (context.isLive(g.distance)) flags.insert("DISTANCE");
  return flags;
}

}  // namespace meniscus

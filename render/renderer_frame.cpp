// The passes of a picture.

#include <glad/gl.h>

#include <algorithm>
#include <utility>

#include "core/light_view.h"
#include "render/post/translucent.h"
#include "render/renderer_impl.h"

namespace meniscus {

void Renderer::Impl::takePrimitives() {
  splatQuadrics.setPrimitives(
      primitives, [this]() -> const Primitives& { return *apart(); },
      [this](const Primitives& balls) { return eachCopyOf(balls); });
  tileQuadrics.setPrimitives(primitives);
  glslTileQuadrics.setPrimitives(primitives);
}

void Renderer::Impl::prepare(const View& view, QuadricMethod method, bool levelOfDetail,
                             const SurfaceSettings& surface) {
  thinned = levelOfDetail;
  if (!options.shaderDir.empty()) shaders.reloadIfChanged();
  stats.omissions.clear();  // of an earlier picture
  Stopwatch watch(stats.uploadMs);
  quadricChoice = chooseQuadrics(method);
  if (quadricChoice.method == QuadricMethod::splat)
    splatQuadrics.upload(targetOf(view, {0, 0, view.size.width, view.size.height}, {0, 0}));
  triangles.upload(primitives->mesh);
  surfaces.prepare(primitives, surface);
  if (!viewUniforms.object) viewUniforms = gl::Buffer::updatable(sizeof(f32::ViewBlock));
}

Primitives Renderer::Impl::eachCopyOf(const Primitives& some) const {
  if (copyGuard) copyGuard(some.counts());
  return meniscus::copiesApart(some);
}

const std::shared_ptr<const Primitives>& Renderer::Impl::apart() {
  if (!copiesApart) {
    copiesApart =
        primitives->units.empty() ? primitives : std::make_shared<const Primitives>(eachCopyOf(*primitives));
  }
  return copiesApart;
}

f32::ViewBlock Renderer::Impl::setView(const View& view, const Tile& tile, glm::vec2 sampleShift) {
  const f32::ViewBlock block = makeViewBlock(view, primitives->origin, tile, sampleShift);
  viewUniforms.update(&block);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, viewUniforms.object.name());
  return block;
}

tiles::TileTarget Renderer::Impl::targetOf(const View& view, const Tile& tile, glm::vec2 sampleShift) const {
  return {view, primitives->origin, {tile.x, tile.y, tile.width, tile.height}, sampleShift, thinned};
}

void Renderer::Impl::addScene(FrameGraph& graph, const View& view, const Tile& tile, glm::vec2 sampleShift,
                              const GBufferRefs& gbuffer, Surfaces drawn, const std::string& prefix) {
  if (quadricChoice.method == QuadricMethod::splat) {
    splatQuadrics.add(graph, shaders, targetOf(view, tile, sampleShift), gbuffer, prefix);
  } else if (primitives->noQuadrics()) {
    graph.leaveOut("pass " + prefix + "tiles", "the scene has no quadrics");
  } else if (quadricChoice.method == QuadricMethod::tiles) {
    tileQuadrics.add(graph, targetOf(view, tile, sampleShift), gbuffer, prefix);
  } else {
    glslTileQuadrics.add(graph, shaders, targetOf(view, tile, sampleShift), gbuffer, prefix);
  }
  leaveOutOtherQuadrics(graph, prefix);
  addTriangles(graph, triangles, shaders, gbuffer, prefix);
  if (drawn == Surfaces::opaque) {
    SurfaceTarget target{view, primitives->origin, tile, sampleShift, gbuffer, prefix};
    target.first = primitives->onlySurfaces();
    surfaces.add(graph, shaders, target);
  }
}

void Renderer::Impl::leaveOutOtherQuadrics(FrameGraph& graph, const std::string& prefix) {
  if (quadricChoice.method == QuadricMethod::splat) {
    graph.leaveOut("pass " + prefix + "tiles", "quadrics are splatted: " + quadricChoice.reason);
    return;
  }
  const QuadricCounts all = primitives->counts();
  for (const auto& [name, count] : {std::pair{"spheres", all.spheres}, std::pair{"cylinders", all.cylinders},
                                    std::pair{"ellipsoids", all.ellipsoids}}) {
    graph.leaveOut("pass " + prefix + name, count == 0 ? "the scene has none" : quadricChoice.reason);
  }
}

bool Renderer::Impl::castsAll(const SurfaceSettings& surface) const {
  if (primitives->empty() || !primitives->mesh.empty()) return false;
  return (primitives->noQuadrics() || quadricChoice.method == QuadricMethod::tiles) &&
         (primitives->surfaces.empty() || surfaceMethodFor(surface).planes);
}

void Renderer::Impl::keepInMemory(FrameGraph& graph, const Frame& frame, GBufferRefs& gbuffer) {
  graph.leaveOut("G-buffer in textures", "the processor casts and shades: only what shaders read is there");
  const RenderSettings& settings = frame.settings;
  const std::size_t casts = (primitives->noQuadrics() ? 0 : 1) + primitives->surfaces.size();
  const bool lookAround = settings.lines.any() || settings.depthUnsharp.mode != UnsharpMode::off ||
                          frame.traced || !labelBuffers.empty();
  surfaceReader.keepCast({.id = settings.lines.groups != LineGroups::none},
                         casts > 1 || lookAround ? tiles::Extent::whole : tiles::Extent::occupied);
  gbuffer.planes = graph.createInMemory("planes");
  gbuffer.memory = &surfaceReader;
}

GBufferRefs Renderer::Impl::buildFrame(FrameGraph& graph, const Frame& frame, const Tile& tile,
                                       glm::vec2 sampleShift, const LightTarget& target) {
  const f32::ViewBlock block = setView(frame.view, tile, sampleShift);
  GBufferRefs gbuffer = createGBuffer(graph, tile.width, tile.height);
  surfaceReader.begin(block, tile.width, tile.height, frame.processorShades);
  if (frame.processorShades && castsAll(frame.settings.surface)) keepInMemory(graph, frame, gbuffer);
  addScene(graph, frame.view, tile, sampleShift, gbuffer,
           frame.translucent ? Surfaces::apart : Surfaces::opaque);
  SurfaceReader* const reader = effects.processor ? &surfaceReader : nullptr;
  LightRefs light;
  if (frame.traced) {
    tracedLight.add(graph, frame.view, tile, sampleShift, light, frame.watch);
  } else {
    graph.leaveOut("pass trace", "no rays are traced");
  }
  if (light.visibility.valid()) {
    graph.leaveOut("pass shadow", "shadows are traced");
  } else if (frame.shadowMap.drawn()) {
    light.visibility = addShadow(graph, frame.settings.shadows, frame.shadowMap, shadowUniforms, shaders,
                                 gbuffer, tile.width, tile.height, reader);
    if (effects.processor) graph.leaveOut("program of shadow", effects.reason);
  } else {
    graph.leaveOut("pass shadow", "shadows are off");
  }
  if (light.occlusion.valid()) {
    graph.leaveOut("pass occlusion", "ambient occlusion is traced");
  } else if (frame.occlusion) {
    light.occlusion =
        addOcclusion(graph, occlusionBuffers, shaders, gbuffer, tile.width, tile.height, reader);
    if (effects.processor) graph.leaveOut("programs of occlusion", effects.reason);
  } else {
    graph.leaveOut("pass occlusion", "ambient occlusion is off");
  }
  if (frame.settings.depthUnsharp.mode != UnsharpMode::off) {
    light.difference = addDepthUnsharp(graph, frame.unsharp, unsharpUniforms, shaders, gbuffer, tile, reader);
    if (effects.processor) graph.leaveOut("programs of depth unsharp", effects.reason);
  } else {
    graph.leaveOut("pass depth unsharp", "depth unsharp masking is off");
  }
  if (frame.settings.lines.any()) {
    light.lines = addSilhouette(graph, frame.settings.lines, silhouetteUniforms, shaders, gbuffer, tile.width,
                                tile.height, reader);
    if (effects.processor) graph.leaveOut("program of silhouette", effects.reason);
  } else {
    graph.leaveOut("pass silhouette", "outlines are off");
  }
  TextureRef over;  // labels
  if (!labelBuffers.empty()) {
    over = addLabels(graph, labelBuffers, shaders, gbuffer, tile);
  } else {
    graph.leaveOut("pass labels", "there are none in the picture");
  }
  if (!frame.translucent) {
    graph.leaveOut("pass translucent", "no surface is translucent");
    light.labels = over;
  }
  if (frame.processorShades) {
    graph.leaveOut("program of shade", effects.reason);
    graph.want(addProcessorShade(graph, shadeUniforms, surfaceReader, gbuffer, light, target.memory));
    return gbuffer;
  }
  const TextureRef texture = graph.import(target.name, *target.texture, target.clear);
  if (frame.translucent) {
    addShadeUnderLayers(graph, frame, tile, sampleShift, gbuffer, light, over, texture);
  } else {
    addShade(graph, frame.shade, shadeUniforms, shaders, gbuffer, light, texture);
  }
  graph.want(texture);
  return gbuffer;
}

void Renderer::Impl::addShadeUnderLayers(FrameGraph& graph, const Frame& frame, const Tile& tile,
                                         glm::vec2 sampleShift, const GBufferRefs& gbuffer,
                                         const LightRefs& light, TextureRef over, TextureRef target) {
  graph.leaveOut("methods but lists", "a surface is translucent, and only lists draws layers");
  ShadeSettings opaque = frame.shade;
  opaque.final = false;
  const TextureRef below = graph.create("light", {gl::TextureFormat::rgba32f, tile.width, tile.height});
  addShade(graph, opaque, shadeUniforms, shaders, gbuffer, light, below);
  const SurfaceLayerRefs layers =
      surfaces.addLayers(graph, shaders, {frame.view, primitives->origin, tile, sampleShift, gbuffer, {}});
  addTranslucent(graph, frame.shade, shadeUniforms, shaders, layers, below, over, target);
}

void Renderer::Impl::drawShadowMap(Frame& frame) {
  if (!extent) extent = {primitives->bounds(), primitives->thinnestRadius()};
  const auto& [bounds, thinnest] = *extent;
  const int maxSize = largestShadowMap(frame.view.size);
  const ShadowSettings& shadows = frame.settings.shadows;
  const double penumbra = shadows.mode == ShadowMode::soft ? shadows.penumbra : 0;
  const double texel = shadowTexelSize(pixelFootprint(frame.view, bounds), penumbra, thinnest);
  const View light = makeLightView(frame.view, frame.shade.lighting.key, bounds, texel, maxSize, penumbra);
  KeptShadowMap& kept = keptShadowMap;
  if (kept.map.drawn() && kept.map.light == light && kept.surface == frame.settings.surface &&
      kept.quadrics == quadricChoice.method && kept.thinned == thinned &&
      kept.translucent == frame.translucent) {
    frame.shadowMap = kept.map;
    stats.omissions.push_back({"pass shadow map", "the light and the scene are those of the picture before"});
    return;
  }
  const Tile whole{0, 0, light.size.width, light.size.height};
  kept = {};
  const gl::TextureDesc desc{gl::TextureFormat::depth32f, whole.width, whole.height};
  const bool inMemory = effects.processor && !frame.translucent && castsAll(frame.settings.surface);
  TextureLease texture(nullptr, ReturnToPool{});
  const f32::ViewBlock block = setView(light, whole, {0, 0});
  FrameGraph graph(pool);
  GBufferRefs gbuffer;
  if (inMemory) {
    graph.leaveOut("channel shadow map", "the processor casts it and looks it up");
    surfaceReader.begin(block, whole.width, whole.height, true);
    surfaceReader.keepCast({.albedo = false, .normal = false, .id = false}, tiles::Extent::whole);
    gbuffer.depth = graph.create("shadow map", desc);
    gbuffer.planes = graph.createInMemory("shadow heights");
    gbuffer.memory = &surfaceReader;
  } else {
    texture = pool.lease("shadow map", desc);
    gbuffer.depth = graph.import("shadow map", *texture, Clear::zero);
  }
  addScene(graph, light, whole, {0, 0}, gbuffer, frame.translucent ? Surfaces::apart : Surfaces::opaque,
           "shadow map: ");
  if (frame.translucent) graph.leaveOut("pass shadow map: surface", "what is translucent casts no shadow");
  graph.want(inMemory ? gbuffer.planes : gbuffer.depth);
  execute(graph);
  frame.shadowMap = {light, texture.get()};
  if (effects.processor) {
    if (shadowHeights.use_count() != 1) shadowHeights = std::make_shared<std::vector<float>>();
    if (inMemory) {
      surfaceReader.exchangeDepth(*shadowHeights);
    } else {
      shadowHeights->resize(static_cast<std::size_t>(whole.width) * static_cast<std::size_t>(whole.height));
      texture->read(whole.width, whole.height, whole.width, shadowHeights->data());
    }
    frame.shadowMap.heights = shadowHeights;
  }
  kept = {frame.shadowMap, frame.settings.surface, quadricChoice.method,
          thinned,         frame.translucent,      std::move(texture)};
}

void Renderer::Impl::setEffects(Frame& frame) {
  RenderSettings& settings = frame.settings;
  if (primitives->empty()) {
    settings.lines = {};
    settings.depthUnsharp = {};
  }
  if (settings.lines.any()) {
    silhouetteUniforms.set(settings.lines, frame.view);
    silhouetteUniforms.setGroups(primitives->groups);
  }
  labelBuffers.set(labels, labelColors, frame.view);
  frame.unsharp = unsharpKernel(unsharpSigma(settings.depthUnsharp, frame.view));
  frame.margin = std::max({reachOf(settings.lines), reachOf(settings.depthUnsharp, frame.view),
                           settings.trace.occlusion > 0 ? 0 : reachOf(settings.occlusion, settings.samples)});
}

void Renderer::Impl::drawOcclusion(Frame& frame, const std::function<void(double)>& progress) {
  double spent = 0;
  {
    Stopwatch watch(spent);
    if (frame.translucent && !withoutSurfaces) {
      auto opaque = std::make_shared<Primitives>(*apart());
      opaque->surfaces = {};
      withoutSurfaces = std::move(opaque);
    }
    // What is translucent occludes nothing.
    const Primitives& occluders = frame.translucent ? *withoutSurfaces : *apart();
    const auto tell = [&] {
      if (progress) progress(0);
    };
    occlusionBuffers.set(frame.view, drawOcclusionMaps(occluders, frame.view, frame.settings.occlusion, tell),
                         effects.processor);
  }
  auto pass = std::find_if(stats.passes.begin(), stats.passes.end(),
                           [](const PassStats& s) { return s.name == "occlusion maps"; });
  if (pass == stats.passes.end()) pass = stats.passes.insert(pass, {"occlusion maps", 0, 0.0});
  ++pass->runs;
  pass->milliseconds += spent;
  frame.occlusion = true;
}

}  // namespace meniscus

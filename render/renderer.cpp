#include "render/renderer.h"

#include <glad/gl.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <glm/vec4.hpp>
#include <limits>

#include "core/error.h"
#include "core/light_view.h"
#include "core/sampling.h"
#include "core/valid_primitives.h"
#include "render/gbuffer.h"
#include "render/gl/context.h"
#include "render/layers.h"
#include "render/picture_parts.h"
#include "render/post/depth_unsharp.h"
#include "render/post/labels.h"
#include "render/post/occlusion.h"
#include "render/post/resolve.h"
#include "render/post/shade.h"
#include "render/post/shadow.h"
#include "render/post/silhouette.h"
#include "render/post/surface_reader.h"
#include "render/post/traced_light.h"
#include "render/post/translucent.h"
#include "render/splat_quadrics.h"
#include "render/surface_passes.h"
#include "render/tile_quadrics.h"
#include "render/tile_quadrics_glsl.h"
#include "render/triangles.h"
#include "render/view_block.h"

namespace meniscus {

namespace {

gl::TextureFormat textureFormat(PixelFormat format) {
  switch (format) {
    case PixelFormat::rgba8:
      return gl::TextureFormat::rgba8;
    case PixelFormat::rgba16:
      return gl::TextureFormat::rgba16;
    case PixelFormat::rgbaFloat:
      return gl::TextureFormat::rgba32f;
  }
  return gl::TextureFormat::rgba8;
}

class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(sum) {}
  ~Stopwatch() {
    sum_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& sum_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// A picture that is being drawn.
struct Frame {
  const View& view;
  RenderSettings settings;
  ShadeSettings shade;
  Layers layers;
  ShadowMap shadowMap;  // not drawn if there are no shadows
  bool occlusion = false;
  UnsharpKernel unsharp = {};
  int margin = 0;            // of a tile: how far its pixels' effects look [pixels]
  bool translucent = false;  // surfaces are laid over the rest, layer by layer
  bool traced = false;       // some of the light
  bool processorShades = false;
  std::function<void()> watch = {};  // is called now and then while a pass takes long; may throw
};

// Where a tile's picture goes: into a texture, or where the processor shades into main memory.
struct PictureTarget {
  const gl::Texture* texture = nullptr;
  effects::PictureRows rows = {};  // in the tile with its margin
};

// Where the light of a sample goes: to be the picture, or to be added to a sum.
struct LightTarget {
  const char* name;
  const gl::Texture* texture = nullptr;
  Clear clear = Clear::none;
  ProcessorShadeTarget memory = {};
};

// What becomes of the surfaces of a scene.
enum class Surfaces : std::uint8_t { opaque, apart };

// A shadow map serves as long as the light and what it falls on stay: for a still camera, whatever else of
// the picture changes.
struct KeptShadowMap {
  ShadowMap map;
  SurfaceSettings surface;
  QuadricMethod quadrics = QuadricMethod::automatic;
  bool thinned = false;
  bool translucent = false;  // surfaces cast no shadow
  TextureLease texture{nullptr, ReturnToPool{}};
};

// What of the primitives a shadow map depends on.
struct ShadowCasters {
  BoundingSphere bounds;
  double thinnest;
};

}  // namespace

struct Renderer::Impl {
  RendererOptions options;
  ShaderLibrary shaders;
  TexturePool pool;
  SplatQuadrics splatQuadrics;
  TileQuadrics tileQuadrics;
  GlslTileQuadrics glslTileQuadrics;
  QuadricChoice quadricChoice;
  bool thinned = false;  // quadrics much smaller than a pixel
  TriangleBuffers triangles;
  SurfacePasses surfaces;
  ShadeUniforms shadeUniforms;
  ShadowUniforms shadowUniforms;
  OcclusionBuffers occlusionBuffers;
  SilhouetteUniforms silhouetteUniforms;
  DepthUnsharpUniforms unsharpUniforms;
  std::vector<LabelSprite> labels;
  LabelColors labelColors;
  PicturePreview preview;
  LabelBuffers labelBuffers;
  gl::Buffer viewUniforms;
  SurfaceReader surfaceReader;
  EffectsChoice effects;
  TracedLight tracedLight;
  KeptShadowMap keptShadowMap;
  std::optional<ShadowCasters> extent;  // of the primitives; found out when it is wanted first
  // Memory that one picture after the other uses: fresh pages for every frame cost more than what is written.
  std::shared_ptr<std::vector<float>> shadowHeights;
  std::vector<std::byte> band;
  effects::LightSum lightSum;
  std::shared_ptr<const Primitives> primitives = std::make_shared<Primitives>();
  // The same; made when they are wanted first.
  std::shared_ptr<const Primitives> copiesApart, withoutSurfaces;
  RenderStats stats;
  double forgottenCompileMs = 0;

  explicit Impl(const RendererOptions& o)
      : options(o), shaders(o.shaderDir), effects(chooseEffects(o.effectsOnProcessor)) {
    takePrimitives();
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glDisable(GL_DITHER);
    glDisable(GL_MULTISAMPLE);
  }

  // To the ways to draw quadrics.
  void takePrimitives() {
    splatQuadrics.setPrimitives(primitives, [this]() -> const Primitives& { return *apart(); });
    tileQuadrics.setPrimitives(primitives);
    glslTileQuadrics.setPrimitives(primitives);
  }

  void prepare(const View& view, QuadricMethod method, bool levelOfDetail, const SurfaceSettings& surface) {
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

  // For what draws no copies: all that is not cast from tiles.
  const std::shared_ptr<const Primitives>& apart() {
    if (!copiesApart) {
      copiesApart = primitives->units.empty()
                        ? primitives
                        : std::make_shared<const Primitives>(meniscus::copiesApart(*primitives));
    }
    return copiesApart;
  }

  f32::ViewBlock setView(const View& view, const Tile& tile, glm::vec2 sampleShift) {
    const f32::ViewBlock block = makeViewBlock(view, primitives->origin, tile, sampleShift);
    viewUniforms.update(&block);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, viewUniforms.object.name());
    return block;
  }

  tiles::TileTarget targetOf(const View& view, const Tile& tile, glm::vec2 sampleShift) const {
    return {view, primitives->origin, {tile.x, tile.y, tile.width, tile.height}, sampleShift, thinned};
  }

  // All that is to be seen, or all but the surfaces, into the channels of a G-buffer. setView() must have
  // been called alike.
  void addScene(FrameGraph& graph, const View& view, const Tile& tile, glm::vec2 sampleShift,
                const GBufferRefs& gbuffer, Surfaces drawn, const std::string& prefix = {}) {
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

  void leaveOutOtherQuadrics(FrameGraph& graph, const std::string& prefix) {
    if (quadricChoice.method == QuadricMethod::splat) {
      graph.leaveOut("pass " + prefix + "tiles", "quadrics are splatted: " + quadricChoice.reason);
      return;
    }
    const QuadricCounts all = primitives->counts();
    for (const auto& [name, count] :
         {std::pair{"spheres", all.spheres}, std::pair{"cylinders", all.cylinders},
          std::pair{"ellipsoids", all.ellipsoids}}) {
      graph.leaveOut("pass " + prefix + name, count == 0 ? "the scene has none" : quadricChoice.reason);
    }
  }

  // Whether the processor draws whatever there is.
  bool castsAll(const SurfaceSettings& surface) const {
    if (primitives->empty() || !primitives->mesh.empty()) return false;
    return (primitives->noQuadrics() || quadricChoice.method == QuadricMethod::tiles) &&
           (primitives->surfaces.empty() || surfaceMethodFor(surface).planes);
  }

  // Textures are left to those that draw from them.
  void keepInMemory(FrameGraph& graph, const Frame& frame, GBufferRefs& gbuffer) {
    graph.leaveOut("G-buffer in textures", "the processor casts and shades: only what shaders read is there");
    const RenderSettings& settings = frame.settings;
    const std::size_t casts = (primitives->noQuadrics() ? 0 : 1) + primitives->surfaces.size();
    const bool lookAround = settings.lines.any() || settings.depthUnsharp.mode != UnsharpMode::off ||
                            frame.occlusion || frame.traced || !labelBuffers.empty();
    surfaceReader.keepCast({.id = settings.lines.groups != LineGroups::none},
                           casts > 1 || lookAround ? tiles::Extent::whole : tiles::Extent::occupied);
    gbuffer.planes = graph.createInMemory("planes");
    gbuffer.memory = &surfaceReader;
  }

  // One sample of one tile: every pass of the program is named here.
  GBufferRefs buildFrame(FrameGraph& graph, const Frame& frame, const Tile& tile, glm::vec2 sampleShift,
                         const LightTarget& target) {
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
      light.occlusion = addOcclusion(graph, occlusionBuffers, shaders, gbuffer, tile.width, tile.height);
    } else {
      graph.leaveOut("pass occlusion", "ambient occlusion is off");
    }
    if (frame.settings.depthUnsharp.mode != UnsharpMode::off) {
      light.difference =
          addDepthUnsharp(graph, frame.unsharp, unsharpUniforms, shaders, gbuffer, tile, reader);
      if (effects.processor) graph.leaveOut("programs of depth unsharp", effects.reason);
    } else {
      graph.leaveOut("pass depth unsharp", "depth unsharp masking is off");
    }
    if (frame.settings.lines.any()) {
      light.lines = addSilhouette(graph, frame.settings.lines, silhouetteUniforms, shaders, gbuffer,
                                  tile.width, tile.height, reader);
      if (effects.processor && !frame.settings.lines.creases)
        graph.leaveOut("program of silhouette", effects.reason);
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

  // What is opaque, and the layers of translucent surfaces over it.
  void addShadeUnderLayers(FrameGraph& graph, const Frame& frame, const Tile& tile, glm::vec2 sampleShift,
                           const GBufferRefs& gbuffer, const LightRefs& light, TextureRef over,
                           TextureRef target) {
    graph.leaveOut("methods but lists", "a surface is translucent, and only lists draws layers");
    ShadeSettings opaque = frame.shade;
    opaque.final = false;
    const TextureRef below = graph.create("light", {gl::TextureFormat::rgba32f, tile.width, tile.height});
    addShade(graph, opaque, shadeUniforms, shaders, gbuffer, light, below);
    const SurfaceLayerRefs layers =
        surfaces.addLayers(graph, shaders, {frame.view, primitives->origin, tile, sampleShift, gbuffer, {}});
    addTranslucent(graph, frame.shade, shadeUniforms, shaders, layers, below, over, target);
  }

  void drawShadowMap(Frame& frame);
  void drawOcclusion(Frame& frame, const std::function<void(double)>& progress);
  void setEffects(Frame& frame);
  void drawTile(const Frame& frame, const Tile& part, const PictureTarget& picture, LayerTexels& texels,
                const std::function<void(double)>& progress);
  void drawData(const Frame& frame, const Tile& tile, LayerTexels& texels);
  void resolve(const Frame& frame, int samples, const gl::Texture* sum, const PictureTarget& picture);
  void showPreview(const Frame& frame, const gl::Texture* sum, const PictureTarget& picture, int samples);
  void execute(FrameGraph& graph) { graph.execute(stats, options.timePasses); }
};

Renderer::Renderer(const RendererOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Renderer::~Renderer() = default;

void Renderer::setPrimitives(std::shared_ptr<const Primitives> primitives) {
  requireFinite(*primitives);
  impl_->primitives = std::move(primitives);
  impl_->copiesApart.reset();
  impl_->withoutSurfaces.reset();
  impl_->surfaces.takeStats(impl_->stats.surfaces);
  impl_->surfaces.clear();
  impl_->triangles.clear();
  impl_->takePrimitives();
  impl_->tracedLight.setPrimitives(nullptr);
  impl_->occlusionBuffers.clear();
  impl_->silhouetteUniforms.clearGroups();
  impl_->keptShadowMap = {};
  impl_->extent.reset();
  impl_->pool.trim();
}

bool Renderer::drawsCopiesApart(const RenderSettings& settings) const {
  return settings.occlusion.on || settings.trace.any() ||
         chooseQuadrics(settings.quadrics).method == QuadricMethod::splat;
}

void Renderer::setLabels(std::vector<LabelSprite> labels, const LabelColors& colors) {
  impl_->labels = std::move(labels);
  impl_->labelColors = colors;
}

void Renderer::setPreview(PicturePreview preview) {
  impl_->preview = std::move(preview);
}

// The same primitives as seen from the key light, with only their depth wanted.
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

// What the effects of a whole picture share.
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

// Counted as a pass, though the processor draws them.
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
    occlusionBuffers.set(frame.view, drawOcclusionMaps(occluders, frame.view, frame.settings.occlusion, [&] {
                           if (progress) progress(0);
                         }));
  }
  auto pass = std::find_if(stats.passes.begin(), stats.passes.end(),
                           [](const PassStats& s) { return s.name == "occlusion maps"; });
  if (pass == stats.passes.end()) pass = stats.passes.insert(pass, {"occlusion maps", 0, 0.0});
  ++pass->runs;
  pass->milliseconds += spent;
  frame.occlusion = true;
}

// What the rays through the pixels' centres meet, without colour.
void Renderer::Impl::drawData(const Frame& frame, const Tile& tile, LayerTexels& texels) {
  setView(frame.view, tile, {0, 0});
  FrameGraph graph(pool);
  const GBufferRefs gbuffer = createGBuffer(graph, tile.width, tile.height);
  addScene(graph, frame.view, tile, {0, 0}, gbuffer, Surfaces::opaque);
  if (!frame.layers.color) graph.leaveOut("pass shade", "no colour is wanted");
  wantLayers(graph, frame.layers, gbuffer);
  execute(graph);
  readLayers(graph, frame.layers, gbuffer, tile, texels);
}

// A texture gets the margin of `part`, too. Data comes with the colour where both need the same rays.
void Renderer::Impl::drawTile(const Frame& frame, const Tile& part, const PictureTarget& picture,
                              LayerTexels& texels, const std::function<void(double)>& progress) {
  const Tile tile = withMargin(part, frame.margin, frame.view.size);
  const bool dataApart = !frame.shade.final || tile != part || frame.translucent;
  if (frame.settings.depthUnsharp.mode != UnsharpMode::off) unsharpUniforms.set(frame.unsharp, tile);
  if (frame.layers.data() && dataApart) drawData(frame, part, texels);
  const int samples = frame.settings.samples;
  const auto setShadow = [&](int sample) {
    if (frame.shadowMap.drawn())
      shadowUniforms.set(frame.settings.shadows, frame.view, frame.shadowMap, sample, samples);
    if (frame.occlusion) occlusionBuffers.chooseDirections(sample, samples, tile);
    if (frame.traced) tracedLight.choose(sample, samples);
  };
  if (frame.shade.final) {
    setShadow(0);
    FrameGraph graph(pool);
    graph.leaveOut("pass resolve", "one sample per pixel");
    const GBufferRefs gbuffer =
        buildFrame(graph, frame, tile, {0, 0},
                   {.name = "picture", .texture = picture.texture, .memory = {.picture = picture.rows}});
    if (!dataApart) wantLayers(graph, frame.layers, gbuffer);
    execute(graph);
    if (!dataApart) readLayers(graph, frame.layers, gbuffer, tile, texels);
    return;
  }
  TextureLease sum(nullptr, ReturnToPool{});
  if (!frame.processorShades) sum = pool.lease("sum", {gl::TextureFormat::rgba32f, tile.width, tile.height});
  const bool whole = part.width == frame.view.size.width && part.height == frame.view.size.height;
  for (int i = 0; i < samples; ++i) {
    setShadow(i);
    FrameGraph graph(pool);
    buildFrame(graph, frame, tile, sampleOffset(i, samples),
               {.name = "sum",
                .texture = sum.get(),
                .clear = i == 0 ? Clear::zero : Clear::none,
                .memory = {.sum = &lightSum, .sample = i}});
    execute(graph);
    progress((i + 1.0) / samples);
    if (i + 1 < samples && whole && !frame.layers.data() && preview.wanted && preview.wanted())
      showPreview(frame, sum.get(), picture, i + 1);
  }
  resolve(frame, samples, sum.get(), picture);
}

void Renderer::Impl::resolve(const Frame& frame, int samples, const gl::Texture* sum,
                             const PictureTarget& picture) {
  FrameGraph graph(pool);
  const glm::vec4 behind = backdrop(frame.shade.background);
  TextureRef target;
  if (frame.processorShades) {
    graph.leaveOut("program of resolve", effects.reason);
    target = graph.createInMemory("rows");
    graph.addPass("resolve", {}, {{target, FrameGraph::kInMemory}}, [&](const PassContext&) {
      effects::writePicture(lightSum, samples, behind, picture.rows);
    });
  } else {
    target = graph.import("picture", *picture.texture, Clear::none);
    addResolve(graph, {samples, behind, frame.shade.encodeSrgb}, shaders,
               graph.import("sum", *sum, Clear::none), target);
  }
  graph.want(target);
  execute(graph);
}

// Of the whole picture, which has no margin, because nothing lies beyond it.
void Renderer::Impl::showPreview(const Frame& frame, const gl::Texture* sum, const PictureTarget& picture,
                                 int samples) {
  const auto width = static_cast<std::size_t>(frame.view.size.width),
             height = static_cast<std::size_t>(frame.view.size.height);
  PictureTarget shown = picture;
  shown.rows.rowBytes = width * bytesPerPixel(picture.rows.format);
  std::vector<std::byte> rows(shown.rows.rowBytes * height);
  shown.rows.first = rows.data();
  resolve(frame, samples, sum, shown);
  if (shown.texture != nullptr)
    shown.texture->read(frame.view.size.width, frame.view.size.height, frame.view.size.width, rows.data());
  const std::size_t rowBytes = shown.rows.rowBytes;
  for (std::size_t low = 0, high = rows.size() - rowBytes; low < high; low += rowBytes, high -= rowBytes)
    std::swap_ranges(rows.begin() + static_cast<std::ptrdiff_t>(low),
                     rows.begin() + static_cast<std::ptrdiff_t>(low + rowBytes),
                     rows.begin() + static_cast<std::ptrdiff_t>(high));
  preview.show(samples, rows);
}

void Renderer::renderPicture(const View& view, const Lighting& lighting, const Background& background,
                             const RenderSettings& settings, const PixelLayout& layout, RowSink& sink,
                             const std::function<void(double)>& progress) {
  MENISCUS_CHECK(view.size.width > 0 && view.size.height > 0);
  MENISCUS_CHECK(settings.samples >= 1 && settings.samples <= kMaxSamples);
  MENISCUS_CHECK(!layout.layers.data() || layout.format == PixelFormat::rgbaFloat);
  Impl& r = *impl_;
  // Data are of the quadrics themselves.
  r.prepare(view, settings.quadrics, settings.levelOfDetail && !layout.layers.data(), settings.surface);
  Frame frame{view,
              settings,
              {lighting, background, settings.occlusion, settings.fog, settings.depthUnsharp, settings.lines,
               settings.surface.opacity, settings.trace.light() && !r.primitives->empty(),
               settings.samples == 1, layout.format != PixelFormat::rgbaFloat},
              layout.layers,
              {}};
  const bool color = layout.layers.color;
  frame.translucent = settings.surface.translucent() && !r.primitives->surfaces.empty();
  frame.processorShades = color && r.effects.processor && !frame.translucent;
  const bool anyOpaque = !r.primitives->empty() && !(frame.translucent && r.primitives->onlySurfaces());
  if (color) r.setEffects(frame);
  r.shadeUniforms.set(frame.shade);
  const TraceSettings& trace = settings.trace;
  frame.traced = color && trace.any() && !r.primitives->empty();
  if (frame.traced) {
    MENISCUS_CHECK(!frame.translucent);
    r.tracedLight.setPrimitives(r.apart());
    r.tracedLight.set({trace, settings.shadows, settings.occlusion, lighting, background});
  }
  if (color && trace.shadows == 0 && settings.shadows.mode != ShadowMode::off && anyOpaque) {
    Stopwatch watch(r.stats.drawMs);
    r.drawShadowMap(frame);
  } else {
    r.keptShadowMap = {};
  }
  if (color && trace.occlusion == 0 && settings.occlusion.on && anyOpaque) {
    Stopwatch watch(r.stats.drawMs);
    r.drawOcclusion(frame, progress);
  }

  const std::size_t pixelBytes = bytesPerPixel(layout);
  const std::size_t rowBytes = pixelBytes * static_cast<std::size_t>(view.size.width);
  const TileSize tileSize =
      chooseTileSize(view.size, static_cast<int>(pixelBytes), r.options.maxTileSize, frame.margin);
  std::vector<std::byte>& band = r.band;
  std::vector<std::byte> colors;
  LayerTexels texels;
  const double pixels = static_cast<double>(view.size.width) * view.size.height;
  double drawn = 0, told = 0;  // shares of the picture
  const auto tell = [&](double share) {
    told = share;
    if (progress) progress(share);
  };
  frame.watch = [&] { tell(told); };
  for (int top = view.size.height; top > 0; top -= tileSize.height) {
    const int height = std::min(tileSize.height, top);
    band.resize(rowBytes * static_cast<std::size_t>(height));
    for (int x = 0; x < view.size.width; x += tileSize.width) {
      const Tile tile{x, top - height, std::min(tileSize.width, view.size.width - x), height};
      const Tile drawnTile = withMargin(tile, frame.margin, view.size);
      const int cropX = tile.x - drawnTile.x, cropY = tile.y - drawnTile.y;
      TextureLease texture(nullptr, ReturnToPool{});
      if (color && !frame.processorShades)
        texture = r.pool.lease("picture", {textureFormat(layout.format), drawnTile.width, drawnTile.height});
      // Of data, the pixels are assembled afterwards.
      std::byte* const here = band.data() + pixelBytes * static_cast<std::size_t>(x);
      const auto width = static_cast<std::size_t>(tile.width);
      if (layout.layers.data())
        colors.resize(color ? bytesPerPixel(layout.format) * width * static_cast<std::size_t>(height) : 0);
      const PictureTarget picture{
          texture.get(),
          {cropX, cropY, tile.width, tile.height, layout.format, layout.layers.data() ? colors.data() : here,
           layout.layers.data() ? bytesPerPixel(layout.format) * width : rowBytes}};
      {
        Stopwatch watch(r.stats.drawMs);
        const double share = static_cast<double>(tile.width) * tile.height / pixels;
        const auto drawnOfTile = [&](double done) { tell(drawn + share * done); };
        if (color) {
          r.drawTile(frame, tile, picture, texels, drawnOfTile);
        } else {
          r.drawData(frame, tile, texels);
        }
        glFinish();
        drawn += share;
      }
      Stopwatch watch(r.stats.readbackMs);
      if (texture != nullptr)
        texture->read(tile.width, tile.height,
                      static_cast<int>(picture.rows.rowBytes / bytesPerPixel(layout.format)),
                      picture.rows.first, cropX, cropY);
      requireContextAlive();
      if (layout.layers.data()) storeLayers(layout, view, tile, texels, colors, band.data());
      ++r.stats.tiles;
    }
    for (int y = height; y-- > 0;) {
      sink.writeRows(std::span(band).subspan(rowBytes * static_cast<std::size_t>(y), rowBytes));
    }
    tell(drawn);
  }
}

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

void Renderer::forgetStats() {
  impl_->stats = {};
  impl_->forgottenCompileMs = impl_->shaders.compileMs();
  std::vector<SurfaceStats> forgotten;
  impl_->surfaces.takeStats(forgotten);
  impl_->tracedLight.takeStats(forgotten);
}

RenderStats Renderer::stats() const {
  impl_->surfaces.takeStats(impl_->stats.surfaces);
  impl_->tracedLight.takeStats(impl_->stats.surfaces);
  RenderStats stats = impl_->stats;
  stats.programs = impl_->shaders.compiled();
  stats.compileMs = impl_->shaders.compileMs() - impl_->forgottenCompileMs;
  stats.buffers = impl_->splatQuadrics.buffers();
  for (ResourceStats& buffer : impl_->glslTileQuadrics.buffers()) stats.buffers.push_back(std::move(buffer));
  for (ResourceStats& buffer : impl_->triangles.buffers()) stats.buffers.push_back(std::move(buffer));
  for (ResourceStats& buffer : impl_->surfaces.buffers()) stats.buffers.push_back(std::move(buffer));
  const gl::Buffer& groups = impl_->silhouetteUniforms.groups();
  if (groups.object) stats.buffers.push_back({"groups", groups.bytes});
  if (impl_->occlusionBuffers.bytes() > 0)
    stats.buffers.push_back({"occlusion maps", impl_->occlusionBuffers.bytes()});
  stats.textures = impl_->pool.textures();
  return stats;
}

}  // namespace meniscus

#include "render/renderer.h"

#include <glad/gl.h>

#include <algorithm>
#include <glm/vec4.hpp>
#include <utility>

#include "core/error.h"
#include "core/sampling.h"
#include "core/valid_primitives.h"
#include "render/gl/context.h"
#include "render/picture_parts.h"
#include "render/post/resolve.h"
#include "render/renderer_impl.h"

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

}  // namespace

Renderer::Impl::Impl(const RendererOptions& o)
    : options(o), shaders(o.shaderDir), effects(chooseEffects(o.effectsOnProcessor)) {
  takePrimitives();
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glDisable(GL_DITHER);
  glDisable(GL_MULTISAMPLE);
}

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

void Renderer::setCopyGuard(CopyGuard guard) {
  impl_->copyGuard = std::move(guard);
}

void Renderer::setLabels(std::vector<LabelSprite> labels, const LabelColors& colors) {
  impl_->labels = std::move(labels);
  impl_->labelColors = colors;
}

void Renderer::setPreview(PicturePreview preview) {
  impl_->preview = std::move(preview);
}

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

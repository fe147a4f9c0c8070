#pragma once
// What the sources of Renderer share: a picture that is being drawn, and what is kept from one to the next.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/effects/shading.h"
#include "render/frame_graph.h"
#include "render/gbuffer.h"
#include "render/layers.h"
#include "render/post/depth_unsharp.h"
#include "render/post/labels.h"
#include "render/post/occlusion.h"
#include "render/post/shade.h"
#include "render/post/shadow.h"
#include "render/post/silhouette.h"
#include "render/post/surface_reader.h"
#include "render/post/traced_light.h"
#include "render/renderer.h"
#include "render/shader_library.h"
#include "render/splat_quadrics.h"
#include "render/surface_passes.h"
#include "render/tile_quadrics.h"
#include "render/tile_quadrics_glsl.h"
#include "render/triangles.h"
#include "render/view_block.h"

namespace meniscus {

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
  CopyGuard copyGuard;
  RenderStats stats;
  double forgottenCompileMs = 0;

  explicit Impl(const RendererOptions& o);

  // renderer_frame.cpp

  // To the ways to draw quadrics.
  void takePrimitives();
  void prepare(const View& view, QuadricMethod method, bool levelOfDetail, const SurfaceSettings& surface);
  Primitives eachCopyOf(const Primitives& some) const;
  // For what draws no copies: all that is not cast from tiles.
  const std::shared_ptr<const Primitives>& apart();
  f32::ViewBlock setView(const View& view, const Tile& tile, glm::vec2 sampleShift);
  tiles::TileTarget targetOf(const View& view, const Tile& tile, glm::vec2 sampleShift) const;
  // All that is to be seen, or all but the surfaces, into the channels of a G-buffer. setView() must have
  // been called alike.
  void addScene(FrameGraph& graph, const View& view, const Tile& tile, glm::vec2 sampleShift,
                const GBufferRefs& gbuffer, Surfaces drawn, const std::string& prefix = {});
  void leaveOutOtherQuadrics(FrameGraph& graph, const std::string& prefix);
  // Whether the processor draws whatever there is.
  bool castsAll(const SurfaceSettings& surface) const;
  // Textures are left to those that draw from them.
  void keepInMemory(FrameGraph& graph, const Frame& frame, GBufferRefs& gbuffer);
  // One sample of one tile: every pass of the program is named here.
  GBufferRefs buildFrame(FrameGraph& graph, const Frame& frame, const Tile& tile, glm::vec2 sampleShift,
                         const LightTarget& target);
  // What is opaque, and the layers of translucent surfaces over it.
  void addShadeUnderLayers(FrameGraph& graph, const Frame& frame, const Tile& tile, glm::vec2 sampleShift,
                           const GBufferRefs& gbuffer, const LightRefs& light, TextureRef over,
                           TextureRef target);
  // The same primitives as seen from the key light, with only their depth wanted.
  void drawShadowMap(Frame& frame);
  // Counted as a pass, though the processor draws them.
  void drawOcclusion(Frame& frame, const std::function<void(double)>& progress);
  // What the effects of a whole picture share.
  void setEffects(Frame& frame);

  // renderer.cpp

  // A texture gets the margin of `part`, too. Data comes with the colour where both need the same rays.
  void drawTile(const Frame& frame, const Tile& part, const PictureTarget& picture, LayerTexels& texels,
                const std::function<void(double)>& progress);
  // What the rays through the pixels' centres meet, without colour.
  void drawData(const Frame& frame, const Tile& tile, LayerTexels& texels);
  void resolve(const Frame& frame, int samples, const gl::Texture* sum, const PictureTarget& picture);
  // Of the whole picture, which has no margin, because nothing lies beyond it.
  void showPreview(const Frame& frame, const gl::Texture* sum, const PictureTarget& picture, int samples);
  void execute(FrameGraph& graph) { graph.execute(stats, options.timePasses); }
};

}  // namespace meniscus

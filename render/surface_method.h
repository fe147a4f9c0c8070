#pragma once
// The one interface of all ways to draw a metaball surface, and the list of those there are.

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/metaball_field.h"
#include "core/render_settings.h"
#include "core/view.h"
#include "render/frame_graph.h"
#include "render/gbuffer.h"
#include "render/shader_library.h"
#include "render/view_block.h"

namespace meniscus {

/// Layers of translucent surfaces, RGBA32UI each, as shaders/include/lists_layers.glsl writes them: the first
/// four crossings of the ray in front of what is opaque, in order, and the rest merged.
struct SurfaceLayerRefs {
  std::array<TextureRef, 5> of;
  bool valid() const { return of[0].valid(); }
};

/// What one sample of one tile is drawn with. The view's uniform block is bound (render/renderer_frame.cpp).
struct SurfaceTarget {
  const View& view;
  glm::dvec3 origin;      ///< Primitives::origin: what the balls' centres are relative to
  Tile tile;              ///< of the picture
  glm::vec2 sampleShift;  ///< of the rays within their pixels
  GBufferRefs gbuffer;    ///< channels that are not valid are not written; what is in it hides and is hidden
  std::string prefix;     ///< before the passes' names
  /// If valid, this is written instead of the G-buffer, whose depth still hides: all of its pixels, even
  /// where there is no surface, since nobody clears them. Only methods that are
  /// SurfaceMethodInfo::translucent are asked for it.
  SurfaceLayerRefs layers = {};
  SurfaceLayerRefs layersBefore = {};  ///< of other surfaces, to be joined, if valid
  bool first = false;                  ///< nothing is drawn into the G-buffer before
};

/// Draws one field. What a method draws: the first point on the ray at or behind the near plane at which the
/// field changes its sign. If the ray starts inside, that is its inner wall, with the normal towards the
/// viewer. A tangent ray that does not enter is a miss. The id is that of the ball with the largest share of
/// the field; colours are blended by the positive shares.
class SurfaceMethod {
 public:
  virtual ~SurfaceMethod() = default;
  /// Takes a field, which must outlive the method. Called once, with the context current.
  virtual void prepare(const MetaballField& field) = 0;
  virtual void addPasses(FrameGraph& graph, ShaderLibrary& shaders, const SurfaceTarget& target) = 0;
  /// Of all that was drawn since the last call.
  virtual SurfaceStats takeStats() = 0;
  /// On the GPU, alive.
  virtual std::vector<ResourceStats> buffers() const = 0;
  /// Of what the balls take or are made into (hulls, trees, triangles), on the GPU or, if the processor casts
  /// the rays, in main memory; not of what pixels take.
  virtual std::uint64_t bytesOfBalls() const = 0;
};

/// What a method can be told, by name (--surface-option NAME=VALUE, and sweeps).
struct SurfaceParameter {
  std::string_view name, help;
  double value;        ///< default
  double least, most;  ///< allowed
  bool whole;          ///< a whole number; a switch is one of 0 and 1
};

/// All parameters of a method by name.
using SurfaceParameters = std::map<std::string, double, std::less<>>;

struct SurfaceMethodInfo {
  std::string_view name, summary;
  std::span<const SurfaceParameter> parameters;
  std::unique_ptr<SurfaceMethod> (*make)(const SurfaceParameters& values);
  bool translucent = false;  ///< can draw SurfaceTarget::layers
  bool planes = false;       ///< the processor casts it: can leave GBufferRefs::planes
};

/// All methods, in the order of the documentation; a new one adds its line to render/surface_methods.cpp.
std::span<const SurfaceMethodInfo> surfaceMethods();

/// The method that `settings` names, or the one that suits the scene and the device ("auto"). Throws
/// UsageError, naming what there is, on an unknown method, parameter or value.
const SurfaceMethodInfo& surfaceMethodFor(const SurfaceSettings& settings);

/// Why the method that surfaceMethodFor() gives is taken, for --explain. A context must be current.
std::string surfaceReason(const SurfaceSettings& settings);

/// The method's parameters, those given in `settings` over the defaults. Throws UsageError as above.
SurfaceParameters surfaceParametersFor(const SurfaceMethodInfo& method, const SurfaceSettings& settings);

}  // namespace meniscus

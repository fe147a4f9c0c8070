#pragma once
// Silhouettes, creases and lines between groups of atoms, from depth, normals and ids. Sigg et al. 2006, §4;
// how steps are told from slopes: shaders/include/outline.glsl. A line lies on the surface in front, so that
// it neither widens an object nor changes its alpha; where surfaces meet without a step, half on each.

#include <cstdint>
#include <vector>

#include "core/effects/outlines.h"
#include "core/render_settings.h"
#include "core/view.h"
#include "render/frame_graph.h"
#include "render/gbuffer.h"
#include "render/post/surface_reader.h"
#include "render/shader_library.h"

namespace meniscus {

/// Buffers for the passes' uniforms and for the group of each id, which outlive the frames.
class SilhouetteUniforms {
 public:
  /// Makes the block current for the next frames.
  void set(const SilhouetteSettings& settings, const View& view);
  /// groups[id]: ids of equal value have no line between them; empty = every id for itself. Uploaded once,
  /// and to be kept by the caller, until clearGroups().
  void setGroups(const std::vector<std::uint32_t>& groups);
  void clearGroups() {
    groups_ = gl::Buffer{};
    byId_ = {};
  }
  unsigned name() const { return buffer_.object.name(); }
  const gl::Buffer& groups() const { return groups_; }
  const effects::OutlineBlock& block() const { return block_; }
  std::span<const std::uint32_t> groupsById() const { return byId_; }

 private:
  gl::Buffer buffer_, groups_;
  effects::OutlineBlock block_{};
  std::span<const std::uint32_t> byId_;
};

/// How far from a pixel lies what decides about it [pixels].
int reachOf(const SilhouetteSettings& settings);

/// Adds two passes. Returns the share of each pixel that is line (0 on the background). reader: if the
/// processor draws lines, in one pass. Must outlive the graph.
TextureRef addSilhouette(FrameGraph& graph, const SilhouetteSettings& settings,
                         const SilhouetteUniforms& uniforms, ShaderLibrary& shaders,
                         const GBufferRefs& gbuffer, int width, int height, SurfaceReader* reader = nullptr);

}  // namespace meniscus

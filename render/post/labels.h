#pragma once
// Labels over the picture: text in the picture's own pixels, however many rays each has; every ray tests
// whether the scene lies before the label.

#include <vector>

#include "core/label_sprite.h"
#include "core/view.h"
#include "render/frame_graph.h"
#include "render/gbuffer.h"
#include "render/shader_library.h"
#include "render/view_block.h"

namespace meniscus {

/// The labels of a picture on the GPU; outlives the frames.
class LabelBuffers {
 public:
  /// Makes the labels current for the next frames, as `view` sees them. Labels behind the eye or outside of
  /// the picture are left out; one that sticks out of it is moved in. Throws InputError if they do not fit
  /// into one texture.
  void set(const std::vector<LabelSprite>& sprites, const LabelColors& colors, const View& view);
  bool empty() const { return count_ == 0; }

 private:
  friend TextureRef addLabels(FrameGraph&, LabelBuffers&, ShaderLibrary&, const GBufferRefs&, const Tile&);
  gl::Buffer places_, uniforms_;
  gl::Texture atlas_;
  LabelColors colors_;
  int count_ = 0;
};

/// Adds the pass. Returns the labels' light, premultiplied, and how much they cover.
TextureRef addLabels(FrameGraph& graph, LabelBuffers& labels, ShaderLibrary& shaders,
                     const GBufferRefs& gbuffer, const Tile& tile);

}  // namespace meniscus

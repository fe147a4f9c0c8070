#pragma once
// A frame's G-buffer read back for the effects that the processor computes (core/effects/).

#include <optional>
#include <string>

#include "core/effects/surface_planes.h"
#include "render/frame_graph.h"
#include "render/gbuffer.h"

namespace meniscus {

class SurfaceReader {
 public:
  /// What is read from now on is another frame's.
  void begin(const f32::ViewBlock& view, int width, int height);
  /// Reads what has not been read of this frame.
  const effects::SurfacePlanes& read(const PassContext& context, const GBufferRefs& gbuffer,
                                     bool ids = false);
  /// Writes an effect's result into a texture of the frame's size and format R16.
  void write(const PassContext& context, TextureRef target, const effects::Shares& shares) const;

  // Room for what an effect computes before it is written: fresh memory for every frame would cost as much as
  // the effect.
  effects::Shares& shares() { return shares_; }
  std::vector<float>& numbers() { return numbers_; }

 private:
  effects::SurfacePlanes planes_;
  effects::Shares shares_;
  std::vector<float> numbers_;
  bool surface_ = false, ids_ = false;
};

/// Whether the processor computes effects, and why, for --explain.
struct EffectsChoice {
  bool processor = false;
  std::string reason;
};
/// wanted: nothing = where OpenGL runs on the processor. A context must be current.
EffectsChoice chooseEffects(std::optional<bool> wanted);

}  // namespace meniscus

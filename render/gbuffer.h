#pragma once
// The channels of the G-buffer. Formats are fixed here; nothing is allocated before a pass writes it.

#include <vector>

#include "render/frame_graph.h"
#include "render/shader_library.h"

namespace meniscus {

class SurfaceReader;

struct GBufferRefs {
  TextureRef depth;     ///< reversed z, 32-bit float; 0 = background
  TextureRef albedo;    ///< RGBA8, sRGB-encoded; alpha 1 where there is a surface
  TextureRef normal;    ///< RG16, octahedral (shaders/shared/octahedral.glsl), view space
  TextureRef id;        ///< R32UI; 0 = background
  TextureRef distance;  ///< R32F, along the unit ray [Å]; +infinity = background
  /// The same in main memory, if valid: everything is cast by the processor, which keeps it in `memory`. The
  /// textures then are for those that draw from them.
  TextureRef planes;
  SurfaceReader* memory = nullptr;
};

/// Declares the channels in a graph.
GBufferRefs createGBuffer(FrameGraph& graph, int width, int height);

/// What a pass of the processor reads of a surface: the planes, or the textures.
std::vector<TextureRef> surfaceOf(const GBufferRefs& gbuffer);

/// What a pass writes that draws into the G-buffer: the depth, and the channels that are valid where
/// shaders/include/gbuffer.glsl has them.
std::vector<FrameGraph::Attachment> attachmentsOf(const GBufferRefs& gbuffer);

/// Flags of shaders/include/gbuffer.glsl: the channels that somebody reads.
ShaderFlags channelFlags(const PassContext& context, const GBufferRefs& gbuffer);

}  // namespace meniscus

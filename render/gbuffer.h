#pragma once
// The channels of the G-buffer. Formats are fixed here; nothing is allocated before a pass writes it.

#include "render/frame_graph.h"

namespace meniscus {

struct GBufferRefs {
  TextureRef depth;     ///< reversed z, 32-bit float; 0 = background
  TextureRef albedo;    ///< RGBA8, sRGB-encoded; alpha 1 where there is a surface
  TextureRef normal;    ///< RG16, octahedral (shaders/shared/octahedral.glsl), view space
  TextureRef id;        ///< R32UI; 0 = background
  TextureRef distance;  ///< R32F, along the unit ray [Å]; +infinity = background
};

/// Declares the channels in a graph.
GBufferRefs createGBuffer(FrameGraph& graph, int width, int height);

}  // namespace meniscus

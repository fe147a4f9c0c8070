#pragma once
// From what the processor cast (core/tiles/) to the G-buffer, whose formats it already has.

#include "core/tiles/tile_target.h"
#include "render/frame_graph.h"
#include "render/gbuffer.h"

namespace meniscus {

/// The channels that somebody reads.
tiles::PlaneChannels wantedPlanes(const PassContext& context, const GBufferRefs& gbuffer);

/// Replaces the planes' part of the channels. area: of the target.
void writePlanes(const PassContext& context, const GBufferRefs& gbuffer, const tiles::Planes& planes,
                 const tiles::PixelArea& area);

}  // namespace meniscus

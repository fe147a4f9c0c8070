#pragma once
// From what the processor cast (core/tiles/) to the G-buffer, whose formats it already has.

#include "core/tiles/tile_target.h"
#include "render/frame_graph.h"
#include "render/gbuffer.h"

namespace meniscus {

/// The channels that somebody reads.
tiles::PlaneChannels wantedPlanes(const PassContext& context, const GBufferRefs& gbuffer);
/// The part of the target that is to be cast.
tiles::Extent wantedExtent(const GBufferRefs& gbuffer);

/// Replaces the planes' part of the channels; planes that are kept in main memory join what is kept there,
/// and are exchanged for others. area: of the target.
void writePlanes(const PassContext& context, const GBufferRefs& gbuffer, tiles::Planes& planes,
                 const tiles::PixelArea& area);

}  // namespace meniscus

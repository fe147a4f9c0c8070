#pragma once
// The data layers of a picture (core/image.h): channels of the G-buffer on their way to the rows of a file.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/image.h"
#include "core/view.h"
#include "render/frame_graph.h"
#include "render/gbuffer.h"
#include "render/view_block.h"

namespace meniscus {

/// What was read of a tile, rows from the bottom; layers nobody asked for are empty.
struct LayerTexels {
  std::vector<std::uint8_t> albedo;   ///< 4 per pixel, sRGB
  std::vector<std::uint16_t> normal;  ///< 2 per pixel, octahedral
  std::vector<float> distance;
  std::vector<std::uint32_t> id;
};

/// Asks a graph for the channels that `layers` are made of.
void wantLayers(FrameGraph& graph, const Layers& layers, const GBufferRefs& gbuffer);

/// Reads them after the graph was executed. The G-buffer must have been drawn through the pixels' centres.
void readLayers(const FrameGraph& graph, const Layers& layers, const GBufferRefs& gbuffer, const Tile& tile,
                LayerTexels& out);

/// Puts a tile's pixels into `band`, rows of view.size.width pixels of `layout` from the bottom, of which the
/// lowest is the tile's; `color` is the tile's picture, tightly packed, if the layout has one.
void storeLayers(const PixelLayout& layout, const View& view, const Tile& tile, const LayerTexels& texels,
                 const std::vector<std::byte>& color, std::byte* band);

}  // namespace meniscus

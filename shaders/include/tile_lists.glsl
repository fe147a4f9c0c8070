// The lists of screen tiles, as the processor makes them (render/tile_list_buffers.h).

const int kTileSize = 8;  // core/tiles/tile_target.h

layout(std430, binding = 1) readonly restrict buffer Entries {
  uint uEntries[];  // of what a tile's rays can meet, in order, tile after tile
};
layout(std430, binding = 7) readonly restrict buffer Lists {
  uvec2 uListOfTile[];  // first entry; how many
};

// grid: x, y: from a pixel of the target to one of the grid; z: tiles in a row.
uvec2 listOfTile(ivec4 grid, ivec2 targetTexel) {
  ivec2 tile = (targetTexel + grid.xy) / kTileSize;
  return uListOfTile[tile.y * grid.z + tile.x];
}

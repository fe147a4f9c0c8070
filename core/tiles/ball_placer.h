#pragma once
// Where the balls of a cluster can be seen: what TileProjection::placeSphere() says of each, but a vector of
// them at a time and in float32, which is exact enough relative to the cluster's own middle.

#include <span>

#include "core/tiles/clusters.h"
#include "core/tiles/placement.h"

namespace meniscus::tiles {

/// A cluster's middle as a view sees it. Tiles are counted from the first of the grid.
struct ClusterView {
  float rotation[9];          ///< rows: view axes from the axes of the cluster's set
  float center[3];            ///< in the coordinates of the set [Å]
  float z;                    ///< view space
  float depth;                ///< in front of the eye plane; 1 for orthographic views
  float slopeX, slopeY;       ///< view.xy / depth; 0 for orthographic views
  float tileX, tileY;         ///< of the projected middle
  float tilesPerUnit;         ///< at unit depth (perspective), per Å (orthographic)
  float padding;              ///< around every ball [tiles]
  int columns = 0, rows = 0;  ///< of the grid
  float nearZ, farZ;
  bool perspective;
};

/// Bounds contain those of placeSphere() and exceed them by some 1e-5 of the cluster's size. Perspective:
/// every ball must lie at least half as far from the eye plane as the middle. out: as many as balls.
void placeBalls(const ClusterView& view, std::span<const Clusters::Ball> balls, Placement* out);

}  // namespace meniscus::tiles

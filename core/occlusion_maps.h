#pragma once
// Height maps of a scene from many directions, for ambient occlusion: what lies above a point along each of
// them. Drawn by the processor, since they are coarse and many: without a GPU each costs a fortieth of
// drawing the scene as shaded quadrics at 1024x768 (docs/methods.md).

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/primitives.h"
#include "core/render_settings.h"
#include "core/view.h"

namespace meniscus {

/// Heights above the far plane of `view`, as it sees the scene from its direction. A scene is cut into slabs
/// across that direction; a texel holds the highest point, of that texel's centre, of the primitives whose
/// own centre lies in the slab, whether or not something in a slab above hides it.
struct OcclusionMap {
  View view;                ///< orthographic; its z axis points from the scene to the sky
  int slabs = 1;            ///< from the far plane up
  std::uint32_t first = 0;  ///< index of its first texel: by pairs of slabs, row by row from the bottom
};

/// The heights in a pair of slabs and in the next two: what counts for a point that lies in the first pair,
/// or up to a slab below its middle, is in one texel. Lower 16 bits: the height in units of
/// OcclusionMaps::step, 0 = nothing there; upper 16 bits: that of the texel to the right.
constexpr int kSlabsPerTexel = 4;
using OcclusionTexel = std::array<std::uint32_t, kSlabsPerTexel>;

struct OcclusionMaps {
  std::vector<OcclusionMap> maps;
  std::vector<OcclusionTexel> texels;
  double texelSize = 0;   ///< [Å]
  double slabHeight = 0;  ///< [Å]
  double step = 0;        ///< of a height [Å]
  double reach = 0;       ///< the highest that any primitive's point lies above its centre [Å]
  double radius = 0;      ///< [Å] within which occluders count; 0 = all
};

/// Directions, evenly spread over the sphere, of which any aligned block of a power of two is, too: the first
/// two dimensions of Sobol's sequence (1967, doi 10.1016/0041-5553(67)90144-9), by equal areas.
std::vector<glm::dvec3> occlusionDirections(int count);

/// Maps from settings.directions directions of everything that can lie above what `camera` sees. Texels are
/// as large as the settings say, or as a pixel of the picture, or as memory demands, whichever is most; the
/// radius is at least that of four texels and of a slab.
OcclusionMaps drawOcclusionMaps(const Primitives& primitives, const View& camera,
                                const OcclusionSettings& settings, const std::function<void()>& watch = {});

}  // namespace meniscus

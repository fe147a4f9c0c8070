#pragma once
// Finds where rays meet a surface, from a list of balls for each pixel or tile, whoever made it: the stages
// of shaders/surface/lists_cast.frag, lists_walk.frag and lists_surface.frag.

#include <string>

#include "render/gl/storage.h"
#include "render/surface/list_balls.h"
#include "render/surface/lists_statistics.h"
#include "render/surface/peel_regions.h"
#include "render/surface_method.h"

namespace meniscus {

inline constexpr int kListArray = 64;  ///< kRing of shaders/surface/lists_cast.frag
/// Pixels that are drawn at once: textures and heads take kListBytesPerPixel of each.
inline constexpr std::int64_t kListRegionPixels = std::int64_t{1} << 22;
inline constexpr std::int64_t kListBytesPerPixel = 20;

/// What is the same for all regions of a target.
struct ListTarget {
  const PassContext& context;
  ShaderLibrary& shaders;
  GBufferRefs gbuffer;
  SurfaceLayerRefs layers, layersBefore;
  ShaderFlags flags;
  float placeScale;  ///< of ListBalls
  bool translucent() const { return layers.valid(); }
};

struct ListRegion {
  ScreenRect rect;  ///< of the target
  TextureLease cores, places;
};

class ListCaster {
 public:
  /// tolerance: width to which a root is narrowed down, as a share of the smallest support around it; array:
  /// separators that a pixel's array holds, at most kListArray; exact: not the paper's cubics.
  ListCaster(std::string method, double tolerance, int array, bool exact);

  /// With the context current.
  void prepare(const MetaballField& field);
  /// Flags of the shaders for the field; translucent: draws layers.
  ShaderFlags flags(bool translucent) const;

  /// Clears the heads of a region's lists (storage 2) and binds what the stages share.
  ListRegion begin(const ListTarget& target, const ScreenRect& rect);
  /// ListsUniforms; nodes: there is room for so many; goOn: layers that were drawn are added to.
  void setUniforms(const ListTarget& target, const ScreenRect& region, std::int64_t nodes, bool goOn = false);
  /// For lists of tiles: TileListBuffers::grid().
  void setGrid(const glm::ivec4& grid) { grid_ = grid; }
  /// Binds the region's cores to be drawn into, and clears them: they hide nothing.
  void clearCores(const ListTarget& target, const ListRegion& region) const;
  /// Lays what is drawn already into the cores that are bound, over what is in them.
  void layHidden(const ListTarget& target) const;
  /// Draws a part of the region; the lists are bound.
  void draw(const ListTarget& target, const ListRegion& region, const ScreenRect& part, std::int64_t nodes);

  ListsStatistics& statistics() { return statistics_; }
  /// Of heads, states and counts.
  std::uint64_t bytesOfHeads() const { return heads_.bytes(); }
  std::uint64_t bytesOfControl() const {
    return control_.bytes() + states_.bytes() + statistics_.counts.bytes();
  }

 private:
  void cast(const ListTarget& target, const ListRegion& region, const ScreenRect& part, std::int64_t nodes);
  void walk(const ListTarget& target, const ListRegion& region);
  void shade(const ListTarget& target, const ListRegion& region, const ScreenRect& part);

  std::string method_;
  float tolerance_;
  int array_;
  bool exact_, walkAll_ = false;
  ShaderFlags kernelFlags_;
  glm::ivec4 grid_{0};
  gl::Storage heads_, control_, states_;
  gl::Buffer uniforms_;
  ListsStatistics statistics_;
};

}  // namespace meniscus

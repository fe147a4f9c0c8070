#pragma once
// Parts of the screen for depth peeling: regions that are drawn one after the other, since their lists must
// fit into memory, and in them cells, each of which is peeled until it is finished.

#include <cstdint>
#include <glm/vec4.hpp>
#include <vector>

#include "render/surface/projected_field.h"

namespace meniscus {

struct ScreenRect {
  int x = 0, y = 0, width = 0, height = 0;
  std::int64_t pixels() const { return std::int64_t{width} * height; }
};

/// The rectangle in parts of at most so many pixels, from its corner on.
std::vector<ScreenRect> splitRect(const ScreenRect& rect, std::int64_t mostPixels);

/// Instance of shaders/surface/bezier_peel.vert.
struct PeelInstance {
  glm::vec4 box;  ///< pixels of the region
  glm::vec4 pixel, place, eye;
  std::uint32_t ball, instance;
};

struct PeelCell {
  ScreenRect rect;  ///< in the region
  int first = 0, count = 0;
  bool crossesNear = false;  ///< whether a ray may begin inside a ball
};

/// A region's cells that any ball reaches: of a grid of `side` x `side` over the target (0: the region is one
/// cell); each with its balls in the field's order.
std::vector<PeelCell> makeCells(const ProjectedField& field, const ScreenRect& target,
                                const ScreenRect& region, int side, std::vector<PeelInstance>& instances);

/// Keeps the instances that were seen, and the cells that have any.
void keepSeen(std::vector<PeelCell>& cells, std::vector<PeelInstance>& instances,
              const std::vector<std::uint32_t>& seen);

}  // namespace meniscus

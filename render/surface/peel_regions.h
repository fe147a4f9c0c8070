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

/// Of the balls of a cell, by their nearest point, those that are drawn: all before `from` lie before the
/// last event of every pixel, and a pixel whose next event is not before `to`'s nearest point waits.
struct PeelWindow {
  int from = 0, to = 0;
  ScreenRect reach;  ///< the part of the cell that has pixels which are not finished
};

/// A region's cells that any ball reaches: of a grid of `side` x `side` over the target (0: the region is one
/// cell); each with its balls in the field's order.
std::vector<PeelCell> makeCells(const ProjectedField& field, const ScreenRect& target,
                                const ScreenRect& region, int side, std::vector<PeelInstance>& instances);

/// Least and largest length of a ray per height, over a cell's pixels.
struct StretchRange {
  double least = 1, largest = 1;
};
StretchRange stretchRange(const View& view, const Tile& tile, const ScreenRect& region,
                          const ScreenRect& cell);

// Places on rays are whole numbers of steps (shaders/include/bezier.glsl).
inline constexpr double kMiddleStep = 0x20000000, kFirstStep = 0x00800000, kMostStep = 0x7FFFFFFF;

/// No ray of a cell is before this step at so many Å below the plane; none is after it.
double stepAtLeast(double depth, const StretchRange& stretch, double step);
double stepAtMost(double depth, const StretchRange& stretch, double step);

/// Side of a block of pixels for which it is known whether all of them are finished (bezier_step.frag).
inline constexpr int kBlockSide = 8;
inline int blocksAlong(int pixels) {
  return (pixels + kBlockSide - 1) / kBlockSide;
}

/// Instance of shaders/surface/bezier_step.vert.
struct StepInstance {
  glm::vec4 box;
  std::int32_t cell, bound;
};

/// Adds the parts of a cell in blocks that are marked with `layer`; `reach` becomes the box around them.
void addUnfinished(const PeelCell& cell, const ScreenRect& region, const std::vector<std::uint32_t>& blocks,
                   std::uint32_t layer, const StepInstance& model, std::vector<StepInstance>& out,
                   ScreenRect& reach);

/// Keeps the instances that were seen, and the cells that have any.
void keepSeen(std::vector<PeelCell>& cells, std::vector<PeelInstance>& instances,
              const std::vector<std::uint32_t>& seen);

}  // namespace meniscus

#include "core/tiles/tile_rays.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace meniscus::tiles {

int lanePixelX(LaneOrder order, int lane) {
  if (order == LaneOrder::rows) return lane % kTileSize;
  return (lane & 1) | (lane >> 2 & 1) << 1 | (lane >> 4 & 1) << 2;
}

int lanePixelY(LaneOrder order, int lane) {
  if (order == LaneOrder::rows) return lane / kTileSize;
  return (lane >> 1 & 1) | (lane >> 3 & 1) << 1 | (lane >> 5 & 1) << 2;
}

TileRays makeRays(const TileTarget& target, LaneOrder order) {
  const View& view = target.view;
  TileRays rays{};
  for (int k = 0; k < kTilePixels; ++k) {
    rays.laneX[k] = static_cast<float>(lanePixelX(order, k)) + 0.5f;
    rays.laneY[k] = static_cast<float>(lanePixelY(order, k)) + 0.5f;
  }
  rays.perspective = view.projection == Projection::perspective;
  rays.pixelSize = static_cast<float>(view.pixelSize);
  rays.nearZ = static_cast<float>(view.nearZ);
  rays.farZ = static_cast<float>(view.farZ);
  rays.eyeZ = static_cast<float>(view.distance);
  rays.eyeZExact = view.distance;
  rays.pixelSizeExact = view.pixelSize;
  const double span = view.nearZ - view.farZ;
  rays.depthFactor = static_cast<float>((rays.perspective ? view.distance - view.nearZ : 1.0) / span);
  return rays;
}

void moveRays(TileRays& rays, const TileTarget& target, int x, int y) {
  rays.cornerX = x + static_cast<double>(target.sampleShift.x);
  rays.cornerY = y + static_cast<double>(target.sampleShift.y);
  rays.slopeXExact = (rays.cornerX - target.view.center.x) * target.view.pixelSize;
  rays.slopeYExact = (rays.cornerY - target.view.center.y) * target.view.pixelSize;
  rays.slopeX = static_cast<float>(rays.slopeXExact);
  rays.slopeY = static_cast<float>(rays.slopeYExact);
}

namespace {

// Calls f(first pixel in the planes, first in the tile, count) for each row of a tile inside the area.
template <typename F>
void forRows(const PixelArea& area, int x, int y, F f) {
  const int left = std::max(area.x - x, 0), right = std::min(area.x + area.width - x, kTileSize);
  const int bottom = std::max(area.y - y, 0), top = std::min(area.y + area.height - y, kTileSize);
  if (left >= right) return;
  for (int row = bottom; row < top; ++row) {
    const std::size_t to = static_cast<std::size_t>(y + row - area.y) * static_cast<std::size_t>(area.width) +
                           static_cast<std::size_t>(x + left - area.x);
    f(to, static_cast<std::size_t>(row * kTileSize + left), static_cast<std::size_t>(right - left));
  }
}

}  // namespace

void storeTile(const TilePixels& pixels, int x, int y, Planes& planes) {
  const PlaneChannels& wanted = planes.channels;
  forRows(planes.area, x, y, [&](std::size_t to, std::size_t from, std::size_t count) {
    const auto copy = [&](bool is, auto& plane, const auto* tile) {
      if (is) std::memcpy(plane.data() + to, tile + from, 4 * count);
    };
    copy(true, planes.depth, pixels.depth);
    copy(wanted.albedo, planes.albedo, pixels.albedo);
    copy(wanted.normal, planes.normal, pixels.normal);
    copy(wanted.id, planes.id, pixels.id);
    copy(wanted.distance, planes.distance, pixels.distance);
  });
}

void clearTile(int x, int y, Planes& planes) {
  const PlaneChannels& wanted = planes.channels;
  forRows(planes.area, x, y, [&](std::size_t to, std::size_t, std::size_t count) {
    const auto fill = [&](bool is, auto& plane, auto value) {
      if (is) std::fill_n(plane.data() + to, count, value);
    };
    fill(true, planes.depth, 0.0f);
    fill(wanted.albedo, planes.albedo, 0u);
    fill(wanted.normal, planes.normal, 0u);
    fill(wanted.id, planes.id, 0u);
    fill(wanted.distance, planes.distance, std::numeric_limits<float>::infinity());
  });
}

}  // namespace meniscus::tiles

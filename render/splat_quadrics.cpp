#include "render/splat_quadrics.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <span>
#include <utility>

#include "core/tiles/quadric_source.h"
#include "render/tile_quadrics.h"

namespace meniscus {

namespace {

// Of a quadric, or a little less: the ball around it has this radius at least.
double largestRadius(const Primitives& primitives) {
  float largest = 0;
  tiles::forSets(primitives, [&](const Quadrics& quadrics, std::span<const QuadricCopy>) {
    for (const SpherePrimitive& s : quadrics.spheres) largest = std::max(largest, s.radius);
    for (const CylinderPrimitive& c : quadrics.cylinders)
      largest = std::max({largest, c.radius, 0.5f * glm::distance(c.a, c.b)});
    for (const EllipsoidPrimitive& e : quadrics.ellipsoids) largest = std::max(largest, glm::length(e.axisA));
  });
  return static_cast<double>(largest);
}

}  // namespace

void SplatQuadrics::setPrimitives(std::shared_ptr<const Primitives> primitives, Apart apart,
                                  EachCopy eachCopy) {
  primitives_ = std::move(primitives);
  apart_ = std::move(apart);
  eachCopy_ = std::move(eachCopy);
  largest_.reset();
  levels_ = nullptr;
  uploaded_.clear();
}

// Even at the far plane: most pictures need no clusters to know that.
bool SplatQuadrics::tooLargeToThin(const tiles::TileTarget& target) {
  if (!largest_) largest_ = largestRadius(*primitives_);
  const View& view = target.view;
  const bool perspective = view.projection == Projection::perspective;
  const double across = view.pixelSize * (perspective ? view.distance - view.farZ : 1);  // a pixel [Å]
  return *largest_ == 0 || *largest_ > tiles::kThinnedRadius * across;
}

int SplatQuadrics::levelFor(const tiles::TileTarget& target) {
  if (!target.thinned || tooLargeToThin(target)) return 0;
  if (!levels_) levels_ = tiles::levelsOf(*primitives_);
  return levels_->levelFor(target);
}

const QuadricBuffers& SplatQuadrics::upload(const tiles::TileTarget& target) {
  const int level = levelFor(target);
  const auto known = uploaded_.find(level);
  if (known != uploaded_.end()) return known->second;
  QuadricBuffers buffers;
  if (level == 0) {
    buffers.upload(apart_());
  } else {
    const Primitives& balls = *levels_->level(level).primitives;
    buffers.upload(balls.units.empty() ? balls : eachCopy_(balls));
  }
  return uploaded_.emplace(level, std::move(buffers)).first->second;
}

void SplatQuadrics::add(FrameGraph& graph, ShaderLibrary& shaders, const tiles::TileTarget& target,
                        const GBufferRefs& gbuffer, const std::string& prefix) {
  const QuadricBuffers& buffers = upload(target);
  if (levels_) tellDetail(graph, *levels_, target, prefix);
  addQuadrics(graph, buffers, shaders, gbuffer, prefix);
}

std::vector<ResourceStats> SplatQuadrics::buffers() const {
  std::vector<ResourceStats> out;
  for (const auto& [level, buffers] : uploaded_) {
    for (ResourceStats& buffer : buffers.buffers()) {
      if (level > 0) buffer.name = "balls that stand for others";
      out.push_back(std::move(buffer));
    }
  }
  return out;
}

}  // namespace meniscus

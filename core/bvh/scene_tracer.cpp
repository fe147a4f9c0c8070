#include "core/bvh/scene_tracer.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace meniscus::bvh {

SceneTracer::SceneTracer(std::shared_ptr<const Primitives> primitives)
    : primitives_(std::move(primitives)), solids_(*primitives_) {
  for (const MetaballField& field : primitives_->surfaces) {
    requireValid(field, "ray tracing");
    auto surface = std::make_unique<Surface>();
    surface->tree = buildFieldTree(field);
    surface->tracer.emplace(field, surface->tree);
    surfaces_.push_back(std::move(surface));
  }
}

FieldRay SceneTracer::of(const SceneRay& ray, std::size_t surface, double to) {
  const Side side = ray.start.surface == surface ? ray.start.side : Side::unknown;
  return {ray.origin, ray.direction, ray.from, to, side};
}

SceneHit SceneTracer::cast(const SceneRay& ray, RayScratch& scratch, TraceCounts& counts) const {
  SceneHit hit;
  const SolidHit solid = solids_.cast({ray.origin, ray.direction, ray.from, ray.to}, ray.start.solid, counts);
  if (solid) {
    hit = {solid.distance, solid.point, solid.normal, solid.fromInside,
           solid.color,    solid.id,    kNoSurface,   solid.solid};
  }
  FieldHit nearest;
  std::size_t which = 0;
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    const FieldHit met =
        surfaces_[i]->tracer->cast(of(ray, i, std::min(ray.to, hit.distance)), scratch, counts);
    if (!(met.distance < hit.distance)) continue;
    hit.distance = met.distance;
    nearest = met;
    which = i;
  }
  if (!nearest) return hit;
  hit.point = ray.origin + nearest.distance * ray.direction;
  const mesh::SurfacePoint s = surfaces_[which]->tracer->surfaceAt(nearest, hit.point, scratch);
  const double length = glm::length(s.outward);
  hit.normal = length > 0 ? s.outward / length : ray.direction * (nearest.fromInside ? 1.0 : -1.0);
  hit.fromInside = nearest.fromInside;
  hit.color = s.color;
  hit.id = s.id;
  hit.surface = static_cast<std::uint32_t>(which);
  hit.solid = kNoSolid;
  return hit;
}

double SceneTracer::distance(const SceneRay& ray, bool surfaces, RayScratch& scratch,
                             TraceCounts& counts) const {
  double nearest = solids_.distance({ray.origin, ray.direction, ray.from, ray.to}, ray.start.solid, counts);
  if (!surfaces) return nearest;
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    const FieldRay part = of(ray, i, std::min(ray.to, nearest));
    nearest = std::min(nearest, surfaces_[i]->tracer->cast(part, scratch, counts).distance);
  }
  return nearest;
}

bool SceneTracer::blocked(const SceneRay& ray, bool surfaces, RayScratch& scratch,
                          TraceCounts& counts) const {
  if (solids_.blocked({ray.origin, ray.direction, ray.from, ray.to}, ray.start.solid, counts)) return true;
  if (!surfaces) return false;
  for (std::size_t i = 0; i < surfaces_.size(); ++i)
    if (surfaces_[i]->tracer->blocked(of(ray, i, ray.to), scratch, counts)) return true;
  return false;
}

}  // namespace meniscus::bvh

#pragma once
// Rays from anywhere through a whole scene: its surfaces, each with a fitted tree, and its solids.

#include <glm/geometric.hpp>
#include <memory>
#include <optional>

#include "core/bvh/field_tracer.h"
#include "core/bvh/solid_tracer.h"

namespace meniscus::bvh {

inline constexpr std::uint32_t kNoSurface = 0xFFFFFFFFu;

/// What a ray begins on: nothing, a solid, or a surface and the side of it that the ray goes to.
struct RayStart {
  std::uint32_t solid = kNoSolid;
  std::uint32_t surface = kNoSurface;
  Side side = Side::unknown;
};

struct SceneRay {
  glm::dvec3 origin, direction;  ///< relative to Primitives::origin [Å]; unit
  double from = 0, to = kInfinity;
  RayStart start = {};
};

struct SceneHit {
  double distance = kInfinity;
  glm::dvec3 point{0.0};
  glm::dvec3 normal{0.0};  ///< unit, outward
  bool fromInside = false;
  std::uint32_t color = 0, id = 0;  ///< 0xRRGGBB, sRGB
  std::uint32_t surface = kNoSurface, solid = kNoSolid;
  explicit operator bool() const { return distance < kInfinity; }
  /// Of a ray's direction: the normal towards where the ray came from.
  glm::dvec3 normalAgainst(const glm::dvec3& direction) const {
    return glm::dot(normal, direction) > 0 ? -normal : normal;
  }
  /// Of rays that leave on this side of what was hit: towards where the ray came from.
  RayStart outward() const {
    if (surface == kNoSurface) return {solid, kNoSurface, Side::unknown};
    return {kNoSolid, surface, fromInside ? Side::inside : Side::outside};
  }
  /// Of rays that go on through the surface that was hit.
  RayStart onward() const { return {kNoSolid, surface, fromInside ? Side::outside : Side::inside}; }
};

class SceneTracer {
 public:
  /// Builds the trees. Throws InputError as requireValid().
  explicit SceneTracer(std::shared_ptr<const Primitives> primitives);

  SceneHit cast(const SceneRay& ray, RayScratch& scratch, TraceCounts& counts) const;
  /// Whether something is met. `surfaces`: whether these count.
  bool blocked(const SceneRay& ray, bool surfaces, RayScratch& scratch, TraceCounts& counts) const;
  /// How far away the first thing is that is met.
  double distance(const SceneRay& ray, bool surfaces, RayScratch& scratch, TraceCounts& counts) const;

  const Primitives& primitives() const { return *primitives_; }

 private:
  struct Surface {
    FieldTree tree;
    std::optional<FieldTracer> tracer;
  };
  static FieldRay of(const SceneRay& ray, std::size_t surface, double to);

  std::shared_ptr<const Primitives> primitives_;
  std::vector<std::unique_ptr<Surface>> surfaces_;
  SolidTracer solids_;
};

}  // namespace meniscus::bvh

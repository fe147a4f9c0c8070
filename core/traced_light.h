#pragma once
// Secondary rays for a picture: shadows of the key light, ambient occlusion, mirror reflection and
// refraction, traced exactly through the whole scene from what each pixel's ray meets first
// (core/bvh/scene_tracer.h).
//
// Shadows are of the light that shadow maps filter (render/post/shadow.h): parallel, spread over a disc as
// wide as the penumbra; what lies above the tangent plane of the shaded point blocks it. Occlusion:
// directions by the cosine to the normal, so that the share of those that are blocked is what the sky loses;
// blockers count by distance as in render/post/occlusion.h. Rays of a pixel are a Hammersley set, turned
// pixel by pixel (R. Cranley, T. Patterson, SIAM J. Numer. Anal. 13, 1976, doi 10.1137/0713071): the same
// picture every time.
//
// Mirrors and glass are surfaces only; Fresnel's equations for unpolarized light share a ray's light out
// between its mirrored and its refracted part. Glass absorbs exponentially with the way through it (Bouguer,
// Lambert, Beer). What they show of the rest of the scene is lit as pictures are.

#include <cstdint>
#include <functional>
#include <glm/vec4.hpp>
#include <vector>

#include "core/bvh/scene_tracer.h"
#include "core/effects/surface_planes.h"
#include "core/render_settings.h"
#include "core/scene.h"
#include "core/view.h"

namespace meniscus {

/// One frame of a picture.
struct TracedFrame {
  const View& view;
  int x = 0, y = 0, width = 0, height = 0;  ///< the target's pixels of the picture
  glm::vec2 sampleShift{0.0f};              ///< of the rays within their pixels
  int sample = 0, samples = 1;  ///< which of how many rays per pixel; each takes a part of the others
};

struct TracedLightSettings {
  TraceSettings trace;
  ShadowSettings shadows;
  OcclusionSettings occlusion;
  Lighting lighting;
  Background background;
};

struct TracedPlanes {
  effects::Shares visibility;            ///< share of the key light that arrives; 0 on the background
  std::vector<std::uint32_t> occlusion;  ///< 16 bits each: what is hidden of the sky; the sky
  /// Linear light that is added, and the share that is left of what shading says: 0, 0, 0, 1 where there is
  /// neither a mirror nor glass.
  std::vector<glm::vec4> light;
};

/// Planes that the settings do not ask for stay empty. `watch` is called on this thread now and then; what it
/// throws ends the tracing.
void traceLight(const bvh::SceneTracer& scene, const TracedFrame& frame, const TracedLightSettings& settings,
                TracedPlanes& planes, bvh::TraceCounts& counts, const std::function<void()>& watch = {});

/// Of unpolarized light that meets a wall: the share that is mirrored. cosine: of the angle to the normal,
/// 0..1; ratio: index of refraction where the light comes from over that of the other side. 1 beyond the
/// critical angle. Fresnel 1823; Born and Wolf, Principles of Optics, 1.5.
double fresnel(double cosine, double ratio);

/// Where refracted light goes (Snell); nothing beyond the critical angle. direction, normal: unit, the normal
/// towards where the light comes from.
std::optional<glm::dvec3> refracted(const glm::dvec3& direction, const glm::dvec3& normal, double ratio);

/// Linear light of the sky in a direction in view axes, of which y is up; at most 1.
glm::dvec3 skyLight(const glm::dvec3& direction);

/// What one ray shows.
class LightTracer {
 public:
  /// All must outlive it.
  LightTracer(const bvh::SceneTracer& scene, const View& view, const TracedLightSettings& settings);

  /// Linear light along a ray through mirrors and glass.
  glm::dvec3 radiance(const bvh::SceneRay& ray, bvh::RayScratch& scratch, bvh::TraceCounts& counts) const;
  /// Of a surface that a ray met: light that its mirror or glass adds, and the share left of its own.
  glm::dvec4 surfaceLight(const bvh::SceneHit& hit, const glm::dvec3& direction, bvh::RayScratch& scratch,
                          bvh::TraceCounts& counts) const;

 private:
  struct Bounces {
    int reflect, refract;
    double weight;  // of what is found in the picture
  };
  glm::dvec3 follow(const bvh::SceneRay& ray, bool inGlass, const Bounces& left, bvh::RayScratch& scratch,
                    bvh::TraceCounts& counts) const;
  glm::dvec4 split(const bvh::SceneHit& hit, const glm::dvec3& direction, const Bounces& left,
                   bvh::RayScratch& scratch, bvh::TraceCounts& counts) const;
  glm::dvec3 environment(const glm::dvec3& direction) const;
  glm::dvec3 transmitted(double distance) const;
  glm::dvec3 shade(const bvh::SceneHit& hit, const glm::dvec3& direction, bvh::RayScratch& scratch,
                   bvh::TraceCounts& counts) const;
  double keyOn(const glm::dvec3& normal) const;
  double highlight(const glm::dvec3& normal, const glm::dvec3& toEye, double key) const;

  const bvh::SceneTracer& scene_;
  TracedLightSettings settings_;
  glm::dmat3 toView_;
  glm::dvec3 toKey_, toFill_;  // unit, in the scene's axes
  glm::dvec3 extinction_;      // of glass [1/Å]
};

}  // namespace meniscus

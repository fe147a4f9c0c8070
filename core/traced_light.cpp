#include "core/traced_light.h"

#include <tbb/blocked_range2d.h>
#include <tbb/combinable.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "core/bvh/view_ray.h"
#include "core/environment_map.h"
#include "core/random.h"
#include "core/sampling.h"
#include "core/srgb.h"

namespace meniscus {

using bvh::RayScratch;
using bvh::RayStart;
using bvh::SceneHit;
using bvh::SceneRay;
using bvh::SceneTracer;
using bvh::TraceCounts;

namespace {

constexpr double kPi = 3.14159265358979323846;
// What changes the picture by less is the environment's light, whatever lies there.
constexpr double kLeastWeight = 1.0 / 1024;
// Rows that are traced between two looks at whether they are still wanted; pixels of a row that a thread
// takes at once, few, so that none waits long for the others at a band's end.
constexpr int kBand = 8, kBlock = 32;

// Two numbers in [0, 1) that neighbouring pixels do not share.
glm::dvec2 turnOf(int x, int y, std::uint64_t purpose) {
  const std::uint64_t pixel =
      static_cast<std::uint64_t>(static_cast<std::uint32_t>(y)) << 32 | static_cast<std::uint32_t>(x);
  Random random(pixel * 4 + purpose);
  const double a = random.uniform(0, 1);
  return {a, random.uniform(0, 1)};
}

// Point `index` of `count` of a Hammersley set, turned.
glm::dvec2 pointOf(int index, int count, const glm::dvec2& turn) {
  const glm::dvec2 p((index + 0.5) / count + turn.x,
                     radicalInverse2(static_cast<std::uint32_t>(index)) + turn.y);
  return p - glm::floor(p);
}

struct Frame3 {
  glm::dvec3 x, y, z;
};
// Perpendicular unit vectors, z given (J. Frisvad, JGT 16, 2012, doi 10.1080/2165347X.2012.689606, as T. Duff
// et al., JCGT 6(1), 2017, made it right for all z).
Frame3 frameAround(const glm::dvec3& z) {
  const double sign = std::copysign(1.0, z.z), a = -1 / (sign + z.z), b = z.x * z.y * a;
  return {{1 + sign * z.x * z.x * a, sign * b, -sign * z.x}, {b, sign + z.y * z.y * a, -z.y}, z};
}

// Of `total` rays per pixel, those of this frame: so many, every `samples`-th from `sample` on.
struct RayShare {
  int count, all;
  int index(int k, const TracedFrame& frame) const { return k * frame.samples + frame.sample; }
};
RayShare shareOf(int total, const TracedFrame& frame) {
  const int count = std::max((total + frame.samples - 1) / frame.samples, 1);
  return {count, count * frame.samples};
}

std::uint32_t stored(double share) {
  return static_cast<std::uint32_t>(std::clamp(share, 0.0, 1.0) * 65535 + 0.5);
}

glm::dvec3 towards(const DirectionalLight& light) {
  const double length = glm::length(light.direction);
  return length > 0 ? -light.direction / length : glm::dvec3(0, 0, 1);
}

glm::dvec3 linearLight(std::uint32_t color) {
  const std::array<double, 256>& linear = linearOfBytes();
  return {linear[color >> 16 & 255u], linear[color >> 8 & 255u], linear[color & 255u]};
}

// Per Å, so that a distance of glass leaves a colour of white light; black would leave nothing of no glass.
glm::dvec3 extinctionOf(const TraceSettings& trace) {
  const glm::dvec3 left = glm::max(linearLight(trace.attenuationColor), glm::dvec3(1e-12));
  return -glm::log(left) / trace.attenuationDistance;
}

/// Computes what rays from one pixel's hit find.
class PixelTracer {
 public:
  PixelTracer(const SceneTracer& scene, const TracedFrame& frame, const TracedLightSettings& settings)
      : scene_(scene),
        frame_(frame),
        settings_(settings),
        light_(scene, frame.view, settings),
        toLight_(glm::transpose(frame.view.rotation) * towards(settings.lighting.key)) {}

  void trace(const SceneHit& hit, const glm::dvec3& direction, int x, int y, std::size_t at,
             TracedPlanes& planes, RayScratch& scratch, TraceCounts& counts) const {
    const glm::dvec3 normal = hit.normalAgainst(direction);
    if (settings_.trace.shadows > 0)
      planes.visibility[at] =
          static_cast<std::uint16_t>(stored(visibility(hit, normal, x, y, scratch, counts)));
    if (settings_.trace.occlusion > 0)
      planes.occlusion[at] = stored(hidden(hit, normal, x, y, scratch, counts)) | 65535u << 16;
    if (settings_.trace.light() && hit.surface != bvh::kNoSurface)
      planes.light[at] = glm::vec4(light_.surfaceLight(hit, direction, scratch, counts));
  }

 private:
  // What is of glass hides nothing.
  bool surfacesHide() const { return settings_.trace.refract == 0; }
  double visibility(const SceneHit& hit, const glm::dvec3& normal, int x, int y, RayScratch& scratch,
                    TraceCounts& counts) const;
  double hidden(const SceneHit& hit, const glm::dvec3& normal, int x, int y, RayScratch& scratch,
                TraceCounts& counts) const;

  const SceneTracer& scene_;
  const TracedFrame& frame_;
  const TracedLightSettings& settings_;
  LightTracer light_;
  glm::dvec3 toLight_;
};

double PixelTracer::visibility(const SceneHit& hit, const glm::dvec3& normal, int x, int y,
                               RayScratch& scratch, TraceCounts& counts) const {
  const double facing = glm::dot(normal, toLight_);
  if (!(facing > 0)) return 0;
  const bool soft = settings_.shadows.mode == ShadowMode::soft && settings_.shadows.penumbra > 0;
  if (!soft)
    return scene_.blocked({hit.point, toLight_, 0, bvh::kInfinity, hit.outward()}, surfacesHide(), scratch,
                          counts)
               ? 0
               : 1;
  const Frame3 frame = frameAround(toLight_);
  const RayShare share = shareOf(settings_.trace.shadows, frame_);
  const glm::dvec2 turn = turnOf(x, y, 1);
  int lit = 0;
  for (int k = 0; k < share.count; ++k) {
    const glm::dvec2 p = pointOf(share.index(k, frame_), share.all, turn);
    const double radius = 0.5 * settings_.shadows.penumbra * std::sqrt(p.x), angle = 2 * kPi * p.y;
    const glm::dvec3 aside = radius * (std::cos(angle) * frame.x + std::sin(angle) * frame.y);
    // Along the light to the tangent plane: what blocks lies above it.
    const double rise = -glm::dot(aside, normal) / facing;
    const glm::dvec3 from = hit.point + aside + rise * toLight_;
    // The solid itself, convex, lies below; of a surface this is not known.
    const RayStart start{hit.solid, bvh::kNoSurface, bvh::Side::unknown};
    lit +=
        scene_.blocked({from, toLight_, 0, bvh::kInfinity, start}, surfacesHide(), scratch, counts) ? 0 : 1;
  }
  return static_cast<double>(lit) / share.count;
}

double PixelTracer::hidden(const SceneHit& hit, const glm::dvec3& normal, int x, int y, RayScratch& scratch,
                           TraceCounts& counts) const {
  const Frame3 frame = frameAround(normal);
  const RayShare share = shareOf(settings_.trace.occlusion, frame_);
  const glm::dvec2 turn = turnOf(x, y, 2);
  const double reach = settings_.occlusion.radius;
  double sum = 0;
  for (int k = 0; k < share.count; ++k) {
    const glm::dvec2 p = pointOf(share.index(k, frame_), share.all, turn);
    const double sine = std::sqrt(p.x), angle = 2 * kPi * p.y;
    const glm::dvec3 direction = sine * std::cos(angle) * frame.x + sine * std::sin(angle) * frame.y +
                                 std::sqrt(std::max(1 - p.x, 0.0)) * frame.z;
    const SceneRay ray{hit.point, direction, 0, reach > 0 ? reach : bvh::kInfinity, hit.outward()};
    if (reach > 0) {
      const double distance = scene_.distance(ray, surfacesHide(), scratch, counts);
      sum += std::clamp(2 - 2 * distance / reach, 0.0, 1.0);
    } else {
      sum += scene_.blocked(ray, surfacesHide(), scratch, counts) ? 1 : 0;
    }
  }
  return sum / share.count;
}

}  // namespace

double fresnel(double cosine, double ratio) {
  const double other2 = 1 - ratio * ratio + ratio * ratio * cosine * cosine;
  if (!(other2 > 0)) return 1;
  const double other = std::sqrt(other2);
  const double across = (ratio * cosine - other) / (ratio * cosine + other);
  const double along = (cosine - ratio * other) / (cosine + ratio * other);
  return std::min((across * across + along * along) / 2, 1.0);
}

std::optional<glm::dvec3> refracted(const glm::dvec3& direction, const glm::dvec3& normal, double ratio) {
  const double cosine = -glm::dot(direction, normal);
  const double other2 = 1 - ratio * ratio + ratio * ratio * cosine * cosine;
  if (!(other2 > 0)) return std::nullopt;
  return glm::normalize(ratio * direction + (ratio * cosine - std::sqrt(other2)) * normal);
}

glm::dvec3 skyLight(const glm::dvec3& direction) {
  const double up = direction.y;
  const auto blend = [](const glm::dvec3& a, const glm::dvec3& b, double share) {
    return a + std::clamp(share, 0.0, 1.0) * (b - a);
  };
  const glm::dvec3 horizon(0.92, 0.94, 0.96), zenith(0.16, 0.33, 0.68), ground(0.24, 0.2, 0.16);
  if (up >= 0) return blend(horizon, zenith, std::sqrt(up));
  return blend(horizon, ground, -6 * up);
}

LightTracer::LightTracer(const SceneTracer& scene, const View& view, const TracedLightSettings& settings)
    : scene_(scene),
      settings_(settings),
      toView_(view.rotation),
      toKey_(glm::transpose(view.rotation) * towards(settings.lighting.key)),
      toFill_(glm::transpose(view.rotation) * towards(settings.lighting.fill)),
      extinction_(extinctionOf(settings.trace)) {}

glm::dvec3 LightTracer::environment(const glm::dvec3& direction) const {
  switch (settings_.trace.environment) {
    case Environment::background:
      return linearLight(settings_.background.color);
    case Environment::map:
      return settings_.trace.environmentMap->light(toView_ * direction);
    case Environment::sky:
      break;
  }
  return skyLight(toView_ * direction);
}

glm::dvec3 LightTracer::transmitted(double distance) const {
  return glm::exp(-extinction_ * distance);
}

double LightTracer::keyOn(const glm::dvec3& normal) const {
  return std::max(glm::dot(normal, toKey_), 0.0) * settings_.lighting.key.intensity;
}

// As lit() of shaders/include/lighting.glsl.
double LightTracer::highlight(const glm::dvec3& normal, const glm::dvec3& toEye, double key) const {
  const Lighting& l = settings_.lighting;
  if (!(key > 0)) return 0;
  const glm::dvec3 halfway = glm::normalize(toKey_ + toEye + 1e-9 * normal);
  return l.specular * std::pow(std::max(glm::dot(normal, halfway), 1e-6), l.shininess) * l.key.intensity *
         std::min(key / (0.1 * l.key.intensity), 1.0);
}

glm::dvec3 LightTracer::shade(const SceneHit& hit, const glm::dvec3& direction, RayScratch& scratch,
                              TraceCounts& counts) const {
  const Lighting& l = settings_.lighting;
  const glm::dvec3 normal = hit.normalAgainst(direction);
  double key = keyOn(normal);
  const bool shadows = settings_.trace.shadows > 0 && settings_.shadows.mode != ShadowMode::off;
  if (key > 0 && shadows &&
      scene_.blocked({hit.point, toKey_, 0, bvh::kInfinity, hit.outward()}, settings_.trace.refract == 0,
                     scratch, counts))
    key = 0;
  const double fill = std::max(glm::dot(normal, toFill_), 0.0) * l.fill.intensity;
  return linearLight(hit.color) * (key + fill + l.ambient) + highlight(normal, -direction, key);
}

glm::dvec4 LightTracer::split(const SceneHit& hit, const glm::dvec3& direction, const Bounces& left,
                              RayScratch& scratch, TraceCounts& counts) const {
  const glm::dvec3 normal = hit.normalAgainst(direction);
  const double cosine = std::min(-glm::dot(direction, normal), 1.0);
  const double ratio = hit.fromInside ? settings_.trace.index : 1 / settings_.trace.index;
  const bool glass = settings_.trace.refract > 0;
  const double mirrored = fresnel(cosine, glass ? ratio : 1 / settings_.trace.index);
  const auto goOn = [&](const glm::dvec3& to, const RayStart& start, bool inGlass, const Bounces& bounces) {
    if (bounces.reflect < 0 || bounces.refract < 0 || bounces.weight < kLeastWeight) return environment(to);
    return follow({hit.point, to, 0, bvh::kInfinity, start}, inGlass, bounces, scratch, counts);
  };
  glm::dvec3 light(0.0);
  if (mirrored > 0) {
    const glm::dvec3 to = glm::normalize(direction + 2 * cosine * normal);
    // Within glass a ray goes on from wall to wall.
    Bounces bounces{left.reflect - 1, left.refract, left.weight * mirrored};
    if (hit.fromInside && glass)
      bounces = {left.reflect - (mirrored < 1 ? 1 : 0), left.refract - 1, bounces.weight};
    light += mirrored * goOn(to, hit.outward(), glass && hit.fromInside, bounces);
  }
  if (!glass) return {light, 1 - mirrored};
  if (const auto to = refracted(direction, normal, ratio); to && mirrored < 1)
    light += (1 - mirrored) * goOn(*to, hit.onward(), !hit.fromInside,
                                   {left.reflect, left.refract - 1, left.weight * (1 - mirrored)});
  return {light, 0};
}

glm::dvec3 LightTracer::follow(const SceneRay& ray, bool inGlass, const Bounces& left, RayScratch& scratch,
                               TraceCounts& counts) const {
  const SceneHit hit = scene_.cast(ray, scratch, counts);
  if (!hit) return environment(ray.direction);
  const glm::dvec3 share = inGlass ? transmitted(hit.distance) : glm::dvec3(1);
  if (hit.surface == bvh::kNoSurface || !settings_.trace.light())
    return share * shade(hit, ray.direction, scratch, counts);
  const glm::dvec4 light = split(hit, ray.direction, left, scratch, counts);
  if (light.w == 0) return share * glm::dvec3(light);
  return share * (glm::dvec3(light) + light.w * shade(hit, ray.direction, scratch, counts));
}

glm::dvec3 LightTracer::radiance(const SceneRay& ray, RayScratch& scratch, TraceCounts& counts) const {
  return follow(ray, false, {settings_.trace.reflect, settings_.trace.refract, 1}, scratch, counts);
}

glm::dvec4 LightTracer::surfaceLight(const SceneHit& hit, const glm::dvec3& direction, RayScratch& scratch,
                                     TraceCounts& counts) const {
  glm::dvec4 light =
      split(hit, direction, {settings_.trace.reflect, settings_.trace.refract, 1}, scratch, counts);
  if (settings_.trace.refract == 0) return light;
  // Glass has no light of its own but the highlight.
  const glm::dvec3 normal = hit.normalAgainst(direction);
  return light + glm::dvec4(glm::dvec3(highlight(normal, -direction, keyOn(normal))), 0);
}

void traceLight(const SceneTracer& scene, const TracedFrame& frame, const TracedLightSettings& settings,
                TracedPlanes& planes, TraceCounts& counts, const std::function<void()>& watch) {
  const auto pixels = static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
  planes.visibility.assign(settings.trace.shadows > 0 ? pixels : 0, 0);
  planes.occlusion.assign(settings.trace.occlusion > 0 ? pixels : 0, 0);
  planes.light.assign(settings.trace.light() ? pixels : 0, glm::vec4(0, 0, 0, 1));
  const bvh::ViewRays rays(frame.view, scene.primitives().origin);
  const PixelTracer tracer(scene, frame, settings);
  struct Part {
    RayScratch scratch;
    TraceCounts counts;
  };
  tbb::combinable<Part> parts;
  const auto traceBlock = [&](const tbb::blocked_range2d<int>& block) {
    auto& [scratch, part] = parts.local();
    for (int row = block.rows().begin(); row < block.rows().end(); ++row) {
      for (int column = block.cols().begin(); column < block.cols().end(); ++column) {
        const int x = frame.x + column, y = frame.y + row;
        const auto ray = rays.through(glm::dvec2(x, y) + 0.5 + glm::dvec2(frame.sampleShift));
        const SceneHit hit = scene.cast({ray.origin, ray.direction, ray.start}, scratch, part);
        if (!hit) continue;
        const auto at = static_cast<std::size_t>(row) * static_cast<std::size_t>(frame.width) +
                        static_cast<std::size_t>(column);
        tracer.trace(hit, ray.direction, x, y, at, planes, scratch, part);
      }
    }
  };
  for (int top = 0; top < frame.height; top += kBand) {
    if (watch) watch();
    const int end = std::min(top + kBand, frame.height);
    tbb::parallel_for(tbb::blocked_range2d<int>(top, end, 1, 0, frame.width, kBlock), traceBlock,
                      tbb::simple_partitioner{});
  }
  parts.combine_each([&](const Part& part) { counts.add(part.counts); });
}

}  // namespace meniscus

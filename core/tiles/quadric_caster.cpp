// Rays against spheres, capped cylinders and ellipsoids, a vector of rays at a time: the formulas of
// shaders/shared/quadrics.glsl and projection.glsl in the same order of operations (they return early, which
// lanes of a vector cannot), and the visible end as in shaders/include/quadric_fragment.glsl.
#include "core/tiles/quadric_caster.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/tiles/quadric_caster.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include "core/tiles/lanes.inl"

HWY_BEFORE_NAMESPACE();
namespace meniscus::tiles::HWY_NAMESPACE {
namespace {

constexpr float kParallelLimit = 1e-12f;  // below this, sin^2 and cos of unit float32 vectors are rounding
constexpr float kLargest = 1e30f;

// The nearest hit of each ray so far.
struct State {
  alignas(64) float z[kTilePixels];
  alignas(64) float position[3][kTilePixels];  // relative to the centre
  alignas(64) float normal[3][kTilePixels];    // of any length
  alignas(64) std::uint32_t albedo[kTilePixels], id[kTilePixels], record[kTilePixels];
  alignas(64) float direction[3][kTilePixels];  // of the rays
};

struct Ray {
  Vec3 point, direction;  // point: relative to the primitive's centre
};

HWY_INLINE Ray rayOf(const TileRays& rays, const State& s, const QuadricRecord& q, float x0, float y0,
                     std::size_t k) {
  const F f;
  Ray ray;
  ray.direction = {hn::Load(f, s.direction[0] + k), hn::Load(f, s.direction[1] + k),
                   hn::Load(f, s.direction[2] + k)};
  if (q.fromEye != 0) {
    ray.point = {all(-q.centerX), all(-q.centerY), all(q.eyeAbove)};
  } else {
    ray.point = {all(q.perPixel) * (hn::Load(f, rays.laneX + k) - all(x0)),
                 all(q.perPixel) * (hn::Load(f, rays.laneY + k) - all(y0)), hn::Zero(f)};
  }
  return ray;
}

// The part of a ray inside a solid: where it begins and ends, relative to the centre, and outward normals.
struct Chord {
  M hit;
  Vec3 entry, exit, entryNormal, exitNormal;
};

HWY_INLINE Chord sphereChord(const Ray& ray, V radius) {
  const Vec3& d = ray.direction;
  const Vec3 nearly = sub(ray.point, scale(d, dot(ray.point, d)));
  const Vec3 nearest = sub(nearly, scale(d, dot(nearly, d)));  // once more: point may be many radii away
  const V discriminant = radius * radius - dot(nearest, nearest);
  Chord c;
  c.hit = discriminant >= hn::Zero(F());
  const Vec3 half = scale(d, hn::Sqrt(hn::Max(discriminant, hn::Zero(F()))));
  c.entry = sub(nearest, half);
  c.exit = add(nearest, half);
  c.entryNormal = c.entry;  // not divided by the radius: its length does not matter
  c.exitNormal = c.exit;
  return c;
}

HWY_INLINE Chord cylinderChord(const Ray& ray, const Vec3& axis, V halfLength, V radius) {
  const F f;
  const V zero = hn::Zero(f), one = all(1.0f), most = all(kLargest), least = all(-kLargest);
  const Vec3& d = ray.direction;
  const Vec3 moment{d.y * axis.z - axis.y * d.z, d.z * axis.x - axis.z * d.x, d.x * axis.y - axis.x * d.y};
  const V slope2 = dot(moment, moment), along = dot(d, axis), height = dot(ray.point, axis);
  const Vec3 aside = sub(ray.point, scale(axis, height));
  // The side.
  const M slanted = slope2 > all(kParallelLimit);
  const V divisor = hn::IfThenElse(slanted, slope2, one);
  const Vec3 crossing = sub(d, scale(axis, along));
  const V middle = hn::Neg(dot(aside, crossing)) / divisor;
  const V offset = dot(aside, moment);
  const V discriminant = radius * radius - offset * offset / divisor;
  const V halfWidth = hn::Sqrt(hn::Max(discriminant, zero) / divisor);
  const V sideIn = hn::IfThenElse(slanted, middle - halfWidth, least);
  const V sideOut = hn::IfThenElse(slanted, middle + halfWidth, most);
  M hit = hn::Or(hn::And(slanted, discriminant >= zero),
                 hn::AndNot(slanted, dot(aside, aside) <= radius * radius));
  // The caps.
  const M crossed = hn::Abs(along) > all(kParallelLimit);
  const V rise = hn::IfThenElse(crossed, along, one);
  const V reach = hn::IfThenElse(along > zero, halfLength, hn::Neg(halfLength));
  const V capIn = hn::IfThenElse(crossed, (hn::Neg(height) - reach) / rise, least);
  const V capOut = hn::IfThenElse(crossed, (hn::Neg(height) + reach) / rise, most);
  hit = hn::And(hit, hn::Or(crossed, hn::Abs(height) <= halfLength));
  const V tIn = hn::Max(sideIn, capIn), tOut = hn::Min(sideOut, capOut);
  Chord c;
  c.hit = hn::And(hit, tIn <= tOut);
  c.entry = add(ray.point, scale(d, tIn));
  c.exit = add(ray.point, scale(d, tOut));
  const Vec3 cap = choose(along > zero, axis, scale(axis, all(-1.0f)));
  c.entryNormal =
      choose(capIn > sideIn, scale(cap, all(-1.0f)), sub(c.entry, scale(axis, dot(c.entry, axis))));
  c.exitNormal = choose(capOut < sideOut, cap, sub(c.exit, scale(axis, dot(c.exit, axis))));
  return c;
}

HWY_INLINE Chord ellipsoidChord(const Ray& ray, const QuadricRecord& q) {
  const Vec3 u = splat(q.axisU), v = splat(q.axisV), w = splat(q.axisW), radii = splat(q.radii);
  const V shortest = hn::Min(radii.x, hn::Min(radii.y, radii.z));
  const Vec3 shares{shortest / radii.x, shortest / radii.y, shortest / radii.z};
  Ray unit;
  unit.point = {dot(ray.point, u) / radii.x, dot(ray.point, v) / radii.y, dot(ray.point, w) / radii.z};
  const Vec3 along{dot(ray.direction, u) * shares.x, dot(ray.direction, v) * shares.y,
                   dot(ray.direction, w) * shares.z};
  unit.direction = normalized(along);
  const Chord s = sphereChord(unit, all(1.0f));
  const auto back = [&](const Vec3& p, const Vec3& factors) {
    return add(add(scale(u, p.x * factors.x), scale(v, p.y * factors.y)), scale(w, p.z * factors.z));
  };
  return {s.hit, back(s.entry, radii), back(s.exit, radii), back(s.entry, shares), back(s.exit, shares)};
}

HWY_INLINE void blend(M m, V value, float* target) {
  hn::Store(hn::IfThenElse(m, value, hn::Load(F(), target)), F(), target);
}
HWY_INLINE void blend(hn::Mask<U> m, std::uint32_t value, std::uint32_t* target) {
  hn::Store(hn::IfThenElse(m, hn::Set(U(), value), hn::Load(U(), target)), U(), target);
}

// Keeps the visible end of a chord where it is the nearest so far, and what the channels need of it. Returns
// whether it is anywhere.
HWY_INLINE bool keepNearest(const Chord& chord, const QuadricRecord& q, std::uint32_t index,
                            const PlaneChannels& wanted, const TileRays& rays, std::size_t k, State& s) {
  const F f;
  const V centerZ = all(q.centerZ), nearZ = all(rays.nearZ);
  V z = centerZ + chord.entry.z;
  M hit = chord.hit;
  M inside = hn::MaskFromVec(hn::Zero(f));
  if (q.meetsNear != 0) {
    inside = z > nearZ;
    z = hn::IfThenElse(inside, centerZ + chord.exit.z, z);
    hit = hn::And(hit, z <= nearZ);
  }
  const M nearer = hn::And(hit, z > hn::Load(f, s.z + k));
  if (hn::AllFalse(f, nearer)) return false;
  blend(nearer, z, s.z + k);
  Vec3 position = chord.entry, normal = chord.entryNormal;
  if (q.meetsNear != 0) {
    position = choose(inside, chord.exit, position);
    normal = choose(inside, scale(chord.exitNormal, all(-1.0f)), normal);
  }
  if (wanted.normal) {
    blend(nearer, normal.x, s.normal[0] + k);
    blend(nearer, normal.y, s.normal[1] + k);
    blend(nearer, normal.z, s.normal[2] + k);
  }
  const auto nearerBits = hn::RebindMask(U(), nearer);
  if (wanted.albedo) blend(nearerBits, q.albedo[0], s.albedo + k);
  if (wanted.id) blend(nearerBits, q.id[0], s.id + k);
  if (wanted.distance) {
    blend(nearer, position.x, s.position[0] + k);
    blend(nearer, position.y, s.position[1] + k);
    blend(nearer, position.z, s.position[2] + k);
    blend(nearerBits, index, s.record + k);
  }
  if (q.kind == QuadricKind::cylinder && (wanted.albedo || wanted.id)) {
    const M second = hn::And(nearer, dot(position, splat(q.axisU)) > hn::Zero(f));
    if (wanted.albedo) blend(hn::RebindMask(U(), second), q.albedo[1], s.albedo + k);
    if (wanted.id) blend(hn::RebindMask(U(), second), q.id[1], s.id + k);
  }
  return true;
}

bool castOne(const QuadricRecord& q, std::uint32_t index, const PlaneChannels& wanted, const TileRays& rays,
             State& s) {
  const auto x0 = static_cast<float>(q.pixelX - rays.cornerX),
             y0 = static_cast<float>(q.pixelY - rays.cornerY);
  // Whether none of a vector of rays can meet it in front of what is there.
  const auto isPassed = [&](std::size_t k) {
    const auto lowest = static_cast<float>(k / kTileSize) + 0.5f,
               highest = static_cast<float>((k + laneCount() - 1) / kTileSize) + 0.5f;
    return y0 + q.highY < lowest || y0 + q.lowY > highest ||
           hn::AllTrue(F(), hn::Load(F(), s.z + k) > all(q.front));
  };
  bool any = false;
  switch (q.kind) {
    case QuadricKind::sphere:
      for (std::size_t k = 0; k < kTilePixels; k += laneCount()) {
        if (isPassed(k)) continue;
        const Chord c = sphereChord(rayOf(rays, s, q, x0, y0, k), all(q.radius));
        any = keepNearest(c, q, index, wanted, rays, k, s) || any;
      }
      break;
    case QuadricKind::cylinder:
      for (std::size_t k = 0; k < kTilePixels; k += laneCount()) {
        if (isPassed(k)) continue;
        const Chord c =
            cylinderChord(rayOf(rays, s, q, x0, y0, k), splat(q.axisU), all(q.radii[0]), all(q.radius));
        any = keepNearest(c, q, index, wanted, rays, k, s) || any;
      }
      break;
    case QuadricKind::ellipsoid:
      for (std::size_t k = 0; k < kTilePixels; k += laneCount()) {
        if (isPassed(k)) continue;
        const Chord c = ellipsoidChord(rayOf(rays, s, q, x0, y0, k), q);
        any = keepNearest(c, q, index, wanted, rays, k, s) || any;
      }
      break;
  }
  return any;
}

// The lowest of all rays' nearest hits: what lies below is hidden from all of them.
float lowestHit(const State& s) {
  const F f;
  V low = hn::Load(f, s.z);
  for (std::size_t k = laneCount(); k < kTilePixels; k += laneCount())
    low = hn::Min(low, hn::Load(f, s.z + k));
  return hn::GetLane(hn::MinOfLanes(f, low));
}

// Distance along the unit ray, as rayDistance() in shaders/shared/projection.glsl; a lane at a time.
float distanceOf(const QuadricRecord& q, const TileRays& rays, const State& s, std::size_t k) {
  const float x = s.position[0][k], y = s.position[1][k], z = s.position[2][k];
  if (!rays.perspective) return q.rangeHi + (q.rangeLo - z);
  const float ex = q.centerX, ey = q.centerY, ez = -q.eyeAbove;
  const float squares = 2.0f * ((ex * x + ey * y) + ez * z) + ((x * x + y * y) + z * z);
  const float px = ex + x, py = ey + y, pz = ez + z;
  const float total = __builtin_sqrtf((px * px + py * py) + pz * pz) + q.rangeHi;
  const float further = total > 0.0f ? squares / total : 0.0f;
  return q.rangeHi + (q.rangeLo + further);
}

bool finish(const QuadricRecord* records, const TileRays& rays, const PlaneChannels& channels, const State& s,
            TilePixels& out) {
  const F f;
  const U u;
  bool any = false;
  for (std::size_t k = 0; k < kTilePixels; k += laneCount()) {
    const V z = hn::Load(f, s.z + k);
    const V value = depthValue(rays, z);
    const M hit = hn::And(z > all(-std::numeric_limits<float>::infinity()), value > hn::Zero(f));
    const V depth = hn::IfThenElseZero(hit, hn::Min(value, all(1.0f)));
    hn::Store(depth, f, out.depth + k);
    any = any || !hn::AllFalse(f, hit);
    const auto hitBits = hn::RebindMask(u, hit);
    if (channels.albedo) hn::Store(hn::IfThenElseZero(hitBits, hn::Load(u, s.albedo + k)), u, out.albedo + k);
    if (channels.id) hn::Store(hn::IfThenElseZero(hitBits, hn::Load(u, s.id + k)), u, out.id + k);
    if (channels.normal) {
      const Vec3 n{hn::Load(f, s.normal[0] + k), hn::Load(f, s.normal[1] + k), hn::Load(f, s.normal[2] + k)};
      hn::Store(hn::IfThenElseZero(hitBits, encodeNormal(n)), u, out.normal + k);
    }
  }
  if (channels.distance) {
    for (std::size_t k = 0; k < kTilePixels; ++k) {
      out.distance[k] = out.depth[k] > 0.0f ? distanceOf(records[s.record[k]], rays, s, k)
                                            : std::numeric_limits<float>::infinity();
    }
  }
  return any;
}

bool castTile(const QuadricRecord* records, const std::uint32_t* list, std::size_t count, float slack,
              const TileRays& rays, const PlaneChannels& channels, TilePixels& out) {
  const F f;
  State s;
  for (std::size_t k = 0; k < kTilePixels; k += laneCount()) {
    hn::Store(all(-std::numeric_limits<float>::infinity()), f, s.z + k);
    hn::Store(all(1.0f), f, s.normal[0] + k);  // encodeNormal() divides
    hn::Store(all(0.0f), f, s.normal[1] + k);
    hn::Store(all(0.0f), f, s.normal[2] + k);
    const Vec3 direction = directionOf(rays, k);
    hn::Store(direction.x, f, s.direction[0] + k);
    hn::Store(direction.y, f, s.direction[1] + k);
    hn::Store(direction.z, f, s.direction[2] + k);
  }
  float lowest = -std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < count; ++i) {
    const QuadricRecord& q = records[list[i]];
    if (q.front + slack < lowest) break;
    if (q.front < lowest) continue;
    if (castOne(q, list[i], channels, rays, s)) lowest = lowestHit(s);
  }
  return finish(records, rays, channels, s, out);
}

}  // namespace
}  // namespace meniscus::tiles::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meniscus::tiles {

HWY_EXPORT(castTile);

bool castQuadrics(std::span<const QuadricRecord> records, std::span<const std::uint32_t> list, float slack,
                  const TileRays& rays, const PlaneChannels& channels, TilePixels& out) {
  return HWY_DYNAMIC_DISPATCH(castTile)(records.data(), list.data(), list.size(), slack, rays, channels, out);
}

}  // namespace meniscus::tiles
#endif

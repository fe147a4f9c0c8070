// The first point on each ray at which a metaball field changes its sign, exactly: a packet of rays walks its
// tile's list in order of nearest distance and keeps the chords that its rays have not left. Between two
// consecutive entries or exits the field along a ray is one polynomial. First a bound of it, each ball at its
// nearest point of the interval, tells most intervals empty; what passes is written down in Bernstein form
// (MATH: docs/methods.md, "Tiles"; Nishita and Nakamae 1994, doi 10.1111/1467-8659.1330271, for the idea of
// looking at the signs of its coefficients). No coefficient above zero: no root. One change of sign: one
// root, found by a bracketed secant. Several: the interval is halved, its left half first. So the first root
// is never missed. Rays are measured from a plane across the view at the list's front, which keeps float32
// exact wherever the camera stands.
#include "core/tiles/field_caster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/tiles/field_caster.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include "core/tiles/field_front.inl"
#include "core/tiles/field_walk.inl"
#include "core/tiles/lanes.inl"

HWY_BEFORE_NAMESPACE();
namespace meniscus::tiles::HWY_NAMESPACE {
namespace {

// Of 1 - r^2 / R^2 near the end of a support.
constexpr float kRoundingOfW = 1.2e-7f;

// Normal, colour and id of hits.
template <typename Kernel>
void shade(Kernel kernel, const FieldTile& tile, const Balls& balls, const Packet& p, V t, M hit, M inside,
           const PlaneChannels& channels, std::size_t k, TilePixels& out) {
  const F f;
  const U u;
  const V zero = hn::Zero(f);
  const V z = hn::IfThenElse(hit, p.direction.z * t, all(kFar));
  const float lowest = hn::GetLane(hn::MinOfLanes(f, z)) - balls.slack;
  Vec3 normal{zero, zero, zero}, color{zero, zero, zero};
  V shares = zero, largest = all(-1.0f);
  auto id = hn::Zero(u);
  for (const TileBall& b : balls.list) {
    if (b.front < lowest) break;
    const Point point = pointNear(b, tile, p);
    const Vec3 from = add(point.position, scale(p.direction, t - point.t));
    // At the lowest levels a surface lies where its ball ends: rounding must not leave it without one.
    const V rounded = all(1.0f) - dot(from, from) * all(b.inverse2);
    const M in = hn::And(hit, rounded > all(-kRoundingOfW));
    if (hn::AllFalse(f, in)) continue;
    const V w = hn::Max(rounded, all(kRoundingOfW));
    const V weight = hn::IfThenElseZero(in, kernel.slope(w) * all(b.coefficient * b.inverse2));
    normal = add(normal, {hn::IfThenElseZero(in, from.x) * weight, hn::IfThenElseZero(in, from.y) * weight,
                          hn::IfThenElseZero(in, from.z) * weight});
    if (!(b.coefficient > 0)) continue;
    const V share = hn::IfThenElseZero(in, kernel.value(w) * all(b.coefficient));
    shares = shares + share;
    const BallRecord& r = tile.records[b.record];
    color = add(color, scale(splat(r.colorSquared), share));
    const M more = share > largest;
    largest = hn::IfThenElse(more, share, largest);
    id = hn::IfThenElse(hn::RebindMask(u, more), hn::Set(u, r.id), id);
  }
  const auto bits = hn::RebindMask(u, hit);
  if (channels.id) hn::Store(hn::IfThenElseZero(bits, id), u, out.id + k);
  if (channels.normal) {
    const V size = hn::Abs(normal.x) + hn::Abs(normal.y) + hn::Abs(normal.z);  // squares might underflow
    const M none = hn::Not(size > zero);  // a critical point: towards the viewer
    normal = choose(inside, scale(normal, all(-1.0f)), normal);
    normal = choose(none, scale(p.direction, all(-1.0f)), normal);
    hn::Store(hn::IfThenElseZero(bits, encodeNormal(normal)), u, out.normal + k);
  }
  if (channels.albedo) {
    const V inverse = all(1.0f) / hn::Max(shares, all(1e-30f));
    const auto channel = [&](V sum) {
      const V stored = hn::Min(hn::Sqrt(sum * inverse), all(1.0f));
      return hn::BitCast(u, hn::ConvertTo(I(), stored * all(255.0f) + all(0.5f)));
    };
    const auto packed = hn::Or(hn::Or(channel(color.x), hn::ShiftLeft<8>(channel(color.y))),
                               hn::Or(hn::ShiftLeft<16>(channel(color.z)), hn::Set(u, 0xFF000000u)));
    hn::Store(hn::IfThenElseZero(bits, packed), u, out.albedo + k);
  }
}

void storeBackground(std::size_t k, const PlaneChannels& channels, TilePixels& out) {
  const F f;
  const U u;
  hn::Store(hn::Zero(f), f, out.depth + k);
  if (channels.distance) hn::Store(all(kFar), f, out.distance + k);
  if (channels.albedo) hn::Store(hn::Zero(u), u, out.albedo + k);
  if (channels.normal) hn::Store(hn::Zero(u), u, out.normal + k);
  if (channels.id) hn::Store(hn::Zero(u), u, out.id + k);
}

constexpr std::size_t kPackets = kTilePixels / laneCount();  // of a tile

// Rays k and following of a tile.
Packet packetOf(const TileRays& rays, std::size_t k, double zStart) {
  Packet p;
  p.direction = directionOf(rays, k);
  p.inverseZ = all(1.0f) / p.direction.z;
  p.laneX = hn::Load(F(), rays.laneX + k);
  p.laneY = hn::Load(F(), rays.laneY + k);
  p.eyeZ = static_cast<float>(rays.eyeZExact - zStart);
  p.nearZ = static_cast<float>(static_cast<double>(rays.nearZ) - zStart);
  return p;
}

// The balls that matter to a tile's rays, measured from where the rays begin; zStart is moved there.
template <typename Kernel>
Balls ballsFromFront(Kernel kernel, const FieldTile& tile, std::span<TileBall> balls, const TileRays& rays,
                     double& zStart) {
  const Balls whole{balls, tile.slack, false};
  if (std::any_of(balls.begin(), balls.end(), [](const TileBall& b) { return b.fromEye; })) return whole;
  const float depth = Front<Kernel>(kernel, balls, rays, static_cast<float>(tile.field->level),
                                    static_cast<float>(tile.largestSupport))
                          .depth(tile.slack);
  if (!(depth > 0)) return whole;
  zStart -= static_cast<double>(depth);
  std::size_t kept = 0;
  for (TileBall& b : balls) {
    if (b.back > -depth) continue;
    const BallRecord& record = tile.records[b.record];
    b.z = static_cast<float>(record.centerZ - zStart);
    b.front = static_cast<float>(static_cast<double>(record.front) - zStart);
    balls[kept++] = b;
  }
  return {balls.first(kept), tile.slack, true};
}

template <typename Kernel>
bool castWith(Kernel kernel, const FieldTile& tile, std::span<TileBall> tileBalls, const TileRays& rays,
              const PlaneChannels& channels, double& zStart, ChordWindow& window, TilePixels& out,
              FieldCounts& counts) {
  const F f;
  const Balls balls = ballsFromFront(kernel, tile, tileBalls, rays, zStart);
  if (balls.list.empty()) {
    for (std::size_t k = 0; k < kTilePixels; k += laneCount()) storeBackground(k, channels, out);
    return true;
  }
  Brackets brackets[kPackets];
  V hits[kPackets];
  M inside[kPackets];
  for (std::size_t i = 0; i < kPackets; ++i) {
    const Packet p = packetOf(rays, i * laneCount(), zStart);
    if (!Walk<Kernel>(kernel, tile, balls, p, window, brackets[i], counts).firstRoots(hits[i], inside[i]))
      return false;
  }
  solve(kernel, brackets, kPackets, toleranceOf(tile), static_cast<float>(tile.field->level), hits, counts);
  for (std::size_t i = 0; i < kPackets; ++i) {
    const std::size_t k = i * laneCount();
    const Packet p = packetOf(rays, k, zStart);
    const V t = hits[i];
    M hit = t < all(kFar);
    const V z = all(static_cast<float>(zStart)) + p.direction.z * hn::IfThenElseZero(hit, t);
    const V value = depthValue(rays, z);
    hit = hn::And(hit, value > hn::Zero(f));
    if (hn::AllFalse(f, hit)) {
      storeBackground(k, channels, out);
      continue;
    }
    hn::Store(hn::IfThenElseZero(hit, hn::Min(value, all(1.0f))), f, out.depth + k);
    if (channels.distance) hn::Store(hn::IfThenElse(hit, t, all(kFar)), f, out.distance + k);
    if (channels.albedo || channels.normal || channels.id)
      shade(kernel, tile, balls, p, hn::IfThenElseZero(hit, t), hit, inside[i], channels, k, out);
  }
  return true;
}

bool castFieldTile(const FieldTile& tile, std::span<TileBall> balls, const TileRays& rays,
                   const PlaneChannels& channels, double& zStart, TilePixels& out, FieldCounts& counts) {
  thread_local ChordWindow window(16);
  const Kernel& kernel = tile.field->kernel;
  switch (kernel.shape) {
    case KernelShape::sextic:
      return castWith(SexticKernel{0}, tile, balls, rays, channels, zStart, window, out, counts);
    case KernelShape::quartic:
      return castWith(QuarticKernel{0}, tile, balls, rays, channels, zStart, window, out, counts);
    case KernelShape::power:
      return castWith(PowerKernel{kernel.exponent}, tile, balls, rays, channels, zStart, window, out, counts);
  }
  return false;
}

}  // namespace
}  // namespace meniscus::tiles::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meniscus::tiles {

HWY_EXPORT(castFieldTile);

namespace {

// How far 0 is from [low, low + kTileSize].
float outsideTile(float low) {
  return std::max(std::max(low, -low - kTileSize), 0.0f);
}

// The balls that a tile's rays can meet: lists go by squares around them.
void makeTileBalls(const FieldTile& tile, const TileRays& rays, double zStart, std::vector<TileBall>& balls) {
  // A ray that meets the plane of a ball's centre this far from it passes it at no less than that times the
  // cosine of its own angle with z.
  const auto steepest = [&](float slope) {
    return std::max(std::abs(slope), std::abs(slope + kTileSize * rays.pixelSize));
  };
  const float slopeX = steepest(rays.slopeX), slopeY = steepest(rays.slopeY);
  const float nearer = rays.perspective ? 1 / (1 + slopeX * slopeX + slopeY * slopeY) : 1.0f;
  constexpr float kRounding = 1e-5f;
  balls.clear();
  for (const std::uint32_t index : tile.list) {
    const BallRecord& r = tile.records[index];
    const bool fromEye = r.fromEye != 0;
    TileBall b;
    b.x = static_cast<float>(r.pixelX - rays.cornerX);
    b.y = static_cast<float>(r.pixelY - rays.cornerY);
    const float aside = outsideTile(-b.x) * r.perPixel, up = outsideTile(-b.y) * r.perPixel;
    if (!fromEye && (aside * aside + up * up) * nearer > r.support2 * (1 + kRounding)) continue;
    b.z = static_cast<float>(r.centerZ - zStart);
    b.perPixel = r.perPixel;
    b.front = static_cast<float>(static_cast<double>(r.front) - zStart);
    b.back = 2 * b.z - b.front;
    b.support2 = r.support2;
    b.inverse2 = r.inverseSupport2;
    b.coefficient = r.coefficient;
    b.record = index;
    b.fromEye = fromEye;
    balls.push_back(b);
  }
}

// Distance along the unit ray from t, in double precision: rounded once.
void storeDistances(const TileRays& rays, double zStart, TilePixels& out) {
  const double above = rays.perspective ? rays.eyeZExact - zStart : static_cast<double>(rays.nearZ) - zStart;
  for (std::size_t k = 0; k < kTilePixels; ++k) {
    if (!(out.distance[k] < std::numeric_limits<float>::infinity())) continue;
    const double x = rays.slopeXExact + static_cast<double>(rays.laneX[k]) * rays.pixelSizeExact,
                 y = rays.slopeYExact + static_cast<double>(rays.laneY[k]) * rays.pixelSizeExact;
    const double stretch = rays.perspective ? std::sqrt(x * x + y * y + 1) : 1;
    out.distance[k] = static_cast<float>(static_cast<double>(out.distance[k]) + above * stretch);
  }
}

// Where each lane of a tile comes to lie in rows.
const std::array<std::uint8_t, kTilePixels> kRowPlaces = [] {
  std::array<std::uint8_t, kTilePixels> places{};
  for (int k = 0; k < kTilePixels; ++k)
    places[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(
        lanePixelY(LaneOrder::squares, k) * kTileSize + lanePixelX(LaneOrder::squares, k));
  return places;
}();

template <typename T>
void toRows(T (&plane)[kTilePixels]) {
  T rows[kTilePixels];
  for (std::size_t k = 0; k < kTilePixels; ++k) rows[kRowPlaces[k]] = plane[k];
  std::copy_n(rows, kTilePixels, plane);
}

}  // namespace

bool castField(const FieldTile& tile, const TileRays& rays, const PlaneChannels& channels, TilePixels& out,
               FieldCounts& counts) {
  // Where the list begins, but not before the near plane.
  const float front = tile.records[tile.list.front()].front + tile.slack;
  double zStart = static_cast<double>(front < rays.nearZ ? front : rays.nearZ);
  thread_local std::vector<TileBall> balls;
  makeTileBalls(tile, rays, zStart, balls);
  if (!HWY_DYNAMIC_DISPATCH(castFieldTile)(tile, balls, rays, channels, zStart, out, counts)) return false;
  if (channels.distance) storeDistances(rays, zStart, out);
  toRows(out.depth);
  if (channels.distance) toRows(out.distance);
  if (channels.albedo) toRows(out.albedo);
  if (channels.normal) toRows(out.normal);
  if (channels.id) toRows(out.id);
  return true;
}

}  // namespace meniscus::tiles
#endif

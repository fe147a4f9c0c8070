// Vectors of rays, for each instruction set that Highway compiles the including file for. No fused
// multiply-add and no approximate reciprocal is used anywhere: every instruction set gives the same bits.
#if defined(MENISCUS_TILES_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)  // Highway's per-target include guard
#ifdef MENISCUS_TILES_LANES_INL_H
#undef MENISCUS_TILES_LANES_INL_H
#else
#define MENISCUS_TILES_LANES_INL_H
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "core/tiles/tile_rays.h"

HWY_BEFORE_NAMESPACE();
namespace meniscus::tiles::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, 16>;
using U = hn::RebindToUnsigned<F>;
using I = hn::RebindToSigned<F>;
using V = hn::Vec<F>;
using M = hn::Mask<F>;

// Lanes of a packet: vectors of a length that is known only at run time (SVE, RISC-V) are not compiled for.
constexpr std::size_t laneCount() {
  return hn::MaxLanes(F());
}
HWY_INLINE V all(float x) {
  return hn::Set(F(), x);
}

// The nearest whole number to 0 <= v < 2^23 is in the low bits of the float v + 2^23. Conversions would first
// ask for numbers out of range.
HWY_INLINE hn::Vec<I> bitsOfTwoTo23() {
  return hn::BitCast(I(), all(8388608.0f));
}
HWY_INLINE hn::Vec<I> bitsWithTwoTo23(V v) {
  return hn::BitCast(I(), v + all(8388608.0f));
}
HWY_INLINE hn::Vec<I> nearestWhole(V v) {
  return bitsWithTwoTo23(v) - bitsOfTwoTo23();
}

struct Vec3 {
  V x, y, z;
};
HWY_INLINE V dot(const Vec3& a, const Vec3& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
HWY_INLINE Vec3 sub(const Vec3& a, const Vec3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE Vec3 add(const Vec3& a, const Vec3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE Vec3 scale(const Vec3& a, V s) {
  return {a.x * s, a.y * s, a.z * s};
}
HWY_INLINE Vec3 normalized(const Vec3& a) {
  return scale(a, all(1.0f) / hn::Sqrt(dot(a, a)));
}
HWY_INLINE V mixed(V a, V b, V share) {
  return a * (all(1.0f) - share) + b * share;
}
HWY_INLINE Vec3 splat(const float (&v)[3]) {
  return {all(v[0]), all(v[1]), all(v[2])};
}
HWY_INLINE Vec3 choose(M m, const Vec3& yes, const Vec3& no) {
  return {hn::IfThenElse(m, yes.x, no.x), hn::IfThenElse(m, yes.y, no.y), hn::IfThenElse(m, yes.z, no.z)};
}

// Value for a reversed-z depth buffer (shaders/shared/projection.glsl).
HWY_INLINE V depthValue(const TileRays& rays, V z) {
  const V aboveFar = (z - all(rays.farZ)) * all(rays.depthFactor);
  return rays.perspective ? aboveFar / (all(rays.eyeZ) - z) : aboveFar;
}

// Octahedral, 16 bits each (shaders/shared/octahedral.glsl); the length of n does not matter.
HWY_INLINE hn::Vec<U> encodeNormal(const Vec3& n) {
  const F f;
  const I i;
  const V one = all(1.0f), half = all(0.5f), zero = hn::Zero(f);
  const V sum = (hn::Abs(n.x) + hn::Abs(n.y)) + hn::Abs(n.z);
  const V x = n.x / sum, y = n.y / sum;
  const V signX = hn::IfThenElse(x >= zero, one, all(-1.0f)),
          signY = hn::IfThenElse(y >= zero, one, all(-1.0f));
  const M folded = n.z < zero;
  const V u = hn::IfThenElse(folded, (one - hn::Abs(y)) * signX, x);
  const V v = hn::IfThenElse(folded, (one - hn::Abs(x)) * signY, y);
  const auto quantize = [&](V c) {
    const V share = hn::Min(hn::Max(half * c + half, zero), one);
    return hn::BitCast(U(), hn::ConvertTo(i, share * all(65535.0f) + half));
  };
  return hn::Or(quantize(u), hn::ShiftLeft<16>(quantize(v)));
}

// The unit direction of each of a tile's rays. Lanes are in the order of rays.laneX, rays.laneY.
HWY_INLINE Vec3 directionOf(const TileRays& rays, std::size_t k) {
  const F f;
  if (!rays.perspective) return {hn::Zero(f), hn::Zero(f), all(-1.0f)};
  const V sx = all(rays.slopeX) + hn::Load(f, rays.laneX + k) * all(rays.pixelSize);
  const V sy = all(rays.slopeY) + hn::Load(f, rays.laneY + k) * all(rays.pixelSize);
  const V inverse = all(1.0f) / hn::Sqrt((sx * sx + sy * sy) + all(1.0f));
  return {sx * inverse, sy * inverse, hn::Neg(inverse)};
}

}  // namespace meniscus::tiles::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

// Points, normals and nearness of vectors of pixels, by the formulas of shaders/shared/projection.glsl
// (viewPoint), octahedral.glsl and include/scene_depth.glsl.
#if defined(MENISCUS_EFFECTS_SURFACE_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MENISCUS_EFFECTS_SURFACE_LANES_INL
#undef MENISCUS_EFFECTS_SURFACE_LANES_INL
#else
#define MENISCUS_EFFECTS_SURFACE_LANES_INL
#endif

#include <algorithm>
#include <cstring>

#include "core/effects/nearness.h"
#include "core/effects/surface_planes.h"
#include "core/tiles/lanes.inl"

HWY_BEFORE_NAMESPACE();
namespace meniscus::effects::HWY_NAMESPACE {

using namespace tiles::HWY_NAMESPACE;

HWY_INLINE Vec3 xyz(const glm::vec4& v) {
  return {all(v.x), all(v.y), all(v.z)};
}

struct Surfaces {
  Vec3 point, normal;  // view space
  M there;             // not background
};

HWY_INLINE V pixelCenters(int x) {
  return hn::Iota(F(), static_cast<float>(x)) + all(0.5f);
}

// Where the rays through pixels cross the plane at unit depth (perspective), or their places [Å].
struct Slopes {
  V x, y;
};
// Of pixels of a row y of the planes; centers: in the target.
HWY_INLINE Slopes slopesAt(const SurfacePlanes& planes, V centers, int y) {
  const f32::ViewBlock& view = planes.view;
  return {(centers + all(view.tile.x - view.center.x)) * all(view.scale.x),
          all((static_cast<float>(planes.y + y) + 0.5f + view.tile.y - view.center.y) * view.scale.x)};
}
// Of the pixels (x, y), (x + 1, y), ... of the planes.
HWY_INLINE Slopes slopesAt(const SurfacePlanes& planes, int x, int y) {
  return slopesAt(planes, pixelCenters(planes.x + x), y);
}

HWY_INLINE Vec3 decodeNormals(hn::Vec<U> stored) {
  const F f;
  const U u;
  const V one = all(1.0f), zero = hn::Zero(f);
  const auto channel = [&](auto bits) {
    return hn::ConvertTo(f, hn::BitCast(I(), bits)) * all(2.0f / 65535.0f) - one;
  };
  const V nx = channel(hn::And(stored, hn::Set(u, 0xFFFFu))), ny = channel(hn::ShiftRight<16>(stored));
  const V nz = one - hn::Abs(nx) - hn::Abs(ny);
  const V fold = hn::Max(hn::Neg(nz), zero);
  const Vec3 n{nx - hn::IfThenElse(nx >= zero, fold, hn::Neg(fold)),
               ny - hn::IfThenElse(ny >= zero, fold, hn::Neg(fold)), nz};
  return normalized(n);
}

// Of the pixels from `at` on.
HWY_INLINE Vec3 normalsAt(const SurfacePlanes& planes, std::size_t at) {
  return decodeNormals(hn::LoadU(U(), planes.normal.data() + at));
}

// value, normal: as they are stored.
HWY_INLINE Surfaces surfaceOf(const SurfacePlanes& planes, V value, hn::Vec<U> normal, const Slopes& slopes) {
  const F f;
  const f32::ViewBlock& view = planes.view;
  const V one = all(1.0f), zero = hn::Zero(f), factor = all(view.depthMap.x);
  Surfaces s;
  s.there = value > zero;
  if (view.scale.z > 0.5f) {
    const float toFar = view.depth.x - view.depth.w;
    const V inverse = one / (hn::Max(value, zero) + factor);
    const V depth = all(toFar * view.depthMap.x) * inverse;
    s.point = {slopes.x * depth, slopes.y * depth, all(view.depth.w) + value * all(toFar) * inverse};
  } else {
    s.point = {slopes.x, slopes.y, all(view.depth.w) + value / factor};
  }
  s.normal = decodeNormals(normal);
  return s;
}
// Of the pixels (x, y), (x + 1, y), ... from `at` on.
HWY_INLINE Surfaces surfacesAt(const SurfacePlanes& planes, std::size_t at, int x, int y) {
  return surfaceOf(planes, hn::LoadU(F(), planes.depth.data() + at), hn::LoadU(U(), planes.normal.data() + at),
                   slopesAt(planes, x, y));
}

HWY_INLINE V nearnessOf(const Nearness& n, V depth) {
  const V along = depth * all(n.factor);
  return n.perspective ? along / (depth + all(n.added)) : along;
}

using U16 = hn::Rebind<std::uint16_t, F>;

// The first `count` lanes. What is not the planes' has no room beyond its last pixel, and another processor
// writes the next row. (No more than a vector: GCC 12 takes a count below a single lane for a negative one.)
template <typename D>
HWY_INLINE hn::Vec<D> loadSome(D d, const hn::TFromD<D>* from, std::size_t count) {
  if (count == laneCount()) return hn::LoadU(d, from);
  alignas(64) hn::TFromD<D> values[kMostLanes] = {};
  std::memcpy(values, from, sizeof(*from) * std::min(count, laneCount()));
  return hn::Load(d, values);
}
template <typename D>
HWY_INLINE void storeSome(D d, hn::Vec<D> v, std::size_t count, hn::TFromD<D>* to) {
  if (count == laneCount()) {
    hn::StoreU(v, d, to);
    return;
  }
  alignas(64) hn::TFromD<D> values[kMostLanes];
  hn::Store(v, d, values);
  std::memcpy(to, values, sizeof(*to) * std::min(count, laneCount()));
}

// As R16 stores a share.
HWY_INLINE hn::Vec<I> unorm16(V share) {
  return hn::ConvertTo(I(), share * all(65535.0f) + all(0.5f));
}
// Of the first `count` lanes.
HWY_INLINE void storeShares(V share, std::size_t count, std::uint16_t* out) {
  storeSome(U16(), hn::DemoteTo(U16(), unorm16(share)), count, out);
}

}  // namespace meniscus::effects::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

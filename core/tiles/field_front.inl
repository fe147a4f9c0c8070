// Where a tile's rays can first reach the level: what all its packets need not walk through. Slabs of depth,
// one to a lane, each with an upper bound of the field in the part of the slab that the tile's rays cross.
#if defined(MENISCUS_TILES_FIELD_FRONT_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MENISCUS_TILES_FIELD_FRONT_INL
#undef MENISCUS_TILES_FIELD_FRONT_INL
#else
#define MENISCUS_TILES_FIELD_FRONT_INL
#endif

#include <algorithm>
#include <limits>
#include <span>

#include "core/tiles/field_caster.h"
#include "core/tiles/field_kernels.inl"
#include "core/tiles/lanes.inl"

HWY_BEFORE_NAMESPACE();
namespace meniscus::tiles::HWY_NAMESPACE {
namespace {

constexpr std::size_t kSlabsAtOnce = 16;  // whatever the vectors: every instruction set finds the same slab
constexpr float kSlabsPerSupport = 8;     // measured: docs/measured/tiles.md

template <typename Kernel>
class Front {
 public:
  Front(Kernel kernel, std::span<const TileBall> balls, const TileRays& rays, float level, float largestSupport)
      : kernel_(kernel),
        balls_(balls),
        slab_(largestSupport / kSlabsPerSupport),
        twice_(2 * largestSupport),
        level_(level) {
    const float across = rays.perspective ? kTileSize * rays.pixelSize : 0.0f;
    slopeX_[0] = rays.perspective ? rays.slopeX : 0.0f;
    slopeY_[0] = rays.perspective ? rays.slopeY : 0.0f;
    slopeX_[1] = slopeX_[0] + across;
    slopeY_[1] = slopeY_[0] + across;
  }

  // The depth [Å] below the plane that balls are measured from before which no ray reaches the level: 0 if it may
  // do so at once, infinity if nowhere. `slack`: how much nearer a later ball can be than an earlier one.
  float depth(float slack) const {
    std::size_t first = 0;
    float top = 0;  // of the next slabs
    for (;;) {
      while (first < balls_.size() && balls_[first].front - twice_ > -top) ++first;
      const float begins = nextBall(first, top, slack);
      if (begins == std::numeric_limits<float>::infinity()) return begins;
      if (begins > top) top = begins;  // nothing between
      const float slab = std::max(slab_, top * kLeastSlab);
      const std::size_t reached = firstSlab(first, top, slab, slack);
      if (reached < kSlabsAtOnce) return top + static_cast<float>(reached) * slab;
      top += static_cast<float>(kSlabsAtOnce) * slab;
    }
  }

 private:
  // Where the nearest ball begins that has not ended above `top`.
  float nextBall(std::size_t first, float top, float slack) const {
    float begins = std::numeric_limits<float>::infinity();
    for (std::size_t i = first; i < balls_.size() && -(balls_[i].front + slack) < begins; ++i) {
      if (balls_[i].back <= -top) begins = std::min(begins, -balls_[i].front * (1 - kRounding));
    }
    return begins;
  }

  // The first of the slabs of this height below `top` in which the level may be reached.
  std::size_t firstSlab(std::size_t first, float top, float slab, float slack) const {
    const F f;
    const std::size_t lanes = laneCount();
    const float bottom = top + static_cast<float>(kSlabsAtOnce) * slab;
    const V zero = hn::Zero(f);
    alignas(64) float sums[kSlabsAtOnce] = {}, upper[kSlabsAtOnce], lower[kSlabsAtOnce];
    for (std::size_t k = 0; k < kSlabsAtOnce; ++k) {  // z, widened by what rounding may do to it
      const float depth = top + static_cast<float>(k) * slab, below = top + static_cast<float>(k + 1) * slab;
      upper[k] = -depth + kRounding * depth;
      lower[k] = -below - kRounding * below;
    }
    for (std::size_t i = first; i < balls_.size(); ++i) {
      const TileBall& b = balls_[i];
      if (-(b.front + slack) >= bottom) break;
      if (b.coefficient < 0 || b.back > -top) continue;
      const float left = -b.x * b.perPixel, right = (kTileSize - b.x) * b.perPixel;
      const float down = -b.y * b.perPixel, up = (kTileSize - b.y) * b.perPixel;
      const V support2 = all(b.support2 * (1 + kSpare));
      for (std::size_t k = 0; k < kSlabsAtOnce; k += lanes) {
        const V zHigh = hn::Load(f, upper + k) - all(b.z), zLow = hn::Load(f, lower + k) - all(b.z);
        const V z = hn::Max(hn::Max(zLow, hn::Neg(zHigh)), zero);
        const V x = outside(left, right, slopeX_, zLow, zHigh), y = outside(down, up, slopeY_, zLow, zHigh);
        const V w = hn::Max((support2 - (x * x + y * y) - z * z) * all(b.inverse2), zero);
        hn::Store(hn::Load(f, sums + k) + all(b.coefficient) * kernel_.value(w), f, sums + k);
      }
    }
    for (std::size_t k = 0; k < kSlabsAtOnce; ++k)
      if (!(sums[k] * (1 + kSpare) < level_)) return k;
    return kSlabsAtOnce;
  }

  // How far the tile's rays keep from a ball's centre in one direction of the screen between two depths. low,
  // high: of the tile's sides from the centre at the centre's depth.
  HWY_INLINE V outside(float low, float high, const float (&slope)[2], V zLow, V zHigh) const {
    const V below = all(low) - hn::Max(all(slope[0]) * zLow, all(slope[0]) * zHigh);
    const V above = all(high) - hn::Min(all(slope[1]) * zLow, all(slope[1]) * zHigh);
    return hn::Max(hn::Max(below, hn::Neg(above)), hn::Zero(F()));
  }

  static constexpr float kRounding = 5e-7f;  // of a depth
  static constexpr float kLeastSlab = 4e-6f;  // of a depth: more than its rounding
  static constexpr float kSpare = 1e-5f;     // of the square of a support, and of a sum

  Kernel kernel_;
  std::span<const TileBall> balls_;
  float slab_, twice_, level_;
  float slopeX_[2], slopeY_[2];
};

}  // namespace
}  // namespace meniscus::tiles::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

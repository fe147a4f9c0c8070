// Powers of shares, for vectors.
#if defined(MENISCUS_EFFECTS_POWER_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MENISCUS_EFFECTS_POWER_LANES_INL
#undef MENISCUS_EFFECTS_POWER_LANES_INL
#else
#define MENISCUS_EFFECTS_POWER_LANES_INL
#endif

#include "core/tiles/lanes.inl"

HWY_BEFORE_NAMESPACE();
namespace meniscus::effects::HWY_NAMESPACE {

using namespace tiles::HWY_NAMESPACE;

// x^exponent for 1e-30 < x <= 1 or a little more and exponent >= 0; relative error below 2e-7 (1 + |log2|) of
// the result's logarithm. Highway's own logarithm and exponential function fuse multiplications with
// additions, so that their bits depend on the instruction set.
HWY_INLINE V powerOfShare(V x, float exponent) {
  const F f;
  const I i;
  const V one = all(1.0f);
  // x = 2^e m, m between sqrt(1/2) and sqrt(2).
  const auto bits = hn::BitCast(i, x) - hn::Set(i, 0x3F3504F3);
  const auto e = hn::ShiftRight<23>(bits);
  const V m = hn::BitCast(f, hn::And(bits, hn::Set(i, 0x007FFFFF)) + hn::Set(i, 0x3F3504F3));
  // log2(m) = 2 / ln 2 artanh((m - 1) / (m + 1)).
  const V s = (m - one) / (m + one), s2 = s * s;
  const V series =
      ((all(0.32059889f) * s2 + all(0.41219858f)) * s2 + all(0.57707802f)) * s2 + all(0.96179669f);
  const V log2 = hn::ConvertTo(f, e) + (all(2.88539008f) * s + s * s2 * series);
  const V y = hn::Max(all(exponent) * log2, all(-126.0f));
  // Round to a whole number, which a float's low bits then hold.
  const V magic = all(12582912.0f), rounded = y + magic;
  const V z = (y - (rounded - magic)) * all(0.69314718f);
  const V power =
      ((((((all(1.0f / 5040) * z + all(1.0f / 720)) * z + all(1.0f / 120)) * z + all(1.0f / 24)) * z +
         all(1.0f / 6)) *
            z +
        all(0.5f)) *
           z +
       one) *
          z +
      one;
  const auto scale2 = hn::ShiftLeft<23>(hn::BitCast(i, rounded) + hn::Set(i, 127));
  return power * hn::BitCast(f, scale2);
}

}  // namespace meniscus::effects::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

// Kernels of metaballs for vectors of rays: value, slope, and one ball's polynomial on an interval as scaled
// Bernstein coefficients C(n, k) c_k, for which a product of polynomials is a plain convolution. The forms are
// those of shaders/shared/metaball.glsl.
#if defined(MENISCUS_TILES_FIELD_KERNELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MENISCUS_TILES_FIELD_KERNELS_INL
#undef MENISCUS_TILES_FIELD_KERNELS_INL
#else
#define MENISCUS_TILES_FIELD_KERNELS_INL
#endif

#include "core/metaball_field.h"
#include "core/tiles/lanes.inl"

HWY_BEFORE_NAMESPACE();
namespace meniscus::tiles::HWY_NAMESPACE {

inline constexpr int kMostDegree = 2 * kMostKernelExponent;

/// w on an interval: its three Bernstein coefficients, the middle one doubled (scaled form).
struct Quadratic {
  V w0, w1, w2;
};

/// Polynomial coefficients, a vector each.
struct Coefficients {
  alignas(64) float c[(kMostDegree + 1) * laneCount()];
  HWY_INLINE V get(int k) const { return hn::Load(F(), c + static_cast<std::size_t>(k) * laneCount()); }
  HWY_INLINE void set(int k, V v) { hn::Store(v, F(), c + static_cast<std::size_t>(k) * laneCount()); }
  HWY_INLINE void add(int k, V v) { set(k, get(k) + v); }
};

struct QuarticKernel {
  int exponent;
  HWY_INLINE int degree() const { return 4; }
  HWY_INLINE V value(V w) const { return w * w; }
  HWY_INLINE V slope(V w) const { return w + w; }
  HWY_INLINE void addPiece(const Quadratic& w, V q, Coefficients& out) const {
    const V two = all(2.0f);
    out.add(0, q * (w.w0 * w.w0));
    out.add(1, q * (two * (w.w0 * w.w1)));
    out.add(2, q * (two * (w.w0 * w.w2) + w.w1 * w.w1));
    out.add(3, q * (two * (w.w1 * w.w2)));
    out.add(4, q * (w.w2 * w.w2));
  }
};

struct SexticKernel {
  int exponent;
  HWY_INLINE int degree() const { return 6; }
  HWY_INLINE V value(V w) const { return (w * w) * (all(5.0f / 9) + all(4.0f / 9) * w); }
  HWY_INLINE V slope(V w) const { return w * (all(10.0f / 9) + all(12.0f / 9) * w); }
  // w^2 times 5/9 (1, 2, 1) + 4/9 (w0, w1, w2): the first raises the degree.
  HWY_INLINE void addPiece(const Quadratic& w, V q, Coefficients& out) const {
    const V two = all(2.0f), five = q * all(5.0f / 9), four = q * all(4.0f / 9);
    const V q0 = w.w0 * w.w0, q1 = two * (w.w0 * w.w1), q2 = two * (w.w0 * w.w2) + w.w1 * w.w1,
            q3 = two * (w.w1 * w.w2), q4 = w.w2 * w.w2;
    const V l0 = five + four * w.w0, l1 = (five + five) + four * w.w1, l2 = five + four * w.w2;
    out.add(0, q0 * l0);
    out.add(1, q0 * l1 + q1 * l0);
    out.add(2, (q0 * l2 + q1 * l1) + q2 * l0);
    out.add(3, (q1 * l2 + q2 * l1) + q3 * l0);
    out.add(4, (q2 * l2 + q3 * l1) + q4 * l0);
    out.add(5, q3 * l2 + q4 * l1);
    out.add(6, q4 * l2);
  }
};

struct PowerKernel {
  int exponent;
  HWY_INLINE int degree() const { return 2 * exponent; }
  HWY_INLINE V power(V w, int n) const {
    V product = w;
    for (int i = 1; i < n; ++i) product = product * w;
    return product;
  }
  HWY_INLINE V value(V w) const { return power(w, exponent); }
  HWY_INLINE V slope(V w) const { return all(static_cast<float>(exponent)) * power(w, exponent - 1); }
  HWY_INLINE void addPiece(const Quadratic& w, V q, Coefficients& out) const {
    Coefficients p;
    p.set(0, w.w0);
    p.set(1, w.w1);
    p.set(2, w.w2);
    for (int n = 2; n <= exponent; ++n) {
      for (int k = 2 * n; k >= 0; --k) {
        V sum = k <= 2 * n - 2 ? p.get(k) * w.w0 : hn::Zero(F());
        if (k >= 1 && k <= 2 * n - 1) sum = sum + p.get(k - 1) * w.w1;
        if (k >= 2) sum = sum + p.get(k - 2) * w.w2;
        p.set(k, sum);
      }
    }
    for (int k = 0; k <= degree(); ++k) out.add(k, q * p.get(k));
  }
};

}  // namespace meniscus::tiles::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

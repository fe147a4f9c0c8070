// Roots that lie alone between two points of their rays: of two packets at once, because a step of the root finder
// waits for its divisions.
#if defined(MENISCUS_TILES_FIELD_ROOTS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MENISCUS_TILES_FIELD_ROOTS_INL
#undef MENISCUS_TILES_FIELD_ROOTS_INL
#else
#define MENISCUS_TILES_FIELD_ROOTS_INL
#endif

#include "core/tiles/field_caster.h"
#include "core/tiles/field_kernels.inl"
#include "core/tiles/lanes.inl"

HWY_BEFORE_NAMESPACE();
namespace meniscus::tiles::HWY_NAMESPACE {
namespace {

constexpr int kMostIterations = 64;   // of the root finder: halving alone needs 24
constexpr float kRounding = 6e-8f;    // of the level
constexpr std::size_t kInterleaved = 2;  // packets

// Absolute, of parameters [Å].
HWY_INLINE float toleranceOf(const FieldTile& tile) {
  return static_cast<float>(2e-7 * tile.largestSupport);
}

// A packet's rays whose root lies alone between now and next, and their polynomials there.
struct Brackets {
  M found;
  V now, next;
  Coefficients polynomial;
  void clear(int degree) {
    found = hn::MaskFromVec(hn::Zero(F()));
    now = hn::Zero(F());
    next = all(1.0f);
    for (int k = 0; k <= degree; ++k) polynomial.set(k, all(k == 0 ? -1.0f : 1.0f));
  }
};

// The polynomial at u, by Horner's rule for scaled Bernstein coefficients.
template <typename Kernel>
HWY_INLINE V polynomialAt(Kernel kernel, const Coefficients& polynomial, V u) {
  const V v = all(1.0f) - u;
  V power = v;
  V sum = polynomial.get(kernel.degree());
  for (int k = kernel.degree() - 1; k >= 0; --k) {
    sum = sum * u + polynomial.get(k) * power;
    power = power * v;
  }
  return sum;
}

// The root in [0, 1] of polynomials that are negative at 0 and positive at 1: secants within a bracket, the
// weight of an end that stays reduced (Anderson and Björck 1973, doi 10.1007/BF01951936), and a halving
// wherever the bracket has not shrunk to half in two steps.
template <typename Kernel>
class RootFinder {
 public:
  RootFinder(Kernel kernel, const Brackets& brackets, float tolerance, float level)
      : kernel_(kernel), brackets_(brackets), tiny_(kRounding * level) {
    const V zero = hn::Zero(F());
    low_ = zero;
    high_ = all(1.0f);
    valueLow_ = atLow_ = brackets.polynomial.get(0);
    valueHigh_ = atHigh_ = brackets.polynomial.get(kernel.degree());
    least_ = hn::Max(all(tolerance), hn::Max(hn::Abs(brackets.now), hn::Abs(brackets.next)) * all(1.2e-7f)) /
             (brackets.next - brackets.now);
    last_ = before_ = all(4.0f);
    active_ = brackets.found;
    lastAbove_ = known_ = hn::MaskFromVec(zero);
  }

  M active() const { return active_; }

  HWY_INLINE void step() {
    const V zero = hn::Zero(F()), half = all(0.5f);
    const V span = high_ - low_;
    const M slow = span > half * before_;
    V u = low_ - atLow_ * (span / (atHigh_ - atLow_));
    const V middle = low_ + half * span;
    // Outside, or not a number (both ends zero).
    u = hn::IfThenElse(hn::And(u > low_, u < high_), u, middle);
    u = hn::IfThenElse(slow, middle, u);
    // Not nearer to an end than the tolerance: an end that is the root, nearly, is closed in by one step,
    // and a secant that creeps along a steep field does not pass for one that has arrived.
    const V least = hn::Min(least_, half * span);
    u = hn::Min(hn::Max(u, low_ + least), high_ - least);
    const V value = polynomialAt(kernel_, brackets_.polynomial, u);
    const M above = value > zero;
    const M up = hn::And(active_, above), down = hn::AndNot(above, active_);
    before_ = last_;
    last_ = span;
    high_ = hn::IfThenElse(up, u, high_);
    low_ = hn::IfThenElse(down, u, low_);
    // The end that stays weighs less if it stayed before: by how much the value at the other end has fallen.
    const V left = all(1.0f) - value / hn::IfThenElse(above, atHigh_, atLow_);
    const M again = hn::AndNot(hn::Xor(above, lastAbove_), known_);
    const V weight = hn::IfThenElse(again, hn::IfThenElse(left > zero, left, half), all(1.0f));
    atLow_ = hn::IfThenElse(down, value, hn::IfThenElse(up, atLow_ * weight, atLow_));
    atHigh_ = hn::IfThenElse(up, value, hn::IfThenElse(down, atHigh_ * weight, atHigh_));
    valueLow_ = hn::IfThenElse(down, value, valueLow_);
    valueHigh_ = hn::IfThenElse(up, value, valueHigh_);
    lastAbove_ = above;
    known_ = brackets_.found;
    active_ = hn::And(active_, hn::And(hn::Abs(value) > all(tiny_), high_ - low_ > all(1.5f) * least_));
  }

  // Parameters of the roots. Within a bracket as narrow as the tolerance the field is straight; a wider one has
  // its root at an end.
  V roots() const {
    V root = low_ - valueLow_ * ((high_ - low_) / (valueHigh_ - valueLow_));
    root = hn::IfThenElse(hn::And(root >= low_, root <= high_), root, low_ + all(0.5f) * (high_ - low_));
    const V nearer = hn::IfThenElse(hn::Abs(valueLow_) < hn::Abs(valueHigh_), low_, high_);
    root = hn::IfThenElse(high_ - low_ > all(1.5f) * least_, nearer, root);
    return brackets_.now + root * (brackets_.next - brackets_.now);
  }

 private:
  Kernel kernel_;
  const Brackets& brackets_;
  float tiny_;
  V low_, high_, atLow_, atHigh_;
  V valueLow_, valueHigh_;  // without the weights
  V least_;
  V before_, last_;  // width of the bracket two steps ago, and one
  M active_, lastAbove_, known_;
};

// Narrows the brackets of a tile's packets, whose number is a multiple of kInterleaved, to their roots, in `hits`.
template <typename Kernel>
void solve(Kernel kernel, const Brackets* brackets, std::size_t packets, float tolerance, float level, V* hits,
           FieldCounts& counts) {
  static_assert(kInterleaved == 2);
  const F f;
  for (std::size_t k = 0; k < packets; k += kInterleaved) {
    if (hn::AllFalse(f, hn::Or(brackets[k].found, brackets[k + 1].found))) continue;
    RootFinder<Kernel> a(kernel, brackets[k], tolerance, level), b(kernel, brackets[k + 1], tolerance, level);
    std::uint64_t most = 0;
    for (int i = 0; i < kMostIterations && !hn::AllFalse(f, hn::Or(a.active(), b.active())); ++i) {
      counts.iterations += hn::CountTrue(f, a.active()) + hn::CountTrue(f, b.active());
      ++most;
      a.step();
      b.step();
    }
    counts.notConverged += hn::CountTrue(f, a.active()) + hn::CountTrue(f, b.active());
    if (most > counts.mostIterations) counts.mostIterations = most;
    hits[k] = hn::IfThenElse(brackets[k].found, a.roots(), hits[k]);
    hits[k + 1] = hn::IfThenElse(brackets[k + 1].found, b.roots(), hits[k + 1]);
  }
}

}  // namespace
}  // namespace meniscus::tiles::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

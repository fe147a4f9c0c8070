// One packet of rays on its way through a tile's list: the chords that its rays are in, the intervals between
// entries and exits, bounds, polynomials and their roots (field_caster.cpp says why that finds the first one).
#if defined(MENISCUS_TILES_FIELD_WALK_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MENISCUS_TILES_FIELD_WALK_INL
#undef MENISCUS_TILES_FIELD_WALK_INL
#else
#define MENISCUS_TILES_FIELD_WALK_INL
#endif

#include <limits>

#include "core/tiles/field_caster.h"
#include "core/tiles/field_kernels.inl"
#include "core/tiles/lanes.inl"

HWY_BEFORE_NAMESPACE();
namespace meniscus::tiles::HWY_NAMESPACE {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
constexpr int kMostIterations = 64;  // of the root finder: halving alone needs 24

// Where a packet of rays begins, in its tile's frame: t = 0 on the plane z = zStart of view space.
struct Packet {
  Vec3 direction;
  V inverseZ;  // 1 / direction.z
  V laneX, laneY;
  double zStart;
  float eyeT;  // z of the eye above zStart
};

struct Point {
  Vec3 position;  // of a ray, relative to a ball's centre
  V t;
};

HWY_INLINE Point pointNear(const BallRecord& b, const TileRays& rays, const Packet& p) {
  if (b.fromEye != 0) return {{all(-b.centerX), all(-b.centerY), all(b.eyeAbove)}, all(p.eyeT) * p.inverseZ};
  const auto x0 = static_cast<float>(b.pixelX - rays.cornerX),
             y0 = static_cast<float>(b.pixelY - rays.cornerY);
  return {{all(b.perPixel) * (p.laneX - all(x0)), all(b.perPixel) * (p.laneY - all(y0)), hn::Zero(F())},
          all(static_cast<float>(b.centerZ - p.zStart)) * p.inverseZ};
}

// Where a ray is nearest to a ball's centre, and the square of half its chord in the ball of this squared
// radius (negative: none).
HWY_INLINE void chordOf(const BallRecord& b, const TileRays& rays, const Packet& p, float radius2, V& middle,
                        V& half2) {
  const Point point = pointNear(b, rays, p);
  const V along = dot(point.position, p.direction);
  const Vec3 nearest = sub(point.position, scale(p.direction, along));
  half2 = all(radius2) - dot(nearest, nearest);
  middle = point.t - along;
}

template <typename Kernel>
class Walk {
 public:
  Walk(Kernel kernel, const FieldTile& tile, const TileRays& rays, const Packet& packet, ChordWindow& window,
       FieldCounts& counts)
      : kernel_(kernel),
        tile_(tile),
        rays_(rays),
        packet_(packet),
        window_(window),
        counts_(counts),
        level_(static_cast<float>(tile.field->level)),
        tolerance_(static_cast<float>(2e-7 * tile.largestSupport)),
        waitingNow_(hn::Zero(F())),
        waitingNext_(all(1.0f)) {
    for (int k = 0; k <= kernel.degree(); ++k) waiting_.set(k, all(k == 0 ? -1.0f : 1.0f));
  }

  // Parameters of the hits, infinity where there is none; inside: rays that began inside. False if the list
  // does not do for these.
  bool firstRoots(V& hitOut, M& insideOut) {
    const F f;
    const V far = all(kFar);
    V hit = far;
    now_ = all(static_cast<float>(static_cast<double>(rays_.nearZ) - packet_.zStart)) * packet_.inverseZ;
    next_ = far;
    live_ = hn::Not(hn::MaskFromVec(hn::Zero(f)));
    inside_ = bracketed_ = hn::MaskFromVec(hn::Zero(f));
    bool atStart = true;
    for (;;) {
      load();
      live_ = hn::And(live_, next_ < far);
      if (hn::AllFalse(f, live_)) break;
      if (atStart) {
        counts_.rays += hn::CountTrue(f, live_);
        inside_ = hn::And(live_, fieldAtStart() > hn::Zero(f));
        atStart = false;
        if (tile_.cut && !hn::AllFalse(f, inside_)) return false;
      }
      M candidates = hn::And(live_, hn::Or(inside_, boundOnInterval() > all(level_)));
      while (!hn::AllFalse(f, candidates)) candidates = lookInto(candidates, hit);
      if (hn::AllFalse(f, live_)) break;
      advance();
    }
    if (!hn::AllFalse(f, bracketed_)) hit = hn::IfThenElse(bracketed_, solveBracketed(), hit);
    insideOut = inside_;
    hitOut = hit;
    return true;
  }

 private:
  HWY_INLINE V chord(const float* array, std::size_t i) const {
    return hn::Load(F(), array + i * laneCount());
  }
  // The next entry or exit after `now` of a chord.
  HWY_INLINE V eventAfter(V now, V enter, V leave) const {
    return hn::IfThenElse(enter > now, enter, hn::IfThenElse(leave > now, leave, all(kFar)));
  }

  // Takes from the list what can begin before the next event of any ray.
  void load() {
    const F f;
    bool changed = true;
    float lowest = 0;
    for (; taken_ < tile_.list.size(); ++taken_) {
      if (changed) {  // z of the farthest next event
        const V z = hn::IfThenElse(live_, packet_.direction.z * next_, all(kFar));
        lowest = static_cast<float>(packet_.zStart) + hn::GetLane(hn::MinOfLanes(f, z));
        changed = false;
      }
      const BallRecord& b = tile_.records[tile_.list[taken_]];
      if (b.front + tile_.slack <= lowest) break;
      V middle, half2;
      chordOf(b, rays_, packet_, b.support2, middle, half2);
      const M met = hn::And(half2 > hn::Zero(f), live_);
      if (hn::AllFalse(f, met)) continue;
      const V half = hn::Sqrt(hn::Max(half2, hn::Zero(f)));
      const V enter = hn::IfThenElse(met, middle - half, all(kFar)),
              leave = hn::IfThenElse(met, middle + half, all(-kFar));
      if (hn::AllFalse(f, leave > now_)) continue;
      if (count_ == window_.capacity) {
        window_.grow();
        ++counts_.windowGrowths;
      }
      const std::size_t at = count_ * laneCount();
      hn::Store(middle, f, window_.middle + at);
      hn::Store(half2, f, window_.half2 + at);
      hn::Store(enter, f, window_.enter + at);
      hn::Store(leave, f, window_.leave + at);
      window_.inverse2[count_] = b.inverseSupport2;
      window_.coefficient[count_] = b.coefficient;
      window_.record[count_] = tile_.list[taken_];
      ++count_;
      next_ = hn::Min(next_, eventAfter(now_, enter, leave));
      changed = true;
    }
  }

  // F where the rays begin, less than 0 where no support is.
  V fieldAtStart() const {
    const F f;
    V sum = all(-level_);
    for (std::size_t i = 0; i < count_; ++i) {
      const V t = now_ - chord(window_.middle, i);
      const V w = (chord(window_.half2, i) - t * t) * all(window_.inverse2[i]);
      const M in = hn::And(chord(window_.enter, i) <= now_, chord(window_.leave, i) >= now_);
      if (hn::AllFalse(f, in)) continue;
      sum =
          sum + hn::IfThenElseZero(in, all(window_.coefficient[i]) * kernel_.value(hn::Max(w, hn::Zero(f))));
    }
    return sum;
  }

  // An upper bound of the sum of all q f on [now, next]: each ball at its nearest point; what takes away
  // counts nothing.
  HWY_INLINE V boundOnInterval() {
    const F f;
    counts_.intervals += hn::CountTrue(f, live_);
    const V zero = hn::Zero(f);
    V sum = zero;
    for (std::size_t i = 0; i < count_; ++i) {
      if (window_.coefficient[i] < 0) continue;
      const V middle = chord(window_.middle, i);
      const V t = hn::Min(hn::Max(middle, now_), next_) - middle;
      const V w = hn::Max((chord(window_.half2, i) - t * t) * all(window_.inverse2[i]), zero);
      sum = sum + all(window_.coefficient[i]) * kernel_.value(w);
    }
    return sum * all(1.000002f);  // rounding must not make it less than the polynomial
  }

  // Writes down the polynomials of [now, next] of the candidates, negated where the ray began inside. Returns
  // those for which it is that of one ball.
  M writePieces(M candidates) {
    const F f;
    const V zero = hn::Zero(f);
    counts_.pieces += hn::CountTrue(f, candidates);
    const int n = kernel_.degree();
    double binomial = 1;
    for (int k = 0; k <= n; ++k) {
      polynomial_.set(k, all(static_cast<float>(-static_cast<double>(level_) * binomial)));
      binomial = binomial * (n - k) / (k + 1);
    }
    V balls = zero;
    for (std::size_t i = 0; i < count_; ++i) {
      const M covers = hn::And(coversInterval(i), candidates);
      if (hn::AllFalse(f, covers)) continue;
      balls = balls + hn::IfThenElseZero(covers, all(1.0f));
      const V middle = chord(window_.middle, i), half2 = chord(window_.half2, i);
      const V inverse2 = hn::IfThenElseZero(covers, all(window_.inverse2[i]));
      const V a = now_ - middle, b = next_ - middle;
      const V w1 = hn::Max((half2 - a * b) * inverse2, zero);
      kernel_.addPiece(
          {hn::Max((half2 - a * a) * inverse2, zero), w1 + w1, hn::Max((half2 - b * b) * inverse2, zero)},
          all(window_.coefficient[i]), polynomial_);
    }
    for (int k = 0; k <= n && !hn::AllFalse(f, inside_); ++k) {
      const V c = polynomial_.get(k);
      polynomial_.set(k, hn::IfThenElse(inside_, hn::Neg(c), c));
    }
    return hn::And(candidates, balls == all(1.0f));
  }

  // A chord covers the interval or lies outside of it: its ends are among the events.
  HWY_INLINE M coversInterval(std::size_t i) const {
    return hn::And(chord(window_.enter, i) <= now_, chord(window_.leave, i) >= next_);
  }

  // Of a ball alone the surface is its core, a sphere, met exactly however close the level is to the most
  // that the ball reaches: there the field is too flat for a polynomial in float32.
  void meetCores(M lone, V& hit) {
    const F f;
    for (std::size_t i = 0; i < count_ && !hn::AllFalse(f, lone); ++i) {
      const M here = hn::And(lone, coversInterval(i));
      if (hn::AllFalse(f, here)) continue;
      lone = hn::AndNot(here, lone);
      const BallRecord& b = tile_.records[window_.record[i]];
      V middle, half2;
      chordOf(b, rays_, packet_, b.core2, middle, half2);
      const M met = half2 > hn::Zero(f);
      const V half = hn::Sqrt(hn::Max(half2, hn::Zero(f)));
      const V enter = hn::IfThenElse(met, middle - half, all(kFar)),
              leave = hn::IfThenElse(met, middle + half, all(-kFar));
      // A sign that has changed by `now` is a crossing there: rounding opens no cracks.
      const M within = hn::And(enter < now_, leave > now_);
      const M comesIn = hn::AndNot(inside_, hn::And(enter < next_, leave > now_));
      const M goesOut = hn::And(inside_, hn::Or(hn::Not(within), leave < next_));
      const M crossed = hn::And(here, hn::Or(comesIn, goesOut));
      const V at = hn::IfThenElse(inside_, hn::IfThenElse(within, leave, now_), hn::Max(enter, now_));
      hit = hn::IfThenElse(crossed, at, hit);
      live_ = hn::AndNot(crossed, live_);
    }
  }

  // Looks for the first root of the candidates on [now, next]. Returns those whose interval was halved: next
  // is now its middle.
  M lookInto(M candidates, V& hit) {
    const F f;
    const V zero = hn::Zero(f);
    const M lone = writePieces(candidates);
    if (!hn::AllFalse(f, lone)) meetCores(lone, hit);
    candidates = hn::AndNot(lone, candidates);
    if (hn::AllFalse(f, candidates)) return candidates;
    const int n = kernel_.degree();
    // Signs of the coefficients, zero counting as negative.
    M positive = polynomial_.get(0) > zero;
    const M startsAbove = hn::And(candidates, positive);  // between two intervals, by rounding
    M anyPositive = positive;
    V changes = zero;
    for (int k = 1; k <= n; ++k) {
      const M now = polynomial_.get(k) > zero;
      changes = changes + hn::IfThenElseZero(hn::Xor(now, positive), all(1.0f));
      anyPositive = hn::Or(anyPositive, now);
      positive = now;
    }
    const M endsAbove = positive;
    M open = hn::AndNot(startsAbove, hn::And(candidates, anyPositive));
    hit = hn::IfThenElse(startsAbove, now_, hit);
    live_ = hn::AndNot(startsAbove, live_);
    const M single = hn::And(open, changes < all(1.5f));
    if (!hn::AllFalse(f, single)) postpone(single);
    const M several = hn::AndNot(single, open);
    if (hn::AllFalse(f, several)) return several;
    // Two roots nearer than the tolerance cannot be told apart: what counts is the sign at the end.
    const V middle = now_ + all(0.5f) * (next_ - now_);
    const M wide = hn::And(next_ - now_ > all(tolerance_), hn::And(middle > now_, middle < next_));
    const M narrow = hn::AndNot(wide, several);
    counts_.grazing += hn::CountTrue(f, narrow);
    const M crossed = hn::And(narrow, endsAbove);
    hit = hn::IfThenElse(crossed, next_, hit);
    live_ = hn::AndNot(crossed, live_);
    const M halved = hn::And(several, wide);
    counts_.splits += hn::CountTrue(f, halved);
    next_ = hn::IfThenElse(halved, middle, next_);
    return halved;
  }

  // Rays of a packet enter the surface on different intervals: each ray's polynomial waits until all have one,
  // so that the root finder runs once, and not once for every few of them.
  HWY_INLINE void postpone(M single) {
    for (int k = 0; k <= kernel_.degree(); ++k)
      waiting_.set(k, hn::IfThenElse(single, polynomial_.get(k), waiting_.get(k)));
    waitingNow_ = hn::IfThenElse(single, now_, waitingNow_);
    waitingNext_ = hn::IfThenElse(single, next_, waitingNext_);
    bracketed_ = hn::Or(bracketed_, single);
    live_ = hn::AndNot(single, live_);
  }

  HWY_INLINE V solveBracketed() {
    for (int k = 0; k <= kernel_.degree(); ++k) polynomial_.set(k, waiting_.get(k));
    now_ = waitingNow_;
    next_ = waitingNext_;
    return now_ + solve(bracketed_) * (next_ - now_);
  }

  // The polynomial at u, by Horner's rule for scaled Bernstein coefficients.
  HWY_INLINE V polynomialAt(V u) const {
    const V v = all(1.0f) - u;
    V power = v;
    V sum = polynomial_.get(kernel_.degree());
    for (int k = kernel_.degree() - 1; k >= 0; --k) {
      sum = sum * u + polynomial_.get(k) * power;
      power = power * v;
    }
    return sum;
  }

  // The root in [0, 1] of polynomials that are negative at 0 and positive at 1: secants within a bracket, the
  // weight of an end that stays reduced (Anderson and Björck 1973, doi 10.1007/BF01951936), and a halving
  // wherever the bracket has not shrunk to half in two steps.
  V solve(M wanted) {
    const F f;
    const V zero = hn::Zero(f), half = all(0.5f);
    V low = zero, high = all(1.0f), atLow = polynomial_.get(0), atHigh = polynomial_.get(kernel_.degree());
    V valueLow = atLow, valueHigh = atHigh;  // without the weights
    const V width = next_ - now_;
    const V least = hn::Max(all(tolerance_), hn::Max(hn::Abs(now_), hn::Abs(next_)) * all(1.2e-7f)) / width;
    V before = all(4.0f);  // width of the bracket two steps ago
    V last = before;
    M active = wanted, lastUp = hn::MaskFromVec(zero), lastDown = lastUp;
    std::uint64_t most = 0;
    for (int i = 0; i < kMostIterations && !hn::AllFalse(f, active); ++i) {
      counts_.iterations += hn::CountTrue(f, active);
      ++most;
      const V span = high - low;
      const M slow = span > half * before;
      V u = low - atLow * (span / (atHigh - atLow));
      const V middle = low + half * span;
      // Outside, or not a number (both ends zero).
      u = hn::IfThenElse(hn::And(u > low, u < high), u, middle);
      u = hn::IfThenElse(slow, middle, u);
      // Not nearer to an end than the tolerance: an end that is the root, nearly, is closed in by one step,
      // and a secant that creeps along a steep field does not pass for one that has arrived.
      const V step = hn::Min(least, half * span);
      u = hn::Min(hn::Max(u, low + step), high - step);
      const V value = polynomialAt(u);
      const M above = value > zero;
      const M up = hn::And(active, above), down = hn::AndNot(above, active);
      before = last;
      last = span;
      high = hn::IfThenElse(up, u, high);
      low = hn::IfThenElse(down, u, low);
      // The end that stays weighs less if it stayed before: by how much the value at the other end has
      // fallen.
      const auto weight = [&](V old) {
        const V left = all(1.0f) - value / old;
        return hn::IfThenElse(left > zero, left, half);
      };
      const V lowWeight = hn::IfThenElse(lastUp, weight(atHigh), all(1.0f)),
              highWeight = hn::IfThenElse(lastDown, weight(atLow), all(1.0f));
      const V newLow = hn::IfThenElse(down, value, hn::IfThenElse(up, atLow * lowWeight, atLow));
      atHigh = hn::IfThenElse(up, value, hn::IfThenElse(down, atHigh * highWeight, atHigh));
      atLow = newLow;
      valueLow = hn::IfThenElse(down, value, valueLow);
      valueHigh = hn::IfThenElse(up, value, valueHigh);
      lastUp = above;
      lastDown = hn::Not(above);
      active =
          hn::And(active, hn::And(hn::Abs(value) > all(kRounding * level_), high - low > all(1.5f) * least));
    }
    counts_.notConverged += hn::CountTrue(f, active);
    if (most > counts_.mostIterations) counts_.mostIterations = most;
    // Within a bracket as narrow as the tolerance the field is straight; a wider one has its root at an end.
    V root = low - valueLow * ((high - low) / (valueHigh - valueLow));
    root = hn::IfThenElse(hn::And(root >= low, root <= high), root, low + half * (high - low));
    const V nearer = hn::IfThenElse(hn::Abs(valueLow) < hn::Abs(valueHigh), low, high);
    return hn::IfThenElse(high - low > all(1.5f) * least, nearer, root);
  }

  // To the next event; drops the chords that every ray has left.
  void advance() {
    const F f;
    now_ = hn::IfThenElse(live_, next_, now_);
    next_ = all(kFar);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const V leave = chord(window_.leave, i);
      if (hn::AllFalse(f, hn::And(live_, leave > now_))) continue;
      const V enter = chord(window_.enter, i);
      next_ = hn::Min(next_, eventAfter(now_, enter, leave));
      if (kept != i) {
        const std::size_t to = kept * laneCount();
        hn::Store(chord(window_.middle, i), f, window_.middle + to);
        hn::Store(chord(window_.half2, i), f, window_.half2 + to);
        hn::Store(enter, f, window_.enter + to);
        hn::Store(leave, f, window_.leave + to);
        window_.inverse2[kept] = window_.inverse2[i];
        window_.coefficient[kept] = window_.coefficient[i];
        window_.record[kept] = window_.record[i];
      }
      ++kept;
    }
    count_ = kept;
  }

  static constexpr float kRounding = 6e-8f;

  Kernel kernel_;
  const FieldTile& tile_;
  const TileRays& rays_;
  const Packet& packet_;
  ChordWindow& window_;
  FieldCounts& counts_;
  float level_, tolerance_;
  std::size_t taken_ = 0, count_ = 0;  // of the list; of the window
  V now_, next_;                       // the interval that is looked at
  M live_, inside_;
  Coefficients polynomial_;
  M bracketed_;  // rays whose root lies alone between waitingNow_ and waitingNext_
  V waitingNow_, waitingNext_;
  Coefficients waiting_;
};

}  // namespace
}  // namespace meniscus::tiles::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

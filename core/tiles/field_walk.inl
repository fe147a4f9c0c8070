// One packet of rays on its way through a tile's list: the chords that its rays are in, the intervals between
// entries and exits, bounds, polynomials and their roots (field_caster.cpp says why that finds the first one).
#if defined(MENISCUS_TILES_FIELD_WALK_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MENISCUS_TILES_FIELD_WALK_INL
#undef MENISCUS_TILES_FIELD_WALK_INL
#else
#define MENISCUS_TILES_FIELD_WALK_INL
#endif

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "core/tiles/field_caster.h"
#include "core/tiles/field_kernels.inl"
#include "core/tiles/field_roots.inl"
#include "core/tiles/lanes.inl"

HWY_BEFORE_NAMESPACE();
namespace meniscus::tiles::HWY_NAMESPACE {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();
// Steps that a ray waits for those beside it: it keeps the chords that they pass meanwhile.
constexpr int kPatience = 16;
// From so many chords on, rays try to pass many entries and exits at once.
constexpr std::size_t kManyChords = 64;

// A packet of rays in its tile's frame: t = 0 on the plane that the tile's balls are measured from.
struct Packet {
  Vec3 direction;
  V inverseZ;  // 1 / direction.z
  V laneX, laneY;
  float eyeZ;   // of the eye above that plane
  float nearZ;  // of the near plane
};

// What a tile's packets walk through.
struct Balls {
  std::span<const TileBall> list;
  float slack;  // how much nearer a later one can be than an earlier one
  bool atPlane;  // whether the rays begin on the plane, and outside; otherwise they begin at the near plane
};

struct Point {
  Vec3 position;  // of a ray, relative to a ball's centre
  V t;
};

HWY_INLINE Point pointNear(const TileBall& b, const FieldTile& tile, const Packet& p) {
  if (b.fromEye) {
    const BallRecord& r = tile.records[b.record];
    return {{all(-r.centerX), all(-r.centerY), all(r.eyeAbove)}, all(p.eyeZ) * p.inverseZ};
  }
  return {{all(b.perPixel) * (p.laneX - all(b.x)), all(b.perPixel) * (p.laneY - all(b.y)), hn::Zero(F())},
          all(b.z) * p.inverseZ};
}

// Where a ray is nearest to a ball's centre, and the square of half its chord in the ball of this squared
// radius (negative: none).
HWY_INLINE void chordOf(const TileBall& b, const FieldTile& tile, const Packet& p, float radius2, V& middle,
                        V& half2) {
  const Point point = pointNear(b, tile, p);
  const V along = dot(point.position, p.direction);
  const Vec3 nearest = sub(point.position, scale(p.direction, along));
  half2 = all(radius2) - dot(nearest, nearest);
  middle = point.t - along;
}

template <typename Kernel>
class Walk {
 public:
  Walk(Kernel kernel, const FieldTile& tile, const Balls& balls, const Packet& packet, ChordWindow& window,
       Brackets& brackets, FieldCounts& counts)
      : kernel_(kernel),
        tile_(tile),
        balls_(balls),
        packet_(packet),
        window_(window),
        brackets_(brackets),
        counts_(counts),
        level_(static_cast<float>(tile.field->level)),
        tolerance_(toleranceOf(tile)),
        stretch_(all(static_cast<float>(tile.largestSupport))) {
    brackets.clear(kernel.degree());
  }

  // Parameters of the hits, infinity where there is none or where a root lies alone in a bracket that solve() is to
  // narrow; inside: rays that began inside. False if the list does not do for these.
  bool firstRoots(V& hitOut, M& insideOut) {
    const F f;
    const V far = all(kFar);
    V hit = far;
    now_ = balls_.atPlane ? hn::Zero(f) : all(packet_.nearZ) * packet_.inverseZ;
    next_ = far;
    live_ = hn::Not(hn::MaskFromVec(hn::Zero(f)));
    inside_ = hn::MaskFromVec(hn::Zero(f));
    bool atStart = true;
    M stopped = inside_;  // rays that wait on an interval that may hold a root until all others do
    int waited = 0;
    for (;;) {
      if (!findNext()) break;
      if (atStart) {
        counts_.rays += hn::CountTrue(f, live_);
        if (!balls_.atPlane) inside_ = hn::And(live_, fieldAtStart() > hn::Zero(f));
        atStart = false;
        if (tile_.cut && !hn::AllFalse(f, inside_)) return false;
      }
      if (count_ >= kManyChords) {
        passMany(hn::AndNot(stopped, live_));
        if (!findNext()) break;
      }
      const M looked = hn::AndNot(stopped, live_);
      counts_.intervals += hn::CountTrue(f, looked);
      stopped = hn::Or(stopped, hn::And(looked, hn::Or(inside_, boundOnInterval() > all(level_))));
      const M moving = hn::AndNot(stopped, live_);
      if (!hn::AllFalse(f, moving) && (hn::AllFalse(f, stopped) || ++waited <= kPatience)) {
        advance(moving, next_);
        continue;
      }
      waited = 0;
      counts_.mostChords = std::max(counts_.mostChords, std::uint64_t{count_});
      while (!hn::AllFalse(f, stopped)) stopped = lookInto(stopped, hit);
      if (hn::AllFalse(f, live_)) break;
      advance(live_, next_);
    }
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

  // Takes from the list what can begin before end() of any ray; to be asked again after each ball.
  template <typename End>
  void load(End end) {
    const F f;
    const auto zOfEnd = [&] {  // from which on a ball may begin before that
      return hn::IfThenElse(live_, packet_.direction.z * end(), all(kFar)) - all(balls_.slack);
    };
    V z = zOfEnd();
    for (; taken_ < balls_.list.size(); ++taken_) {
      const TileBall& b = balls_.list[taken_];
      if (hn::AllTrue(f, z >= all(b.front))) break;
      V middle, half2;
      chordOf(b, tile_, packet_, b.support2, middle, half2);
      const M met = hn::And(half2 > hn::Zero(f), live_);
      if (hn::AllFalse(f, met)) continue;
      const V half = hn::Sqrt(hn::Max(half2, hn::Zero(f)));
      const V enter = hn::IfThenElse(met, middle - half, all(kFar)),
              leave = hn::IfThenElse(met, middle + half, all(-kFar));
      if (hn::AllFalse(f, leave > now_)) continue;
      if (count_ == window_.capacity) window_.grow();
      const std::size_t at = count_ * laneCount();
      hn::Store(middle, f, window_.middle + at);
      hn::Store(half2, f, window_.half2 + at);
      hn::Store(enter, f, window_.enter + at);
      hn::Store(leave, f, window_.leave + at);
      window_.inverse2[count_] = b.inverse2;
      window_.coefficient[count_] = b.coefficient;
      window_.ball[count_] = static_cast<std::uint32_t>(taken_);
      ++count_;
      next_ = hn::Min(next_, eventAfter(now_, enter, leave));
      z = zOfEnd();
    }
  }

  // The next event of each ray; those without any are done. Whether rays are left.
  HWY_INLINE bool findNext() {
    load([&] { return next_; });
    live_ = hn::And(live_, next_ < all(kFar));
    return !hn::AllFalse(F(), live_);
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
  HWY_INLINE V boundOnInterval() const {
    const F f;
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

  // Whether the field keeps its sign on [now, end], which may hold entries and exits: each ball at its nearest
  // point if it could change the sign, otherwise at its farthest.
  M keepsSign(V end) const {
    const F f;
    const V zero = hn::Zero(f);
    V towards = zero, away = zero;  // a change of sign
    for (std::size_t i = 0; i < count_; ++i) {
      const V middle = chord(window_.middle, i), half2 = chord(window_.half2, i);
      const V a = now_ - middle, b = end - middle;
      const V nearest = hn::Min(hn::Max(zero, a), b);
      const V farthest2 = hn::Max(a * a, b * b);
      const auto valueAt = [&](V t2) {
        return all(std::abs(window_.coefficient[i])) *
               kernel_.value(hn::Max((half2 - t2) * all(window_.inverse2[i]), zero));
      };
      const V most = valueAt(nearest * nearest), least = valueAt(farthest2);
      const M adds = window_.coefficient[i] > 0 ? hn::Not(inside_) : inside_;
      towards = towards + hn::IfThenElse(adds, most, zero);
      away = away + hn::IfThenElse(adds, zero, least);
    }
    // Of a sum of so many, rounded.
    const float rounding = 1.2e-7f * static_cast<float>(count_ + 8);
    towards = towards * all(1 + rounding);
    away = away * all(1 - rounding);
    return towards - away < hn::IfThenElse(inside_, all(-level_), all(level_));
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
      const TileBall& b = balls_.list[window_.ball[i]];
      V middle, half2;
      chordOf(b, tile_, packet_, tile_.records[b.record].core2, middle, half2);
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
      brackets_.polynomial.set(k, hn::IfThenElse(single, polynomial_.get(k), brackets_.polynomial.get(k)));
    brackets_.now = hn::IfThenElse(single, now_, brackets_.now);
    brackets_.next = hn::IfThenElse(single, next_, brackets_.next);
    brackets_.found = hn::Or(brackets_.found, single);
    live_ = hn::AndNot(single, live_);
  }

  // The last entry or exit that is not behind `end`, or where the ray is: intervals begin there and nowhere
  // else, whichever rays walk together.
  HWY_INLINE V lastEventBefore(V end) const {
    V last = now_;
    for (std::size_t i = 0; i < count_; ++i) {
      const V enter = chord(window_.enter, i), leave = chord(window_.leave, i);
      last = hn::Max(last, hn::IfThenElse(leave <= end, leave, hn::IfThenElse(enter <= end, enter, last)));
    }
    return last;
  }

  // Takes some rays as far as looks at whole stretches reach, however many entries and exits these hold: twice as
  // far each time until a look fails, then half as far.
  void passMany(M rays) {
    const F f;
    const V half = all(0.5f), twice = all(2.0f);
    stretch_ = hn::Max(stretch_, twice * (next_ - now_));
    M failed = hn::MaskFromVec(hn::Zero(f));
    for (;;) {
      const V end = now_ + stretch_;
      rays = hn::And(rays, end > next_);
      if (hn::AllFalse(f, rays)) return;
      const V loaded = hn::IfThenElse(rays, end, next_);
      load([&] { return loaded; });
      ++counts_.stretches;
      const M passed = hn::And(rays, keepsSign(end));
      failed = hn::Or(failed, hn::AndNot(passed, rays));
      stretch_ = hn::IfThenElse(rays, stretch_ * hn::IfThenElse(failed, half, twice), stretch_);
      if (!hn::AllFalse(f, passed)) advance(passed, lastEventBefore(end));
    }
  }

  // Some rays to where they have been looked at; drops the chords that every ray has left.
  void advance(M moving, V reached) {
    const F f;
    now_ = hn::IfThenElse(moving, reached, now_);
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
        window_.ball[kept] = window_.ball[i];
      }
      ++kept;
    }
    count_ = kept;
  }

  Kernel kernel_;
  const FieldTile& tile_;
  const Balls& balls_;
  const Packet& packet_;
  ChordWindow& window_;
  Brackets& brackets_;
  FieldCounts& counts_;
  float level_, tolerance_;
  V stretch_;                          // that each ray may pass at once
  std::size_t taken_ = 0, count_ = 0;  // of the list; of the window
  V now_, next_;                       // the interval that is looked at
  M live_, inside_;
  Coefficients polynomial_;
};

}  // namespace
}  // namespace meniscus::tiles::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

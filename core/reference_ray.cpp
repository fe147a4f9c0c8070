#include "core/reference_ray.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace meniscus::reference {

namespace {

constexpr double kUnit = 0x1p-53;
// w = (R^2 - d^2 - x^2) / R^2 of terms up to about R^2, in at most eight roundings: doubled.
constexpr double kRoundingOfW = 16 * 2 * kUnit;
// Intervals of one ray after which it settles for wider ones: against fields that vanish along a stretch.
constexpr int kMostIntervals = 200'000;

struct Jet {
  double value, slope;
};

struct Sextic {
  Jet operator()(double w) const { return {w * w * (5 + 4 * w) / 9, w * (10 + 12 * w) / 9}; }
};

struct Quartic {
  Jet operator()(double w) const { return {w * w, 2 * w}; }
};

struct Power {
  int exponent;
  Jet operator()(double w) const {
    double below = w;  // w^(exponent - 1)
    for (int i = 2; i < exponent; ++i) below *= w;
    return {below * w, exponent * below};
  }
};

/// Of F and of dF/ds on an interval, rounding included.
struct Bounds {
  double low, high, slopeLow, slopeHigh;
  int sign() const { return low > 0 ? 1 : high < 0 ? -1 : 0; }
  int slopeSign() const { return slopeLow > 0 ? 1 : slopeHigh < 0 ? -1 : 0; }
};

template <class KernelJet>
class RayWalk {
 public:
  RayWalk(const KernelJet& kernel, double level, std::span<const ViewBall> balls, const ViewRay& ray,
          bool tube, RayScratch& scratch)
      : kernel_(kernel), level_(level), balls_(balls), ray_(ray), tube_(tube), scratch_(scratch) {
    scratch_.chords.clear();
    scratch_.active.clear();
    scratch_.events.clear();
  }

  RayHit run(std::span<const std::uint32_t> candidates, double limit);

 private:
  using Chord = RayScratch::Chord;
  using Event = RayScratch::Event;

  // A heap with the nearest event on top.
  static bool later(const Event& a, const Event& b) { return a.s > b.s; }

  void meet(const ViewBall& ball, std::uint32_t index);
  void push(const Event& event) {
    scratch_.events.push_back(event);
    std::push_heap(scratch_.events.begin(), scratch_.events.end(), later);
  }
  void pop() {
    std::pop_heap(scratch_.events.begin(), scratch_.events.end(), later);
    scratch_.events.pop_back();
  }

  Bounds boundsOn(double from, double to) const;
  Jet fieldAt(double s) const;
  double leastWidth(double from, double to) const;
  bool examine(double from, double to);
  bool settle(int sign, double from, double to);
  double rootBetween(double low, double high) const;
  void apply(const Event& event);
  bool advance(double from, double to);
  RayHit undecided();
  RayHit atCrossing();

  KernelJet kernel_;
  double level_;
  std::span<const ViewBall> balls_;
  const ViewRay& ray_;
  bool tube_;
  RayScratch& scratch_;

  int sign_ = 0;        // of F at certain_; 0: not known yet
  double certain_ = 0;  // up to here the signs are decided
  bool clean_ = true;   // from certain_ on, F can cross zero at most once
  bool abandoned_ = false;
  double bracketEnd_ = 0;
  double lastBoundary_ = 0;  // of the polynomial pieces of the ray itself
  int entered_ = 0;          // supports that the ray itself is in
  int intervalsLeft_ = kMostIntervals;
  RayHit hit_;
};

template <class KernelJet>
void RayWalk<KernelJet>::meet(const ViewBall& ball, std::uint32_t index) {
  const double spread = tube_ ? ball.spread : 0;
  const glm::dvec3 toCenter = ball.center - ray_.base;
  const double middle = glm::dot(toCenter, ray_.direction);
  const glm::dvec3 aside = toCenter - middle * ray_.direction;
  const double distance2 = glm::dot(aside, aside), reach = ball.support + spread;
  const double half2 = reach * reach - distance2;
  if (!(half2 > 0)) return;
  const double half = std::sqrt(half2);
  if (middle + half <= ray_.start - ray_.startSpread) return;

  Chord chord;
  chord.middle = middle;
  const double support2 = ball.support * ball.support;
  chord.half2 = chord.lowHalf2 = chord.highHalf2 = support2 - distance2;
  if (tube_) {
    const double distance = std::sqrt(distance2), least = std::max(distance - spread, 0.0);
    chord.lowHalf2 = support2 - (distance + spread) * (distance + spread);
    chord.highHalf2 = support2 - least * least;
  }
  chord.inverse2 = 1 / support2;
  chord.coefficient = ball.coefficient;
  chord.support = ball.support;
  chord.spread = spread;
  chord.exit = middle + half;
  chord.ball = index;
  const auto at = static_cast<std::uint32_t>(scratch_.chords.size());
  scratch_.chords.push_back(chord);
  push({middle - half, at, true});
  push({middle + half, at, false});
}

template <class KernelJet>
Bounds RayWalk<KernelJet>::boundsOn(double from, double to) const {
  double low = 0, high = 0, slopeLow = 0, slopeHigh = 0, size = level_, slopeSize = 0;
  for (const Chord& c : scratch_.active) {
    const double x0 = from - c.middle - c.spread, x1 = to - c.middle + c.spread;
    const double square0 = x0 * x0, square1 = x1 * x1;
    const double least = x0 <= 0 && x1 >= 0 ? 0 : std::min(square0, square1);
    const double wHigh = (c.highHalf2 - least) * c.inverse2 + kRoundingOfW;
    if (!(wHigh > 0)) continue;
    const double wLow = (c.lowHalf2 - std::max(square0, square1)) * c.inverse2 - kRoundingOfW;
    const Jet most = kernel_(wHigh), fewest = kernel_(std::max(wLow, 0.0));
    // dF/ds = q f'(w) (-2 x / R^2) with f' >= 0.
    const double xLow = x0 * (x0 < 0 ? most.slope : fewest.slope);
    const double xHigh = x1 * (x1 > 0 ? most.slope : fewest.slope);
    const double q = c.coefficient, turn = -2 * c.inverse2 * q;
    low += q * (q > 0 ? fewest.value : most.value);
    high += q * (q > 0 ? most.value : fewest.value);
    slopeLow += turn * (q > 0 ? xHigh : xLow);
    slopeHigh += turn * (q > 0 ? xLow : xHigh);
    size += std::abs(q) * most.value;
    slopeSize += std::abs(turn) * std::max(-x0, x1) * most.slope;
  }
  // Sums of n terms of a few roundings each. Steps of the powers: below 20.
  const double rounding = static_cast<double>(scratch_.active.size() + 24) * 2 * kUnit;
  return {low - level_ - rounding * size, high - level_ + rounding * size, slopeLow - rounding * slopeSize,
          slopeHigh + rounding * slopeSize};
}

template <class KernelJet>
Jet RayWalk<KernelJet>::fieldAt(double s) const {
  Jet sum{-level_, 0};
  for (const Chord& c : scratch_.active) {
    const double x = s - c.middle;
    const double w = (c.half2 - x * x) * c.inverse2;
    if (!(w > 0)) continue;
    const Jet f = kernel_(w);
    sum.value += c.coefficient * f.value;
    sum.slope -= 2 * c.inverse2 * c.coefficient * f.slope * x;
  }
  return sum;
}

// Below it an interval is not split. A tube's bounds do not get better below its own width.
template <class KernelJet>
double RayWalk<KernelJet>::leastWidth(double from, double to) const {
  double support = std::numeric_limits<double>::infinity(), spread = 0;
  for (const Chord& c : scratch_.active) {
    support = std::min(support, c.support);
    spread = std::max(spread, c.spread);
  }
  const double rounding = 16 * kUnit * std::max(std::abs(from), std::abs(to));
  return std::max({kLeastWidth * support, 2 * spread, rounding});
}

// F has this sign on [from, to]. True if that is the other sign for the first time.
template <class KernelJet>
bool RayWalk<KernelJet>::settle(int sign, double from, double to) {
  if (sign_ == -sign) {
    bracketEnd_ = from;
    return true;
  }
  if (!clean_) hit_.touched = true;
  sign_ = sign;
  certain_ = to;
  clean_ = true;
  return false;
}

// Decides the sign of F on [from, to], from left to right. True if it changed, or if a tube is given up.
template <class KernelJet>
bool RayWalk<KernelJet>::examine(double from, double to) {
  auto& stack = scratch_.intervals;
  stack.assign(1, {from, to});
  const double least = leastWidth(from, to);
  while (!stack.empty()) {
    const auto [a, b] = stack.back();
    stack.pop_back();
    --intervalsLeft_;
    const Bounds bounds = boundsOn(a, b);
    const double middle = a + (b - a) / 2;
    int sign = bounds.sign();
    const int slope = bounds.slopeSign();
    if (sign == 0 && slope == 0) {  // the mean value form: its excess falls with the square of the width
      const double reach = std::max(std::abs(bounds.slopeLow), std::abs(bounds.slopeHigh)) *
                           (std::max(middle - a, b - middle) * (1 + 4 * kUnit));
      const Bounds center = boundsOn(middle, middle);
      sign = center.low > reach ? 1 : center.high < -reach ? -1 : 0;
    }
    if (sign != 0) {
      if (settle(sign, a, b)) return true;
    } else if (slope != 0) {
      // Turning away from zero after a stretch of unknown sign: it may have touched it.
      if (slope == sign_ && certain_ < a) clean_ = false;
      const int end = boundsOn(b, b).sign();
      if (end != 0 && settle(end, b, b)) return true;
    } else if (b - a <= least || !(middle > a && middle < b) || intervalsLeft_ <= 0) {
      clean_ = false;
    } else {
      stack.push_back({middle, b});
      stack.push_back({a, middle});
    }
    if (tube_ && !clean_) {
      abandoned_ = true;
      return true;
    }
  }
  return false;
}

// Newton's method, halving where it leaves the bracket or is slow. F(low) has sign_, F(high) the other.
template <class KernelJet>
double RayWalk<KernelJet>::rootBetween(double low, double high) const {
  double s = low + (high - low) / 2, step = high - low, before = step;
  for (int i = 0; i < 300; ++i) {
    const Jet f = fieldAt(s);
    if (f.value == 0) return s;
    ((f.value > 0) == (sign_ > 0) ? low : high) = s;
    const double newton = s - f.value / f.slope;
    const bool good = newton > low && newton < high && std::abs(newton - s) < std::abs(before) / 2;
    const double next = good ? newton : low + (high - low) / 2;
    before = step;
    step = next - s;
    if (next == s || !(next > low && next < high)) return next;
    s = next;
  }
  return s;
}

// Takes an entry or an exit at `event.s`; what was left is dropped when no undecided stretch needs it.
template <class KernelJet>
void RayWalk<KernelJet>::apply(const Event& event) {
  const Chord& chord = scratch_.chords[event.chord];
  if (chord.half2 > 0) {
    if (entered_ > 0 && event.s > lastBoundary_) ++hit_.pieces;
    lastBoundary_ = std::max(lastBoundary_, event.s);
    entered_ += event.entry ? 1 : -1;
  }
  if (event.entry) scratch_.active.push_back(chord);
}

// One stretch between events. True if F changed sign in it, or if a tube is given up.
template <class KernelJet>
bool RayWalk<KernelJet>::advance(double from, double to) {
  if (certain_ == from) std::erase_if(scratch_.active, [from](const Chord& c) { return c.exit <= from; });
  return scratch_.active.empty() ? settle(-1, from, to) : examine(from, to);
}

template <class KernelJet>
RayHit RayWalk<KernelJet>::run(std::span<const std::uint32_t> candidates, double limit) {
  std::size_t next = 0;
  const double start = ray_.start + (tube_ ? ray_.startSpread : 0);
  double at = certain_ = lastBoundary_ = start;
  bool started = false;
  while (true) {
    const auto& events = scratch_.events;
    while (next < candidates.size() &&
           (events.empty() || balls_[candidates[next]].nearest - ray_.distance0 <= events.front().s)) {
      meet(balls_[candidates[next]], candidates[next]);
      ++next;
    }
    if (events.empty()) break;
    const Event event = events.front();
    pop();
    if (event.s > at) {
      if (!started) {
        sign_ = boundsOn(2 * ray_.start - start, start).sign();
        clean_ = sign_ != 0;
        if (tube_ && !clean_) return undecided();
        started = true;
      }
      if (at + ray_.distance0 > limit) return hit_;
      if (advance(at, event.s)) return abandoned_ ? undecided() : atCrossing();
      at = event.s;
    }
    apply(event);
  }
  // Behind the last support F is the negative level.
  if (started && settle(-1, at, at)) return atCrossing();
  return hit_;
}

template <class KernelJet>
RayHit RayWalk<KernelJet>::undecided() {
  hit_.verdict = Verdict::undecided;
  return hit_;
}

template <class KernelJet>
RayHit RayWalk<KernelJet>::atCrossing() {
  const double s = rootBetween(certain_, bracketEnd_);
  hit_.verdict = Verdict::hit;
  hit_.distance = ray_.distance0 + s;
  hit_.latest = ray_.distance0 + bracketEnd_;
  hit_.fromInside = sign_ > 0;
  if (entered_ > 0) ++hit_.pieces;
  const glm::dvec3 point = ray_.base + s * ray_.direction;
  glm::dvec3 gradient(0);
  double largest = 0;
  for (const Chord& c : scratch_.active) {
    const double x = s - c.middle, w = (c.half2 - x * x) * c.inverse2;
    if (!(w > 0)) continue;
    const ViewBall& ball = balls_[c.ball];
    const Jet f = kernel_(w);
    gradient -= 2 * c.inverse2 * c.coefficient * f.slope * (point - ball.center);
    const double share = c.coefficient * f.value;
    if (share > largest || (share == largest && share > 0 && ball.index < hit_.ball)) {
      largest = share;
      hit_.ball = ball.index;
    }
  }
  const double length = glm::length(gradient);
  hit_.normal = length > 0 ? gradient / length : -ray_.direction;
  if (glm::dot(hit_.normal, ray_.direction) > 0) hit_.normal = -hit_.normal;
  hit_.cosine = -glm::dot(hit_.normal, ray_.direction);
  return hit_;
}

}  // namespace

RayHit castRay(const MetaballField& field, std::span<const ViewBall> balls,
               std::span<const std::uint32_t> candidates, const ViewRay& ray, bool tube, double limit,
               RayScratch& scratch) {
  const auto cast = [&](auto kernel) {
    return RayWalk(kernel, field.level, balls, ray, tube, scratch).run(candidates, limit);
  };
  switch (field.kernel.shape) {
    case KernelShape::sextic:
      return cast(Sextic{});
    case KernelShape::quartic:
      return cast(Quartic{});
    case KernelShape::power:
      return cast(Power{field.kernel.exponent});
  }
  return {};
}

}  // namespace meniscus::reference

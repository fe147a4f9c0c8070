#include "core/bvh/field_ray.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/shared_math.h"

namespace meniscus::bvh {

namespace {

// Roots are narrowed down to this share of the smallest support around, or to eight roundings of the place.
constexpr double kWidth = 1e-11;
constexpr int kMostSteps = 200;
// Halvings of a piece after which it settles for wider ones: against fields that vanish along a stretch.
constexpr int kMostHalvings = 20'000;

// Polynomials on [0, 1] in Bernstein form.
template <int kMost>
struct Polygon {
  double c[kMost + 1];
  int degree;
};

struct Sextic {
  using Sum = Polygon<6>;
  int degree() const { return 6; }
  double at(double w) const { return f64::sexticKernel(w); }
  void add(Sum& sum, const f64::Window& w, double q) const {
    const f64::SexticPiece piece = f64::sexticPiece(w);
    for (int k = 0; k <= 6; ++k) sum.c[k] += q * piece.c[k];
  }
};

struct Quartic {
  using Sum = Polygon<4>;
  int degree() const { return 4; }
  double at(double w) const { return f64::quarticKernel(w); }
  void add(Sum& sum, const f64::Window& w, double q) const {
    const f64::QuarticPiece piece = f64::quarticPiece(w);
    for (int k = 0; k <= 4; ++k) sum.c[k] += q * piece.c[k];
  }
};

struct Power {
  using Sum = Polygon<2 * kMostKernelExponent>;
  int exponent;
  int degree() const { return 2 * exponent; }
  double at(double w) const { return f64::powerKernel(w, exponent); }
  void add(Sum& sum, const f64::Window& w, double q) const {
    const f64::PowerPiece piece = f64::powerPiece(w, exponent);
    for (int k = 0; k <= degree(); ++k) sum.c[k] += q * piece.c[k];
  }
};

template <class P>
int signChanges(const P& p) {
  int changes = 0;
  for (int k = 0; k < p.degree; ++k) changes += (p.c[k] > 0) != (p.c[k + 1] > 0) ? 1 : 0;
  return changes;
}

// The parts on [0, u] and on [u, 1] (de Casteljau).
template <class P>
void split(P& left, P& right, double u) {
  right = left;
  for (int n = 1; n <= right.degree; ++n) {
    for (int k = 0; k <= right.degree - n; ++k) right.c[k] += (right.c[k + 1] - right.c[k]) * u;
    left.c[n] = right.c[0];
  }
}

template <class P>
double valueOf(const P& p, double u) {
  const double v = 1 - u;
  double power = 1, binomial = 1, sum = p.c[0] * v;
  for (int k = 1; k < p.degree; ++k) {
    power *= u;
    binomial *= static_cast<double>(p.degree - k + 1) / k;
    sum = (sum + power * binomial * p.c[k]) * v;
  }
  return sum + power * u * p.c[p.degree];
}

// What changes its sign from at(low) <= 0 to at(high) > 0, narrowed down to `width`: repeated linear
// interpolation, of which every third step that does not halve is followed by a bisection.
template <class F>
double narrow(const F& at, double low, double atLow, double high, double atHigh, double width,
              RayEffort& effort) {
  double weightLow = atLow, weightHigh = atHigh, before = high - low;
  int side = 0;
  for (int i = 0; i < kMostSteps; ++i) {
    const double size = high - low;
    if (size <= width) return low + size * (atLow / (atLow - atHigh));
    ++effort.iterations;
    double place = low + size * (weightLow / (weightLow - weightHigh));
    place = std::clamp(place, low + 0.4 * width, high - 0.4 * width);
    if (i % 3 == 2) {
      if (size > 0.25 * before) place = low + 0.5 * size;
      before = size;
    }
    const double value = at(place);
    if (value > 0) {
      high = place;
      atHigh = weightHigh = value;
      if (side > 0) weightLow *= 0.5;
      side = 1;
    } else {
      low = place;
      atLow = weightLow = value;
      if (side < 0) weightHigh *= 0.5;
      side = -1;
    }
  }
  ++effort.notConverged;
  return high;
}

// Where a polynomial first becomes positive.
template <class P>
std::optional<double> firstRoot(P p, double from, double size, double width, int& halvings,
                                RayEffort& effort) {
  if (p.c[0] > 0) return from;
  const int changes = signChanges(p);
  if (changes == 0) return std::nullopt;
  if (changes == 1) {
    const auto at = [&](double u) { return valueOf(p, u); };
    return from + size * narrow(at, 0, p.c[0], 1, p.c[p.degree], width / size, effort);
  }
  if (size <= width || halvings <= 0) {
    ++(size <= width ? effort.grazing : effort.notConverged);
    return p.c[p.degree] > 0 ? std::optional(from + size) : std::nullopt;
  }
  ++effort.iterations;
  --halvings;
  P right;
  split(p, right, 0.5);
  const double half = size / 2;
  if (const auto root = firstRoot(p, from, half, width, halvings, effort)) return root;
  return firstRoot(right, from + half, half, width, halvings, effort);
}

template <class K>
class RootSearch {
 public:
  RootSearch(const K& kernel, double level, const Stretch& stretch, RayScratch& scratch, RayEffort& effort)
      : kernel_(kernel), level_(level), stretch_(stretch), scratch_(scratch), effort_(effort) {}

  double crossing();
  double projection();

 private:
  double signedField(double at) const {
    double sum = -level_;
    for (const RayChord& c : scratch_.chords) {
      const double x = at - c.middle, w = (c.half2 - x * x) * c.inverse2;
      if (w > 0) sum += c.coefficient * kernel_.at(w);
    }
    return stretch_.inside ? -sum : sum;
  }
  bool keepsSign(double from, double to) const;
  std::optional<double> examine(double from, double to);
  double widthAt(double from, double to) const;

  K kernel_;
  double level_;
  const Stretch& stretch_;
  RayScratch& scratch_;
  RayEffort& effort_;
  bool armed_ = true;  // the field has been seen to have the sign that it begins with
};

template <class K>
double RootSearch<K>::widthAt(double from, double to) const {
  double inverse2 = 0;
  for (const std::uint32_t i : scratch_.active) inverse2 = std::max(inverse2, scratch_.chords[i].inverse2);
  return std::max(kWidth / std::sqrt(inverse2), 0x1p-50 * std::max(std::abs(from), std::abs(to)));
}

// From each ball's largest and smallest share.
template <class K>
bool RootSearch<K>::keepsSign(double from, double to) const {
  double low = -level_, high = -level_, size = level_;
  for (const std::uint32_t i : scratch_.active) {
    const RayChord& c = scratch_.chords[i];
    const double a = from - c.middle, b = to - c.middle;
    const double least = a <= 0 && b >= 0 ? 0 : std::min(a * a, b * b);
    const double most = kernel_.at(std::max((c.half2 - least) * c.inverse2, 0.0));
    size += std::abs(c.coefficient) * most;
    (c.coefficient > 0 ? high : low) += c.coefficient * most;
    if (stretch_.inside != (c.coefficient > 0)) continue;  // the other bound is not asked for
    const double far = std::max(a * a, b * b);
    const double fewest = kernel_.at(std::max((c.half2 - far) * c.inverse2, 0.0));
    (c.coefficient > 0 ? low : high) += c.coefficient * fewest;
  }
  const double margin = 1e-13 * size;
  return stretch_.inside ? low > margin : high < -margin;
}

template <class K>
std::optional<double> RootSearch<K>::examine(double from, double to) {
  if (armed_ && keepsSign(from, to)) return std::nullopt;
  ++effort_.pieces;
  const double size = to - from, width = widthAt(from, to);
  typename K::Sum sum;
  sum.degree = kernel_.degree();
  for (int k = 0; k <= sum.degree; ++k) sum.c[k] = -level_;
  for (const std::uint32_t i : scratch_.active) {
    const RayChord& c = scratch_.chords[i];
    kernel_.add(sum, f64::windowOn(c.middle, c.half2, c.inverse2, from, to), c.coefficient);
  }
  if (stretch_.inside)
    for (int k = 0; k <= sum.degree; ++k) sum.c[k] = -sum.c[k];
  int halvings = kMostHalvings;
  double begin = 0;  // share of the stretch
  if (!armed_) {
    if (sum.c[0] > 0) {  // rounding, or where the ray touches: on to where the sign is right
      auto turned = sum;
      for (int k = 0; k <= sum.degree; ++k) turned.c[k] = -turned.c[k];
      const auto right = firstRoot(turned, 0, size, width, halvings, effort_);
      if (!right) return std::nullopt;
      begin = std::min(*right / size, 1.0);
      typename K::Sum rest;
      split(sum, rest, begin);
      sum = rest;
      sum.c[0] = 0;
    }
    armed_ = true;
  }
  const auto root = firstRoot(sum, from + begin * size, (1 - begin) * size, width, halvings, effort_);
  return root ? std::optional(std::min(*root, to)) : std::nullopt;
}

template <class K>
double RootSearch<K>::crossing() {
  auto& events = scratch_.events;
  events.clear();
  for (std::uint32_t i = 0; i < scratch_.chords.size(); ++i) {
    const RayChord& c = scratch_.chords[i];
    if (!(c.from < c.to)) continue;
    events.push_back({c.from, i, true});
    events.push_back({c.to, i, false});
  }
  std::sort(events.begin(), events.end(), [](const auto& a, const auto& b) {
    return a.at != b.at ? a.at < b.at : a.chord != b.chord ? a.chord < b.chord : a.entry && !b.entry;
  });
  auto& active = scratch_.active;
  active.clear();
  armed_ = !stretch_.onStart;
  // Where there is no ball, the field is the negative level.
  const bool emptyIsOther = stretch_.inside && !stretch_.ownOnly;
  double now = stretch_.from;
  int own = 0;
  bool left = false;  // since the last time that the active ones were looked through
  bool fresh = true;  // a part with own chords begins here
  for (const auto& event : events) {
    if (event.at > now) {
      if (left) std::erase_if(active, [&](std::uint32_t i) { return scratch_.chords[i].to <= now; });
      left = false;
      if (active.empty()) {
        if (emptyIsOther) return now;
        armed_ = true;
      } else if (!stretch_.ownOnly || own > 0) {
        if (fresh && now > stretch_.from) {
          armed_ = true;
          // It has changed before, where this leaf does not know all that there is.
          if (stretch_.ownOnly && signedField(now) > 0) return kInfinity;
        }
        fresh = false;
        if (const auto root = examine(now, event.at)) return *root;
      }
      now = event.at;
    }
    if (event.entry) active.push_back(event.chord);
    left = left || !event.entry;
    if (scratch_.chords[event.chord].own) own += event.entry ? 1 : -1;
    if (own == 0) fresh = true;
  }
  return now < stretch_.to && emptyIsOther ? now : kInfinity;
}

template <class K>
double RootSearch<K>::projection() {
  auto& places = scratch_.places;
  places.clear();
  for (const RayChord& c : scratch_.chords) {
    if (stretch_.ownOnly && (!c.own || c.middle < stretch_.from || c.middle > stretch_.to)) continue;
    places.push_back(std::clamp(c.middle, stretch_.from, stretch_.to));
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  double before = stretch_.from;
  for (const double place : places) {
    if (stretch_.onStart && place == stretch_.from) continue;
    const double value = signedField(place);
    if (!(value > 0)) {
      before = place;
      continue;
    }
    double atBefore = signedField(before);
    if (atBefore > 0) {
      if (!stretch_.onStart || before > stretch_.from) return before;
      atBefore = -1e-12 * level_;  // rounding: the ray begins on the surface
    }
    const auto at = [&](double t) { return signedField(t); };
    double smallest = kInfinity;
    for (const RayChord& c : scratch_.chords) smallest = std::min(smallest, 1 / std::sqrt(c.inverse2));
    const double width = std::max(1e-9 * smallest, 0x1p-50 * std::abs(place));
    return narrow(at, before, atBefore, place, value, width, effort_);
  }
  return kInfinity;
}

template <class F>
double withKernel(const Kernel& kernel, const F& call) {
  switch (kernel.shape) {
    case KernelShape::sextic:
      return call(Sextic{});
    case KernelShape::quartic:
      return call(Quartic{});
    case KernelShape::power:
      return call(Power{kernel.exponent});
  }
  return kInfinity;
}

}  // namespace

double firstCrossing(const Kernel& kernel, double level, const Stretch& stretch, RayScratch& scratch,
                     RayEffort& effort) {
  return withKernel(kernel,
                    [&](const auto& k) { return RootSearch(k, level, stretch, scratch, effort).crossing(); });
}

double firstProjection(const Kernel& kernel, double level, const Stretch& stretch, RayScratch& scratch,
                       RayEffort& effort) {
  return withKernel(
      kernel, [&](const auto& k) { return RootSearch(k, level, stretch, scratch, effort).projection(); });
}

}  // namespace meniscus::bvh

#pragma once
// One ray against one field of metaballs in double precision: the inner part of core/reference_tracer.h,
// where the meaning of a hit is written down.
//
// Roots are isolated by interval arithmetic on the field and on its derivative along the ray (Moore 1966;
// Mitchell, Robust ray intersection with interval arithmetic, Graphics Interface 1990), ball by ball, never
// on expanded polynomials: each ball's w = 1 - r^2/R^2 has an exact range on an interval, every kernel and
// its slope are monotone in w. Nothing of shaders/shared/metaball.glsl or of a rendering method is used.
//
// The same arithmetic serves a ray and a tube of rays: a tube's balls lie within `spread` of where they lie
// for the ray in its middle. What is proven for the tube holds for every ray in it.

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/metaball_field.h"

namespace meniscus::reference {

/// A ball in view axes, relative to a point in the middle of its field.
struct ViewBall {
  glm::dvec3 center;
  double support = 0, coefficient = 0;
  double nearest = 0;       ///< no ray of the view enters the support at a smaller distance
  double spread = 0;        ///< of the tube about a ray, within the support, at most
  std::uint32_t index = 0;  ///< in MetaballField::balls
};

/// Points base + s direction; the distance from the ray's origin is distance0 + s.
struct ViewRay {
  glm::dvec3 base, direction;  ///< base relative to the middle of the field, near it
  double distance0 = 0;
  double start = 0;        ///< s of the near plane
  double startSpread = 0;  ///< how far s of the near plane differs within the tube, at most
};

enum class Verdict : std::uint8_t {
  miss,
  hit,
  undecided  ///< of a tube: its rays may decide differently
};

struct RayHit {
  Verdict verdict = Verdict::miss;
  double distance = 0;  ///< of the first change of sign at or after the near plane
  double latest = 0;    ///< of a tube: no ray in it goes on for longer
  bool fromInside = false;
  bool touched = false;      ///< before it F came so close to zero that its sign could not be decided
  std::uint32_t pieces = 0;  ///< between entries and exits of supports, examined
  glm::dvec3 normal{0.0};    ///< unit, view axes, towards the viewer
  double cosine = 0;         ///< of the angle between normal and direction to the viewer
  std::uint32_t ball = 0;    ///< ViewBall::index of the largest positive share
};

/// Within a piece two roots closer than this share of its smallest support, or than eight roundings of s, may
/// be taken for none; RayHit::touched says so.
inline constexpr double kLeastWidth = 0x1p-26;

/// Memory that rays share one after the other.
struct RayScratch {
  struct Chord {
    double middle = 0;                   ///< s nearest to the centre
    double half2 = 0;                    ///< R^2 - (distance of the centre)^2, of the ray in the middle
    double lowHalf2 = 0, highHalf2 = 0;  ///< the same over the tube
    double support = 0, inverse2 = 0;    ///< R, 1/R^2
    double coefficient = 0;
    double spread = 0;       ///< of `middle` over the tube
    double exit = 0;         ///< of the whole tube
    std::uint32_t ball = 0;  ///< place in the span given to castRay()
  };
  struct Event {
    double s;
    std::uint32_t chord;
    bool entry;
  };
  struct Interval {
    double from, to;
  };
  std::vector<Chord> chords, active;
  std::vector<Event> events;
  std::vector<Interval> intervals;
};

/// `candidates`: indices of all balls that the ray (or tube) may meet, by ascending `nearest`. Nothing behind
/// `limit` (a distance) is looked for.
RayHit castRay(const MetaballField& field, std::span<const ViewBall> balls,
               std::span<const std::uint32_t> candidates, const ViewRay& ray, bool tube, double limit,
               RayScratch& scratch);

}  // namespace meniscus::reference

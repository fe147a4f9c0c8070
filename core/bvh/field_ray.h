#pragma once
// One ray and some of a field's balls in double precision: where the field changes its sign. Used by
// core/bvh/field_tracer.h.

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "core/metaball_field.h"

namespace meniscus::bvh {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Of the field where a ray begins.
enum class Side : std::uint8_t {
  unknown,  ///< to be found out
  outside,  ///< F < 0, or the ray begins on the surface and goes out
  inside    ///< F > 0, or the ray begins on the surface and goes in
};

struct FieldRay {
  glm::dvec3 origin;     ///< relative to Primitives::origin [Å]
  glm::dvec3 direction;  ///< unit
  double from = 0, to = kInfinity;
  Side side = Side::unknown;
};

/// A ball that the ray passes. Positions along the ray are distances from its origin.
struct RayChord {
  double middle, half2;  ///< nearest to the centre; R^2 less the square of that distance
  double inverse2;       ///< 1/R^2
  double coefficient;
  double from, to;  ///< within the support and the stretch that is searched
  bool own;         ///< of the leaf (core/bvh/box_tree.h)
};

/// Memory that rays share one after the other.
struct RayScratch {
  struct Event {
    double at;
    std::uint32_t chord;
    bool entry;
  };
  std::vector<RayChord> chords;
  std::vector<std::uint32_t> active;  // of the chords
  std::vector<Event> events;
  std::vector<double> places;
  std::vector<std::uint32_t> members;
};

struct RayEffort {
  std::uint64_t pieces = 0;      ///< polynomials that were set up
  std::uint64_t iterations = 0;  ///< halvings and steps of root finders
  std::uint64_t grazing = 0;     ///< tangencies that could not be told from crossings
  std::uint64_t notConverged = 0;
};

/// A stretch of a ray on which the chords in the scratch are all there is to the field.
struct Stretch {
  double from, to;
  bool inside;   ///< the field's sign where the ray begins
  bool onStart;  ///< the ray begins here: the sign at `from` is what `inside` says, rounding or not
  bool ownOnly;  ///< only places within chords that are `own` are searched
};

/// The first place at which the field changes its sign, guaranteed: polynomials between entries and exits, in
/// Bernstein form (shaders/shared/metaball.glsl), are halved until their coefficients change sign once at
/// most. kInfinity: there is none.
double firstCrossing(const Kernel& kernel, double level, const Stretch& stretch, RayScratch& scratch,
                     RayEffort& effort);

/// The same as Gourmel et al. 2010, §3, search for it: the first of the centres' projections on the ray that
/// lies on the other side ends an interval, in which repeated linear interpolation (Neubauer et al. 2002,
/// with Illinois' halved weights) converges. Rays that dip into the surface between two projections are
/// missed, by design. Departure: a projection beyond the stretch counts as its end, since the leaf's balls
/// say nothing about what lies outside.
double firstProjection(const Kernel& kernel, double level, const Stretch& stretch, RayScratch& scratch,
                       RayEffort& effort);

}  // namespace meniscus::bvh

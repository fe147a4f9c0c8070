#pragma once
// The truth for metaball surfaces: what the ray through each pixel's centre meets first, in double precision,
// by interval arithmetic that no rendering method shares (core/reference_ray.h). Slow beside them, and
// guaranteed: no root is missed but pairs closer than reference::kLeastWidth, and those are counted.
//
// A hit is the first point of the ray at or after the near plane where F changes sign: the entry, or, where
// F > 0 at the near plane already, the exit. A double root, where the ray only touches the surface, is none.

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/hit_image.h"
#include "core/metaball_field.h"
#include "core/view.h"

namespace meniscus {

struct ReferenceOptions {
  bool grazing = true;  ///< find out about it; otherwise only what a ray by itself cannot decide is marked
  double grazingShift = 0.02;  ///< [pixel] by which the ray is moved right, left, up and down
};

/// A pixel is `grazing` if one of the four moved rays decides differently: a hit against a miss, an entry
/// against an exit, or a hit on another sheet. Another sheet is what lies farther off than one smooth surface
/// allows: |t1 - t0| > (1 + 3 min(tan a0, tan a1)) e, where e is the distance between the two rays at the hit
/// and a the angle between ray and normal. (Beside a smooth fold |t1 - t0| is the harmonic mean
/// of the tangents times e, at most twice the smaller; a face seen at up to 45 degrees stays below e.) It is
/// also grazing if the sign of F on its own ray is within rounding of zero before the hit.
struct ReferenceImage {
  /// Normals towards the viewer; id of the ball with the largest share q f > 0.
  HitImage hits;
  /// hits.distance before it was rounded.
  std::vector<double> distance;
  /// Polynomial pieces, between entries and exits of supports that the ray meets, up to that of the hit. One
  /// more or less where a boundary lies within grazingShift of the hit.
  std::vector<std::uint32_t> pieces;
  std::vector<std::uint8_t> grazing;  ///< 1 or 0
  /// Pixels whose own ray comes so near to a double root that rounding decides.
  std::size_t undecidedPixels = 0;
  /// Pixels whose four moved rays were cast; for the others a proof made it needless.
  std::size_t shiftedPixels = 0;
};

/// `origin`: Primitives::origin, to which the centres are relative [Å]. Throws InputError as requireValid().
ReferenceImage traceReference(const MetaballField& field, const glm::dvec3& origin, const View& view,
                              const ReferenceOptions& options = {});

/// Several surfaces in one scene: the nearest hit counts; pieces are those of all fields.
ReferenceImage traceReference(std::span<const MetaballField> fields, const glm::dvec3& origin,
                              const View& view, const ReferenceOptions& options = {});

}  // namespace meniscus

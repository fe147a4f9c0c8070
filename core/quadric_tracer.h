#pragma once
// The truth for pictures with quadrics: every ray against every sphere, cylinder and ellipsoid near it, in
// extended precision (core/exact_quadrics.h), which shares nothing with shaders/shared/.

#include "core/primitives.h"
#include "core/reference_tracer.h"
#include "core/view.h"

namespace meniscus {

/// What each pixel's ray meets first of the quadrics: a hit is the entry into a solid at or behind the near
/// plane or, where the solid begins before it, its inner wall. Grazing as in core/reference_tracer.h; pieces
/// are 0. Where two lie at the same distance, the id is that of the first in Primitives' order. Primitives
/// that are no solid (a number that is not finite, a radius that is not positive) are not there.
ReferenceImage traceQuadrics(const Primitives& primitives, const View& view,
                             const ReferenceOptions& options = {});

/// Quadrics and surfaces together: the nearer hit counts; grazing where either of the two is. Throws
/// InputError as requireValid().
ReferenceImage traceScene(const Primitives& primitives, const View& view,
                          const ReferenceOptions& options = {});

}  // namespace meniscus

#pragma once
// What cannot be drawn is refused, not drawn as something.

#include "core/primitives.h"

namespace meniscus {

/// Throws InputError, naming the kind and the atom, if a number of a sphere, cylinder or ellipsoid is not
/// finite. Surfaces: requireValid() of core/metaball_field.h.
void requireFinite(const Primitives& primitives);

}  // namespace meniscus

#pragma once
// The view from a light: what a shadow map is drawn with.

#include "core/scene.h"
#include "core/view.h"

namespace meniscus {

/// An orthographic view along `light` (given in the axes of `camera`) of everything in `bounds` that can cast
/// a shadow on what `camera` sees, with texels of `texelSize` [Å] or as much larger as `maxSize` demands.
/// `margin` [Å] is added around.
View makeLightView(const View& camera, const DirectionalLight& light, const BoundingSphere& bounds,
                   double texelSize, int maxSize, double margin);

/// Size of a pixel of `view` [Å] at the nearest visible part of `bounds`.
double pixelFootprint(const View& view, const BoundingSphere& bounds);

/// Size of a texel [Å] of the map for shadows as wide as `penumbra` [Å]: `footprint`, but no less than a
/// tenth of the penumbra, below which nothing is gained (docs/measured/shadow_error.md), if the thinnest
/// thing that casts a shadow, of radius `thinnest` [Å], is still six texels from its middle to its rim.
double shadowTexelSize(double footprint, double penumbra, double thinnest);

}  // namespace meniscus

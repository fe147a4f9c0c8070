#pragma once
// From what a sweep names to what is drawn.

#include <memory>

#include "app/measure/sweep.h"
#include "core/primitives.h"
#include "core/quadric_tracer.h"
#include "core/view.h"

namespace meniscus::measure {

/// Throws Error if a file cannot be read.
std::shared_ptr<const Primitives> primitivesOf(const SceneSpec& scene, std::uint64_t seed);

/// A molecule in another representation than as a surface.
std::shared_ptr<const Primitives> moleculeAs(const std::filesystem::path& file, Representation representation,
                                             const glm::ivec3& copies, bool alsoSurface = false);

/// How many atoms or balls there are to draw.
std::size_t ballCount(const Primitives& primitives);

/// All of the scene, as `meniscus render` would see it, turned.
View viewOf(const Primitives& primitives, const ViewSpec& spec, ImageSize size);

/// Looks from a tenth of a degree aside, so that nothing that was computed for it serves `view`.
View beside(const View& view);

/// The truth for a picture, computed once: `folder` keeps it, under a name made from all that it depends on.
ReferenceImage truthOf(const Primitives& primitives, const View& view, const std::filesystem::path& folder);

}  // namespace meniscus::measure

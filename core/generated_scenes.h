#pragma once
// Scenes made from a seed, for measuring and for tests: packed balls of any number, and the stiff and extreme
// ones that docs/measuring.md lists.

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "core/primitives.h"
#include "core/view.h"

namespace meniscus {

/// A field of `count` balls, packed in a ball as densely as the atoms of a protein: van der Waals radii
/// of 1.2 to 1.9 Å, supports of twice the radius. The same for the same seed on every machine.
std::shared_ptr<Primitives> packedBalls(std::size_t count, std::uint64_t seed);

/// All of it from a direction that is no axis, or from `orientation`.
View viewOfAll(const Primitives& primitives, ImageSize size, double fovY = 0.5235987755982988,
               Projection projection = Projection::perspective,
               const glm::dquat& orientation = {0.8, 0.2, -0.5, 0.2});

/// A scene of the stability suite, twice: as metaballs (and what else is in it), for surface methods; as
/// quadrics alone, the balls as spheres as large as each would be by itself, for drawing those.
struct StabilityScene {
  std::shared_ptr<const Primitives> surface, quadrics;
  View view;
  double detail = 1;  ///< size of the smallest feature that matters [Å]: errors are judged by it
};

struct StabilityRecipe {
  std::string_view name;
  std::string_view stresses;  ///< what it is hard on, a phrase
  StabilityScene (*make)(std::uint64_t seed, ImageSize size);
};

/// In the order of docs/measuring.md.
std::span<const StabilityRecipe> stabilityRecipes();

}  // namespace meniscus

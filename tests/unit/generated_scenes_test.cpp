// Scenes from a seed, and the truth for those with quadrics.

#include "core/generated_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/error.h"
#include "core/quadric_tracer.h"
#include "tests/support/scenes.h"

namespace meniscus::test {
namespace {

constexpr ImageSize kSize{48, 36};

void expectExactHits(const Primitives& primitives, const View& view) {
  const ReferenceImage image = traceQuadrics(primitives, view);
  int hits = 0;
  for (int y = 0; y < view.size.height; y += 3) {
    for (int x = 0; x < view.size.width; x += 3) {
      const auto at = static_cast<std::size_t>(y * view.size.width + x);
      const ExactHit hit = exactHit(primitives, view, {x + 0.5, y + 0.5});
      EXPECT_EQ(image.distance[at], hit.distance) << x << ", " << y;
      if (hit.runnerUp != hit.distance) {
        EXPECT_EQ(image.hits.id[at], hit.id) << x << ", " << y;
      }
      hits += hit.id != 0;
    }
  }
  EXPECT_GT(hits, 20);
}

TEST(QuadricTracer, findsWhatEveryRayAgainstEverythingFinds) {
  expectExactHits(*randomSpheres(300, 1), viewOf(*randomSpheres(300, 1), kSize));
  expectExactHits(*randomChain(200, 2), viewOf(*randomChain(200, 2), kSize, Projection::orthographic));
  expectExactHits(*randomEllipsoids(200, 3, 0.01), viewOf(*randomEllipsoids(200, 3, 0.01), kSize));
}

TEST(QuadricTracer, findsThemFromTheMiddleWithAWideView) {
  const auto scene = randomChain(300, 4);
  Camera camera;
  camera.target = scene->origin;
  camera.distance = 0.5;
  camera.fovY = 2.9;
  expectExactHits(*scene, makeView(camera, kSize, scene->bounds()));
}

TEST(QuadricTracer, normalsPointTowardsTheViewer) {
  const auto scene = randomChain(200, 5);
  const View view = viewOf(*scene, kSize);
  const ReferenceImage image = traceQuadrics(*scene, view);
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const auto at = static_cast<std::size_t>(y * kSize.width + x);
      if (!std::isfinite(image.distance[at])) continue;
      const glm::dvec3 direction = rayThrough(view, {x + 0.5, y + 0.5}).direction;
      EXPECT_LT(glm::dot(glm::dvec3(image.hits.normal[at]), direction), 1e-6);
      EXPECT_NEAR(glm::length(image.hits.normal[at]), 1, 1e-6);
    }
  }
}

TEST(SceneTracer, theNearerOfSurfaceAndQuadricsCounts) {
  const StabilityScene scene = [] {
    for (const StabilityRecipe& recipe : stabilityRecipes())
      if (recipe.name == "needles") return recipe.make(1, kSize);
    return StabilityScene{};
  }();
  const Primitives& all = *scene.surface;
  const ReferenceImage both = traceScene(all, scene.view), quadrics = traceQuadrics(all, scene.view),
                       surface = traceReference(all.surfaces, all.origin, scene.view);
  for (std::size_t i = 0; i < both.distance.size(); ++i)
    EXPECT_EQ(both.distance[i], std::min(quadrics.distance[i], surface.distance[i]));
}

TEST(PackedBalls, areTheSameForTheSameSeed) {
  const auto a = packedBalls(500, 3), b = packedBalls(500, 3), c = packedBalls(500, 4);
  ASSERT_EQ(a->surfaces[0].balls.size(), 500u);
  EXPECT_EQ(a->surfaces[0].balls[499].center, b->surfaces[0].balls[499].center);
  EXPECT_NE(a->surfaces[0].balls[499].center, c->surfaces[0].balls[499].center);
}

TEST(StabilityScenes, haveNamesOfTheirOwnAndSomethingToSee) {
  std::set<std::string_view> names;
  for (const StabilityRecipe& recipe : stabilityRecipes()) {
    SCOPED_TRACE(recipe.name);
    EXPECT_TRUE(names.insert(recipe.name).second);
    if (recipe.name == "sub-pixel") continue;  // slow to trace
    const StabilityScene scene = recipe.make(1, {24, 18});
    const ReferenceImage quadrics = traceScene(*scene.quadrics, scene.view);
    const auto hits = [](const ReferenceImage& image) {
      std::size_t count = 0;
      for (const double t : image.distance) count += std::isfinite(t);
      return count;
    };
    EXPECT_GT(hits(quadrics), 10u);
    if (recipe.name == "not-finite") {
      EXPECT_THROW(traceScene(*scene.surface, scene.view), InputError);
    } else {
      EXPECT_GT(hits(traceScene(*scene.surface, scene.view)), 10u);
    }
  }
}

}  // namespace
}  // namespace meniscus::test

// Trees over metaballs, and rays from anywhere through them, against the double-precision truth.

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "core/bvh/field_tracer.h"
#include "core/bvh/view_ray.h"
#include "core/generated_scenes.h"
#include "core/hit_errors.h"
#include "core/reference_tracer.h"
#include "tests/support/exact_field.h"
#include "tests/support/random.h"

namespace meniscus::bvh {
namespace {

const glm::dvec3 kOrigin(-4, 17, 3);

// Every structure and every option of a fitted tree, alone and together.
std::map<std::string, TreeSettings> everyTree() {
  const auto fitted = [](LeafCost cost, bool fit, bool tight, bool discard) {
    return TreeSettings{Structure::fitted, cost, fit, tight, discard};
  };
  return {{"classical", {Structure::classical, LeafCost::linear}},
          {"split", {Structure::split, LeafCost::linear}},
          {"split, n^2", {Structure::split, LeafCost::square}},
          {"cells", fitted(LeafCost::square, false, false, false)},
          {"fitted", fitted(LeafCost::square, true, false, false)},
          {"fitted, linear", fitted(LeafCost::linear, true, true, true)},
          {"tight", fitted(LeafCost::square, true, true, false)},
          {"discarding", fitted(LeafCost::square, false, false, true)},
          {"all", {}}};
}

struct Traced {
  HitImage image;
  TraceCounts counts;
};

Traced trace(const MetaballField& field, const FieldTree& tree, const View& view,
             Search search = Search::guaranteed, const glm::dvec3& origin = kOrigin) {
  const FieldTracer tracer(field, tree, search);
  const ViewRays rays(view, origin);
  Traced out;
  RayScratch scratch;
  out.image.size = view.size;
  for (int y = 0; y < view.size.height; ++y) {
    for (int x = 0; x < view.size.width; ++x) {
      const auto ray = rays.through({x + 0.5, y + 0.5});
      const FieldHit hit = tracer.cast({ray.origin, ray.direction, ray.start}, scratch, out.counts);
      out.image.distance.push_back(static_cast<float>(hit.distance));
      std::uint32_t id = 0;
      glm::dvec3 normal(0.0);
      if (hit) {
        const mesh::SurfacePoint s =
            tracer.surfaceAt(hit, ray.origin + hit.distance * ray.direction, scratch);
        id = s.id;
        normal = rays.toView(glm::normalize(s.outward));
        if (normal.z != 0 && glm::dot(s.outward, ray.direction) > 0) normal = -normal;
      }
      out.image.id.push_back(id);
      out.image.normal.push_back(glm::vec3(normal));
    }
  }
  return out;
}

void expectExact(const HitErrors& e) {
  EXPECT_EQ(e.missed, 0u);
  EXPECT_EQ(e.falseHits, 0u);
  EXPECT_GT(e.compared, 0u);
  EXPECT_LE(e.relativeRms, 1e-7);
  EXPECT_LE(e.normalRmsDeg, 1e-3);
}

void expectExactWithAnyTree(const MetaballField& field, const View& view,
                            const glm::dvec3& origin = kOrigin) {
  const ReferenceImage truth = traceReference(field, origin, view);
  for (const auto& [name, settings] : everyTree()) {
    SCOPED_TRACE(name);
    const FieldTree tree = buildFieldTree(field, settings);
    const Traced traced = trace(field, tree, view, Search::guaranteed, origin);
    expectExact(compareHits(traced.image, truth));
    EXPECT_EQ(traced.counts.effort.notConverged, 0u);
  }
}

TEST(BvhTracer, EveryKernelAndTreeIsExact) {
  struct Case {
    Kernel kernel;
    double level;
    int hollow;
  };
  for (const Case& c : {Case{{}, 0.5, 0}, Case{{}, 0.2, 3}, Case{{KernelShape::quartic}, 0.3, 2},
                        Case{{KernelShape::power, 3}, 0.4, 0}, Case{{KernelShape::power, 16}, 0.01, 3}}) {
    SCOPED_TRACE(kernelDegree(c.kernel));
    const MetaballField field = test::randomField(c.kernel, c.level, 70, 6, c.hollow, 5);
    expectExactWithAnyTree(field, test::viewOfBall(Projection::perspective, {32, 24}, kOrigin, 14));
  }
}

TEST(BvhTracer, EyesInsideTheSurfaceSeeItsInnerWall) {
  const auto scene = packedBalls(150, 5);
  const MetaballField& field = scene->surfaces[0];
  Camera camera;
  camera.fovY = 1.5;
  camera.distance = 1e-3;
  const BoundingSphere bounds = scene->bounds();
  test::Random random(4);
  std::size_t inside = 0;
  for (int i = 0; i < 6; ++i) {
    camera.target = bounds.center + random.inBox(9);
    camera.orientation = random.rotation();
    const FieldTree tree = buildFieldTree(field);
    RayScratch scratch;
    inside += FieldTracer(field, tree).inside(camera.target - scene->origin, scratch) ? 1 : 0;
    expectExactWithAnyTree(field, makeView(camera, {12, 9}, bounds), scene->origin);
  }
  EXPECT_GT(inside, 0u);
  EXPECT_LT(inside, 6u);
}

// Millions of roundings of a small ball's support lie between it and a large one.
TEST(BvhTracer, SupportsOfAnySizeInOneField) {
  for (const StabilityRecipe& recipe : stabilityRecipes()) {
    if (recipe.name != "support-ratio-1e6" && recipe.name != "eye-1e5" && recipe.name != "level-high" &&
        recipe.name != "tangent-supports" && recipe.name != "power-16" && recipe.name != "steep-field" &&
        recipe.name != "lattice-axis" && recipe.name != "coincident-100")
      continue;
    SCOPED_TRACE(recipe.name);
    const StabilityScene scene = recipe.make(1, {48, 36});
    const MetaballField& field = scene.surface->surfaces[0];
    const FieldTree tree = buildFieldTree(field);
    const Traced traced = trace(field, tree, scene.view, Search::guaranteed, scene.surface->origin);
    const HitErrors e = compareHits(traced.image, traceReference(field, scene.surface->origin, scene.view));
    EXPECT_EQ(e.missed + e.falseHits, 0u);
    EXPECT_LE(e.largestDistance, 1e-3 * scene.detail + 1e-7 * scene.view.distance);
  }
}

// What Gourmel's search misses are rays that dip into the surface between two projections.
TEST(BvhTracer, ThePapersSearchMissesNearlyTangentRaysOnly) {
  const auto scene = packedBalls(300, 3);
  const MetaballField& field = scene->surfaces[0];
  const View view = viewOfAll(*scene, {120, 90});
  const ReferenceImage truth = traceReference(field, scene->origin, view);
  for (const Structure structure : {Structure::split, Structure::fitted}) {
    const FieldTree tree = buildFieldTree(field, {structure});
    const HitErrors e = compareHits(trace(field, tree, view, Search::paper, scene->origin).image, truth);
    EXPECT_EQ(e.falseHits, 0u);
    EXPECT_GT(e.compared, 1000u);
    EXPECT_LE(e.missed, e.compared / 50);
  }
}

TEST(BvhTracer, CountsWhatAFittedTreeSaves) {
  const auto scene = packedBalls(2000, 3);
  const MetaballField& field = scene->surfaces[0];
  const View view = viewOfAll(*scene, {60, 45});
  const auto counts = [&](const TreeSettings& settings) {
    return trace(field, buildFieldTree(field, settings), view, Search::guaranteed, scene->origin).counts;
  };
  const TraceCounts split = counts({Structure::split, LeafCost::square}), fitted = counts({});
  EXPECT_EQ(split.rays, 60u * 45u);
  EXPECT_LT(2 * fitted.balls, split.balls);
  EXPECT_LT(fitted.leaves, split.leaves);
}

// F as any leaf's members have it.
double fieldOf(const MetaballField& field, std::span<const std::uint32_t> members, const glm::dvec3& at) {
  double sum = -field.level;
  for (const std::uint32_t i : members) {
    const Metaball& ball = field.balls[i];
    const glm::dvec3 v = at - glm::dvec3(ball.center);
    const double support = static_cast<double>(ball.support);
    sum += static_cast<double>(ball.coefficient) *
           kernelValue(field.kernel, 1 - glm::dot(v, v) / (support * support));
  }
  return sum;
}

bool holds(const Box& box, const glm::dvec3& p) {
  const glm::dvec3 low(box.low), high(box.high);
  return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y && p.z <= high.z;
}

// Wherever F >= 0 there is a cell, and cells know the field there; they overlap by no more than rounding.
TEST(FieldTree, CellsHoldTheSurfaceAndKnowTheField) {
  for (const int hollow : {0, 3}) {
    const MetaballField field = test::randomField({}, hollow > 0 ? 0.2 : 0.5, 120, 7, hollow, 5);
    for (const auto& [name, settings] : everyTree()) {
      if (settings.structure != Structure::fitted) continue;
      SCOPED_TRACE(name);
      const FieldTree tree = buildFieldTree(field, settings);
      std::vector<std::uint32_t> all(field.balls.size());
      for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
      test::Random random(7);
      int within = 0, cells = 0;
      for (int k = 0; k < 3000; ++k) {
        const glm::dvec3 p = random.inBox(11);
        const double truth = fieldOf(field, all, p);
        int leaves = 0;
        for (const Node& node : tree.nodes) {
          if (!node.leaf() || !holds(node.box, p)) continue;
          ++leaves;
          const double value = fieldOf(field, std::span(tree.members).subspan(node.first, node.count), p);
          if (truth >= 0 || value >= 0) {
            ASSERT_NEAR(value, truth, 1e-12);
          }
        }
        if (truth >= 0) {
          EXPECT_GE(leaves, 1);
          ++within;
        }
        EXPECT_LE(leaves, 1);  // random points do not lie between two
        cells += leaves;
      }
      EXPECT_GT(within, 100);
      if (settings.fit) {
        EXPECT_LT(cells, 2900);
      }
    }
  }
}

TEST(FieldTree, EveryBallIsOwnOnceInAClassicalTree) {
  const auto scene = packedBalls(3000, 9);
  for (const Structure structure : {Structure::classical, Structure::split}) {
    const FieldTree tree = buildFieldTree(scene->surfaces[0], {structure, LeafCost::square});
    std::vector<int> seen(scene->surfaces[0].balls.size());
    std::size_t leaves = 0;
    for (const Node& node : tree.nodes) {
      if (!node.leaf()) continue;
      ++leaves;
      for (std::uint32_t k = 0; k < node.own; ++k) ++seen[tree.members[node.first + k]];
    }
    EXPECT_EQ(leaves, tree.leaves);
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
  }
}

// Exactly those that overlap one of the leaf's own.
TEST(FieldTree, SplitMetaballsAreThoseThatOverlap) {
  const MetaballField field = test::randomField({}, 0.5, 150, 9, 0, 3);
  const FieldTree tree = buildFieldTree(field, {Structure::split, LeafCost::square});
  for (const Node& node : tree.nodes) {
    if (!node.leaf()) continue;
    const std::span members = std::span(tree.members).subspan(node.first, node.count);
    const std::set<std::uint32_t> found(members.begin(), members.end());
    EXPECT_EQ(found.size(), members.size());
    for (std::uint32_t i = 0; i < field.balls.size(); ++i) {
      bool own = false, meets = false;
      for (const std::uint32_t j : members.first(node.own)) {
        const Metaball &a = field.balls[i], &b = field.balls[j];
        own = own || i == j;
        meets = meets || glm::distance(a.center, b.center) < a.support + b.support;
      }
      EXPECT_EQ(found.count(i) == 1, own || meets);
    }
  }
}

TEST(FieldTree, IsTheSameForAnyNumberOfThreads) {
  const auto scene = packedBalls(20'000, 2);
  for (const Structure structure : {Structure::classical, Structure::split, Structure::fitted}) {
    const FieldTree many = buildFieldTree(scene->surfaces[0], {structure});
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const FieldTree single = buildFieldTree(scene->surfaces[0], {structure});
    EXPECT_EQ(many.members, single.members);
    ASSERT_EQ(many.nodes.size(), single.nodes.size());
    for (std::size_t i = 0; i < many.nodes.size(); ++i) {
      ASSERT_EQ(many.nodes[i].first, single.nodes[i].first);
      ASSERT_EQ(many.nodes[i].box.low, single.nodes[i].box.low);
      ASSERT_EQ(many.nodes[i].box.high, single.nodes[i].box.high);
    }
  }
}

// Nothing is quadratic: ten thousand balls in one place, and as many just beside them, cannot be told apart.
TEST(FieldTree, CoincidentBallsDoNotExplode) {
  MetaballField field;
  field.level = 100;
  for (std::uint32_t i = 0; i < 10'000; ++i)
    field.balls.push_back({glm::vec3(i % 2 == 0 ? 0.0f : 4.1f, 0, 0), 2, 1, 0xFFFFFF, i + 1});
  for (const Structure structure : {Structure::classical, Structure::split, Structure::fitted}) {
    const FieldTree tree = buildFieldTree(field, {structure});
    EXPECT_LE(tree.depth, kMostDepth);
    EXPECT_LE(tree.members.size(), 64 * field.balls.size());
    RayScratch scratch;
    TraceCounts counts;
    const FieldTracer tracer(field, tree);
    const FieldHit hit = tracer.cast({{-10, 0, 0}, {1, 0, 0}}, scratch, counts);
    // 5,000 of them are a ball whose level is a 50th of their sum.
    EXPECT_NEAR(hit.distance, 10 - 2 * coreShare({}, 100.0 / 5000, 1), 1e-9);
  }
}

TEST(FieldTree, AFieldWithoutASurfaceHasNoCells) {
  MetaballField field;
  field.level = 2;
  field.balls = {{{0, 0, 0}, 2, 1, 0, 1}, {{9, 0, 0}, 2, 1, 0, 2}, {{5, 0, 0}, 2, -1, 0, 3}};
  EXPECT_TRUE(buildFieldTree({}).nodes.empty());
  const FieldTree tree = buildFieldTree(field);
  RayScratch scratch;
  TraceCounts counts;
  EXPECT_FALSE(FieldTracer(field, tree).cast({{-10, 0, 0}, {1, 0, 0}}, scratch, counts));
  EXPECT_EQ(counts.leaves, 0u);
}

// A ray that begins on the surface does not meet it there: out of a ball it meets nothing, into it the other
// side, at exactly the chord that geometry says.
TEST(BvhTracer, RaysFromTheSurfaceDoNotMeetItWhereTheyBegin) {
  MetaballField field;
  field.balls = {{{1, 2, 3}, 4, 1, 0xFFFFFF, 1}};
  const FieldTree tree = buildFieldTree(field);
  const FieldTracer tracer(field, tree);
  const double radius = 4 * coreShare(field.kernel, field.level, 1);
  RayScratch scratch;
  TraceCounts counts;
  test::Random random(3);
  for (int i = 0; i < 3000; ++i) {
    const glm::dvec3 center(1, 2, 3), eye = center + 20.0 * random.direction();
    const glm::dvec3 aim = center + radius * (i % 3 == 0 ? 0.99999 : 0.99) * random.direction();
    const glm::dvec3 d = glm::normalize(aim - eye);
    const FieldHit hit = tracer.cast({eye, d}, scratch, counts);
    ASSERT_TRUE(hit);
    const glm::dvec3 at = eye + hit.distance * d, normal = glm::normalize(at - center);
    const glm::dvec3 mirrored = d - 2 * glm::dot(d, normal) * normal;
    EXPECT_FALSE(tracer.cast({at, mirrored, 0, kInfinity, Side::outside}, scratch, counts));
    EXPECT_FALSE(tracer.blocked({at, mirrored, 0, kInfinity, Side::outside}, scratch, counts));
    const FieldHit exit = tracer.cast({at, d, 0, kInfinity, Side::inside}, scratch, counts);
    ASSERT_TRUE(exit);
    EXPECT_NEAR(exit.distance, -2 * glm::dot(d, at - center), 1e-8);
  }
}

TEST(BoxTree, IsRefittedAroundBoxesThatMoved) {
  test::Random random(6);
  std::vector<Box> boxes;
  for (int i = 0; i < 500; ++i) {
    const glm::vec3 p(random.inBox(10));
    boxes.push_back({p - 0.5f, p + 0.5f});
  }
  Tree tree = buildBoxTree(boxes, LeafCost::linear);
  for (Box& box : boxes) {
    const glm::vec3 move(random.inBox(1));
    box = {box.low + move, box.high + move};
  }
  refitBoxTree(tree, boxes);
  for (const Node& node : tree.nodes) {
    Box below;
    if (node.leaf()) {
      for (std::uint32_t k = 0; k < node.count; ++k) below.add(boxes[tree.members[node.first + k]]);
    } else {
      below.add(tree.nodes[node.first].box);
      below.add(tree.nodes[node.first + 1].box);
    }
    EXPECT_EQ(below.low, node.box.low);
    EXPECT_EQ(below.high, node.box.high);
  }
}

}  // namespace
}  // namespace meniscus::bvh

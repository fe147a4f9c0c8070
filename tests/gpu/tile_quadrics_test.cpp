// Quadrics cast from tiles against the same quadrics splatted, and what drawing them so makes and leaves out.

#include "render/tile_quadrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "render/renderer.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace meniscus {
namespace {

class TileQuadricsTest : public test::GlTest {};
class TileQuadrics : public test::GlTest, public testing::WithParamInterface<QuadricMethod> {};
INSTANTIATE_TEST_SUITE_P(Both, TileQuadrics, testing::Values(QuadricMethod::tiles, QuadricMethod::tilesGlsl),
                         [](const auto& method) {
                           return std::string(method.param == QuadricMethod::tiles ? "tiles" : "tiles_glsl");
                         });

constexpr HitChannels kAll{.distance = true, .normal = true, .id = true};

// Pixels that differ by more than rounding.
int differences(const std::shared_ptr<const Primitives>& scene, const View& view, QuadricMethod method,
                double tolerance) {
  Renderer renderer;
  renderer.setPrimitives(scene);
  const HitImage a = renderer.renderHits(view, kAll, {}, QuadricMethod::splat);
  const HitImage b = renderer.renderHits(view, kAll, {}, method);
  int different = 0;
  for (std::size_t i = 0; i < a.id.size(); ++i) {
    const bool same =
        a.id[i] == b.id[i] &&
        (a.id[i] == 0 || static_cast<double>(std::abs(a.distance[i] - b.distance[i])) <= tolerance);
    different += !same;
  }
  return different;
}

TEST_P(TileQuadrics, ShowWhatSplattingShows) {
  constexpr ImageSize kSize{400, 300};
  auto all = std::make_shared<Primitives>(*test::randomChain(600, 5));
  all->ellipsoids = test::randomEllipsoids(300, 6, 0.3)->ellipsoids;
  for (EllipsoidPrimitive& e : all->ellipsoids) e.id += 1000;
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    const View view = test::viewOf(*all, kSize, projection);
    EXPECT_LE(differences(all, view, GetParam(), 1e-3), kSize.width * kSize.height / 100000 + 1);
  }
}

// The camera 1e4 and 1e5 Å away, where a pixel is a thousandth of an atom.
TEST_P(TileQuadrics, ShowTheSameFromAfar) {
  const auto scene = test::randomSpheres(300, 8);
  for (const double fovY : {2.4e-3, 2.4e-4}) {
    const View view = test::viewOf(*scene, {300, 300}, Projection::perspective, fovY);
    ASSERT_GT(view.distance, 5e3);
    EXPECT_LE(differences(scene, view, GetParam(), view.distance * 1e-6), 3);
  }
}

// Spheres far below a pixel: none covers a cell of its tile, so all of a tile's are listed.
TEST_P(TileQuadrics, ListsLongerThanADriverLoopsOver) {
  const auto scene = test::randomSpheres(20000, 3);
  View view = test::viewOf(*scene, {48, 36});
  view.pixelSize *= 3;
  EXPECT_EQ(differences(scene, view, GetParam(), 1e-3), 0);
}

// The camera among them, some behind it, some around it.
TEST_P(TileQuadrics, ShowTheSameFromInside) {
  auto scene = std::make_shared<Primitives>(*test::randomChain(600, 5));
  View view = test::viewOf(*scene, {120, 90});
  view.distance = 1;
  view.nearZ = 0.95;
  EXPECT_LE(differences(scene, view, GetParam(), 1e-3), 1);
}

TEST_F(TileQuadricsTest, NeedNoBufferAndNoProgram) {
  const auto scene = test::randomChain(30, 1);
  Renderer renderer(test::effectsBy(false));
  renderer.setPrimitives(scene);
  RenderSettings settings = test::withSamples(3, QuadricMethod::tiles);
  settings.shadows.mode = ShadowMode::hard;
  test::MemorySink sink;
  renderer.renderPicture(test::viewOf(*scene, {80, 60}), Lighting{}, {}, settings, PixelFormat::rgba8, sink);
  const RenderStats stats = renderer.stats();
  EXPECT_TRUE(stats.buffers.empty());
  EXPECT_EQ(stats.programs.size(), 3u) << "shadow, shade, resolve";
  EXPECT_EQ(stats.passes.front().name, "shadow map: tiles");
  EXPECT_EQ(stats.passes[1].name, "tiles");
  EXPECT_EQ(stats.passes[1].runs, 3);
  EXPECT_TRUE(std::any_of(stats.omissions.begin(), stats.omissions.end(), [](const OmissionStats& o) {
    return o.what == "pass spheres" && o.reason.find("tiles") != std::string::npos;
  }));
}

std::shared_ptr<const Primitives> copiesOfAChain(std::uint32_t copies, double halfBox = 25) {
  auto scene = std::make_shared<Primitives>();
  QuadricUnit& unit = scene->units.emplace_back();
  static_cast<Quadrics&>(unit) = *test::randomChain(300, 4);
  test::Random random(9);
  for (std::uint32_t i = 0; i < copies; ++i)
    unit.copies.push_back({{glm::mat3_cast(random.rotation()), random.inBox(halfBox)}, 300 * i});
  return scene;
}

TEST_F(TileQuadricsTest, CopiesLookAsEachByItself) {
  constexpr ImageSize kSize{400, 300};
  const auto drawn = [&](std::uint32_t copies, ImageSize size, const RenderSettings& settings, bool each) {
    std::shared_ptr<const Primitives> scene = copiesOfAChain(copies);
    const auto apart = std::make_shared<const Primitives>(copiesApart(*scene));
    const View view = test::viewOf(*apart, size);
    if (each) scene = apart;
    Renderer renderer;
    renderer.setPrimitives(scene);
    std::size_t guarded = 0;
    renderer.setCopyGuard([&](const QuadricCounts& counts) { guarded += counts.all(); });
    test::MemorySink sink;
    renderer.renderPicture(view, Lighting{}, {}, settings, PixelFormat::rgba8, sink);
    const bool copied =
        settings.quadrics == QuadricMethod::splat || settings.occlusion.on || settings.trace.any();
    EXPECT_EQ(guarded, copied && !each ? apart->counts().all() : 0);
    return sink.bytes;
  };
  RenderSettings settings = test::withSamples(1, QuadricMethod::tiles);
  settings.shadows.mode = ShadowMode::hard;
  const std::vector<std::byte> a = drawn(40, kSize, settings, false), b = drawn(40, kSize, settings, true);
  int different = 0;
  for (std::size_t i = 0; i < a.size(); i += 4) {
    int most = 0;
    for (std::size_t c = 0; c < 4; ++c)
      most = std::max(most, std::abs(std::to_integer<int>(a[i + c]) - std::to_integer<int>(b[i + c])));
    different += most > 1;
  }
  EXPECT_LE(different, kSize.width * kSize.height / 100000);

  // Where every copy is needed by itself, to the byte.
  settings.quadrics = QuadricMethod::splat;
  settings.occlusion.on = true;
  EXPECT_EQ(drawn(3, {64, 48}, settings, false), drawn(3, {64, 48}, settings, true));
  settings.occlusion.on = false;
  settings.trace.shadows = 1;
  EXPECT_EQ(drawn(3, {64, 48}, settings, false), drawn(3, {64, 48}, settings, true));
}

// 27,300 atoms in a picture of 24 pixels, in copies and by themselves.
TEST_F(TileQuadricsTest, SmallOnesAreTheSameBallsHoweverDrawn) {
  auto scene = std::make_shared<Primitives>(*copiesOfAChain(90, 100));
  static_cast<Quadrics&>(*scene) = *test::randomSpheres(300, 11);
  scene->units.front().cylinders.clear();  // as long as the chain
  std::size_t guarded = 0, most = 5000;
  const auto drawn = [&](ImageSize size, const RenderSettings& settings, RenderStats& stats) {
    Renderer renderer;
    renderer.setPrimitives(scene);
    renderer.setCopyGuard([&](const QuadricCounts& counts) {
      guarded = counts.all();
      if (guarded > most) throw std::runtime_error("too many: " + std::to_string(guarded));
    });
    test::MemorySink sink;
    renderer.renderPicture(test::viewOf(copiesApart(*scene), size), Lighting{}, {}, settings,
                           PixelFormat::rgba8, sink);
    stats = renderer.stats();
    return sink.bytes;
  };
  const auto thinned = [](const RenderStats& stats) {
    return std::count_if(stats.omissions.begin(), stats.omissions.end(), [](const OmissionStats& o) {
      return o.reason.find("balls stand for") != std::string::npos;
    });
  };
  RenderSettings settings = test::withSamples(4, QuadricMethod::splat);
  settings.shadows.mode = ShadowMode::hard;
  RenderStats stats, others;
  const std::vector<std::byte> splatted = drawn({24, 18}, settings, stats);
  EXPECT_EQ(thinned(stats), 2) << "the picture's and the shadow map's";
  EXPECT_GT(guarded, 90u) << "only balls that stand for others are put into memory copy by copy";
  for (const ResourceStats& buffer : stats.buffers)
    EXPECT_EQ(buffer.name, "balls that stand for others") << buffer.bytes;
  for (const QuadricMethod method : {QuadricMethod::tiles, QuadricMethod::tilesGlsl}) {
    settings.quadrics = method;
    const std::vector<std::byte> cast = drawn({24, 18}, settings, others);
    EXPECT_EQ(thinned(others), 2);
    ASSERT_EQ(cast.size(), splatted.size());
    int apart = 0;
    for (std::size_t i = 0; i < cast.size(); ++i)
      apart = std::max(apart, std::abs(std::to_integer<int>(cast[i]) - std::to_integer<int>(splatted[i])));
    EXPECT_LE(apart, 2);
  }

  settings.quadrics = QuadricMethod::splat;
  settings.levelOfDetail = false;
  EXPECT_THROW(drawn({24, 18}, settings, others), std::runtime_error);
  EXPECT_EQ(guarded, 27300u);
  most = guarded;
  EXPECT_NE(drawn({24, 18}, settings, others), splatted);
  EXPECT_EQ(thinned(others), 0);
  settings.levelOfDetail = true;
  drawn({800, 600}, settings, others);
  EXPECT_EQ(thinned(others), 0) << "too large";
  EXPECT_EQ(others.buffers.front().name, "spheres");
}

TEST_F(TileQuadricsTest, AutomaticChoosesByDevice) {
  EXPECT_EQ(chooseQuadrics(QuadricMethod::automatic).method,
            gl::queryDevice().software ? QuadricMethod::tiles : QuadricMethod::splat);
  EXPECT_NE(chooseQuadrics(QuadricMethod::automatic).reason.find(gl::queryDevice().name), std::string::npos);
  for (const QuadricMethod method : {QuadricMethod::splat, QuadricMethod::tiles, QuadricMethod::tilesGlsl})
    EXPECT_EQ(chooseQuadrics(method).method, method);
}

}  // namespace
}  // namespace meniscus

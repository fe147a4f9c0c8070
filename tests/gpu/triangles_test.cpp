// Triangles in the G-buffer, against the surface that they stand for.

#include "render/triangles.h"

#include <glad/gl.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <string_view>

#include "render/renderer.h"
#include "render/view_block.h"
#include "tests/support/gl_fixture.h"
#include "tests/support/scenes.h"

namespace meniscus {
namespace {

constexpr ImageSize kSize{160, 120};

/// A ball of 96 by 192 facets: chords lie at most 0.0006 radii beneath it.
void addBall(TriangleMesh& mesh, glm::vec3 center, float radius, std::uint32_t color, std::uint32_t id) {
  constexpr std::uint32_t kRows = 96, kColumns = 192;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t row = 0; row <= kRows; ++row) {
    for (std::uint32_t column = 0; column < kColumns; ++column) {
      const float a = glm::pi<float>() * static_cast<float>(row) / kRows,
                  b = 2 * glm::pi<float>() * static_cast<float>(column) / kColumns;
      const glm::vec3 n(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
      mesh.vertices.push_back({center + radius * n, n});
    }
  }
  for (std::uint32_t row = 0; row < kRows; ++row) {
    for (std::uint32_t column = 0; column < kColumns; ++column) {
      const std::uint32_t next = (column + 1) % kColumns;
      const std::uint32_t a = first + row * kColumns + column, b = first + row * kColumns + next;
      mesh.triangles.push_back({a, a + kColumns, b + kColumns});
      mesh.triangles.push_back({a, b + kColumns, b});
      mesh.surfaces.push_back({color, id});
      mesh.surfaces.push_back({color, id});
    }
  }
}

class TrianglesTest : public test::GlTest {
 protected:
  static std::vector<std::byte> draw(Renderer& renderer, const View& view, RenderSettings settings) {
    test::MemorySink sink;
    renderer.renderPicture(view, Lighting{}, {}, settings, PixelFormat::rgba8, sink);
    return sink.bytes;
  }
  static int difference(const std::vector<std::byte>& a, const std::vector<std::byte>& b, double& share) {
    int most = 0;
    std::size_t different = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const int d = std::abs(std::to_integer<int>(a[i]) - std::to_integer<int>(b[i]));
      most = std::max(most, d);
      different += d > 2 ? 1 : 0;
    }
    share = static_cast<double>(different) / static_cast<double>(a.size());
    return most;
  }
};

TEST_F(TrianglesTest, hitsAreThoseOfTheBallTheyStandFor) {
  const auto mesh = std::make_shared<Primitives>();
  addBall(mesh->mesh, {0, 0, 0}, 2, 0xFF0000, 7);
  const auto ball = std::make_shared<Primitives>();
  ball->spheres.push_back({{0, 0, 0}, 2, 0xFF0000, 7});
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    const View view = test::viewOf(*ball, kSize, projection);
    Renderer renderer;
    renderer.setPrimitives(mesh);
    const HitImage triangles = renderer.renderHits(view, {.distance = true, .normal = true, .id = true});
    renderer.setPrimitives(ball);
    const HitImage sphere = renderer.renderHits(view, {.distance = true, .normal = true, .id = true});
    std::size_t hits = 0, edges = 0;
    for (std::size_t i = 0; i < sphere.id.size(); ++i) {
      if (sphere.id[i] != triangles.id[i]) {
        ++edges;
        continue;
      }
      if (sphere.id[i] == 0) continue;
      ++hits;
      EXPECT_EQ(triangles.id[i], 7u);
      const float facing = std::abs(sphere.normal[i].z);
      if (facing < 0.2f) continue;  // a chord's depth at the limb is another matter
      EXPECT_NEAR(triangles.distance[i], sphere.distance[i], 0.01 / facing);
      EXPECT_GT(glm::dot(triangles.normal[i], sphere.normal[i]), 0.999f);
    }
    EXPECT_GT(hits, 5000u);
    EXPECT_LT(edges, hits / 50);
  }
}

TEST_F(TrianglesTest, aCameraInsideSeesTheInnerSide) {
  const auto mesh = std::make_shared<Primitives>();
  addBall(mesh->mesh, {0, 0, 0}, 2, 0xFF0000, 7);
  Camera camera;
  camera.distance = 1;
  camera.fovY = 1;
  const View view = makeView(camera, kSize, mesh->bounds());
  Renderer renderer;
  renderer.setPrimitives(mesh);
  const HitImage hits = renderer.renderHits(view, {.distance = true, .normal = true, .id = true});
  for (std::size_t i = 0; i < hits.id.size(); ++i) {
    ASSERT_EQ(hits.id[i], 7u);
    ASSERT_GT(hits.normal[i].z, 0.0f);
    ASSERT_GT(hits.distance[i], 1.9f);
    ASSERT_LT(hits.distance[i], 3.01f);
  }
}

TEST_F(TrianglesTest, castShadowsBesideASurfaceThatIsTranslucent) {
  const auto scene = std::make_shared<Primitives>();
  addBall(scene->mesh, {0, 0, 0}, 2, 0xC0C0C0, 1);
  MetaballField field;
  field.balls = {{{0, 0, 0}, 6, 1, 0x00FF00, 2}};
  scene->surfaces = {field};
  RenderSettings settings = test::withSamples(1);
  settings.shadows.mode = ShadowMode::hard;
  settings.occlusion.on = true;
  settings.surface.opacity = 0.5;
  Renderer renderer;
  renderer.setPrimitives(scene);
  draw(renderer, test::viewOf(*scene, kSize), settings);
  const RenderStats stats = renderer.stats();
  const auto ran = [&](std::string_view name) {
    return std::any_of(stats.passes.begin(), stats.passes.end(),
                       [&](const PassStats& pass) { return pass.name == name; });
  };
  EXPECT_TRUE(ran("shadow map: triangles"));
  EXPECT_TRUE(ran("shadow"));
  EXPECT_TRUE(ran("occlusion"));
}

// Hard shadows are the strictest: a convex mesh alone is lit as if there were none.
TEST_F(TrianglesTest, aMeshCastsShadowsButNoneOnItsOwnLitSide) {
  const auto alone = std::make_shared<Primitives>();
  addBall(alone->mesh, {0, 0, 0}, 2, 0xC0C0C0, 1);
  RenderSettings plain = test::withSamples(1), shadowed = plain;
  shadowed.shadows.mode = ShadowMode::hard;
  Renderer renderer;
  renderer.setPrimitives(alone);
  const View view = test::viewOf(*alone, kSize);
  double share = 0;
  EXPECT_LE(difference(draw(renderer, view, plain), draw(renderer, view, shadowed), share),
            40);  // the terminator
  EXPECT_LT(share, 0.005);

  // A small ball between the light and a large one: as a mesh it casts the shadow that it casts as a quadric.
  const glm::vec3 towardsLight = glm::normalize(glm::vec3(-0.45f, 0.6f, 0.8f));
  const auto meshOver = std::make_shared<Primitives>(), quadricOver = std::make_shared<Primitives>();
  for (const auto& scene : {meshOver, quadricOver}) scene->spheres.push_back({{0, 0, 0}, 3, 0xC0C0C0, 1});
  const glm::vec3 place = 6.0f * towardsLight;
  addBall(meshOver->mesh, place, 0.8f, 0xC0C0C0, 2);
  quadricOver->spheres.push_back({place, 0.8f, 0xC0C0C0, 2});
  Camera camera;
  camera.distance = 25;
  camera.fovY = 0.5;
  const View over = makeView(camera, kSize, quadricOver->bounds());
  renderer.setPrimitives(meshOver);
  const std::vector<std::byte> meshShadow = draw(renderer, over, shadowed),
                               meshPlain = draw(renderer, over, plain);
  renderer.setPrimitives(quadricOver);
  const std::vector<std::byte> quadricShadow = draw(renderer, over, shadowed);
  difference(meshShadow, quadricShadow, share);
  EXPECT_LT(share, 0.002);  // edges
  difference(meshShadow, meshPlain, share);
  EXPECT_GT(share, 0.004);
}

// In a shadow map the sides that face away from the light are drawn, and nowhere else: methods leave out
// those that face away from the viewer.
TEST_F(TrianglesTest, surfacesShowTheirOuterSidesAfterAShadowMapWithTriangles) {
  const auto scene = std::make_shared<Primitives>();
  addBall(scene->mesh, {-4, 0, 0}, 2, 0xC0C0C0, 1);
  MetaballField field;
  field.balls.push_back({{4, 0, 0}, 4, 1, 0x4080FF, 2});
  scene->surfaces.push_back(field);
  Camera camera;
  camera.distance = 30;
  camera.fovY = 0.5;
  const View view = makeView(camera, kSize, scene->bounds());
  const SurfaceSettings mesh{"mesh", {}};
  Renderer renderer;
  renderer.setPrimitives(scene);
  const HitImage before = renderer.renderHits(view, {.distance = true, .normal = true, .id = true}, mesh);
  EXPECT_GT(std::count(before.id.begin(), before.id.end(), 2u), 500);
  RenderSettings shadowed = test::withSamples(1);
  shadowed.surface = mesh;
  shadowed.shadows.mode = ShadowMode::hard;
  draw(renderer, view, shadowed);
  const HitImage after = renderer.renderHits(view, {.distance = true, .normal = true, .id = true}, mesh);
  EXPECT_EQ(after.distance, before.distance);
  EXPECT_TRUE(after.normal == before.normal);
  EXPECT_EQ(after.id, before.id);
}

// Ids of a mesh whose triangles all have their own.
std::vector<std::uint32_t> idsOf(const TriangleMesh& mesh, const View& view, std::int64_t blockBytes) {
  ShaderLibrary shaders{{}};
  TexturePool pool;
  TriangleBuffers buffers;
  buffers.upload(mesh, blockBytes);
  const Tile tile{0, 0, view.size.width, view.size.height};
  const f32::ViewBlock block = makeViewBlock(view, {0, 0, 0}, tile, {0, 0});
  gl::Buffer uniforms = gl::Buffer::updatable(sizeof block);
  uniforms.update(&block);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, uniforms.object.name());
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  FrameGraph graph(pool);
  const GBufferRefs gbuffer = createGBuffer(graph, tile.width, tile.height);
  addTriangles(graph, buffers, shaders, gbuffer);
  graph.want(gbuffer.id);
  RenderStats stats;
  graph.execute(stats, false);
  std::vector<std::uint32_t> ids(static_cast<std::size_t>(tile.width) *
                                 static_cast<std::size_t>(tile.height));
  graph.texture(gbuffer.id).read(tile.width, tile.height, tile.width, ids.data());
  return ids;
}

// A driver's storage blocks may be smaller than what a mesh has: it is drawn in parts.
TEST_F(TrianglesTest, trianglesKeepTheirOwnIdsHoweverSmallStorageBlocksAre) {
  Primitives scene;
  addBall(scene.mesh, {0, 0, 0}, 2, 0xFF0000, 1);
  for (std::size_t i = 0; i < scene.mesh.surfaces.size(); ++i)
    scene.mesh.surfaces[i].id = static_cast<std::uint32_t>(i + 1);
  Camera camera;
  camera.distance = 10;
  camera.fovY = 0.5;
  const View view = makeView(camera, kSize, scene.bounds());
  const std::vector<std::uint32_t> whole = idsOf(scene.mesh, view, 0);
  EXPECT_GT(std::count_if(whole.begin(), whole.end(), [](std::uint32_t id) { return id != 0; }), 3000);
  EXPECT_EQ(idsOf(scene.mesh, view, 5000), whole);  // 608 of the 36,864 at once, and a rest
  EXPECT_EQ(idsOf(scene.mesh, view, 8192), whole);  // whole parts
}

LabelSprite block(glm::dvec3 center, double radius, int width, int height) {
  LabelSprite sprite;
  sprite.label = {"x", center, radius};
  sprite.width = width;
  sprite.height = height;
  sprite.texels.assign(static_cast<std::size_t>(width * height), {255, 255});
  for (std::size_t i = 0; i < sprite.texels.size(); i += 3)
    sprite.texels[i] = {100, 180};  // edges of letters
  return sprite;
}

// However many rays a pixel has, a label is the same texels; what lies before it hides it.
TEST_F(TrianglesTest, labelsAreCrispAtAnyNumberOfSamplesAndHiddenByWhatIsNearer) {
  const auto scene = std::make_shared<Primitives>();
  scene->spheres.push_back({{0, 0, 0}, 1, 0x0000FF, 1});
  scene->spheres.push_back({{30, 0, 0}, 1, 0x0000FF, 2});
  Camera camera;
  camera.distance = 100;
  camera.fovY = 0.5;
  camera.target = {15, 0, 0};
  const View view = makeView(camera, kSize, scene->bounds());
  Renderer renderer;
  renderer.setPrimitives(scene);
  const std::vector<std::byte> bare = draw(renderer, view, test::withSamples(1));
  renderer.setLabels({block({15, 8, 0}, 0, 21, 9)}, {0x102030, 0xFFFFFF});
  const std::vector<std::byte> one = draw(renderer, view, test::withSamples(1)),
                               many = draw(renderer, view, test::withSamples(16));
  std::size_t drawn = 0;
  for (int y = 0; y < 60; ++y) {
    for (int x = 60; x < 100; ++x) {
      const auto at = static_cast<std::size_t>(4 * (y * kSize.width + x));
      for (std::size_t c = 0; c < 4; ++c)
        EXPECT_NEAR(std::to_integer<int>(one[at + c]), std::to_integer<int>(many[at + c]), 1);
      drawn += one[at] != bare[at] ? 1 : 0;
    }
  }
  EXPECT_EQ(drawn, 21u * 9u);
  // Behind a ball; at its nearest point; before it.
  double share = 0;
  const auto shownAt = [&](glm::dvec3 center, double radius) {
    renderer.setLabels({block(center, radius, 3, 3)}, {0x102030, 0xFFFFFF});
    difference(bare, draw(renderer, view, test::withSamples(1)), share);
    return share > 0;
  };
  EXPECT_FALSE(shownAt({0, 0, -1.5}, 0));
  EXPECT_FALSE(shownAt({0, 0, 0}, 0));
  EXPECT_TRUE(shownAt({0, 0, 0}, 1.01));
  EXPECT_TRUE(shownAt({0, 0, 5}, 0));
  EXPECT_FALSE(shownAt({0, 0, 200}, 0));  // behind the eye
  EXPECT_FALSE(shownAt({0, 200, 0}, 0));  // outside of the picture
}

TEST_F(TrianglesTest, picturesInTilesHaveTheSameLabelsAndTriangles) {
  const auto scene = std::make_shared<Primitives>();
  addBall(scene->mesh, {0, 0, 0}, 2, 0xFF8000, 3);
  const View view = test::viewOf(*scene, kSize);
  const auto drawWith = [&](int tile) {
    RendererOptions options;
    options.maxTileSize = tile;
    Renderer renderer(options);
    renderer.setPrimitives(scene);
    renderer.setLabels({block({0, 0, 0}, 3, 41, 15)}, {});
    RenderSettings settings = test::withSamples(4);
    settings.lines.silhouettes = true;
    return draw(renderer, view, settings);
  };
  double share = 0;
  EXPECT_LE(difference(drawWith(0), drawWith(37), share), 8);
  EXPECT_LT(share, 0.001);
}

}  // namespace
}  // namespace meniscus

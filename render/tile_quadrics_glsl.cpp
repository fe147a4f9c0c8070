#include "render/tile_quadrics_glsl.h"

#include <glad/gl.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "core/tiles/quadric_source.h"
#include "render/post/fullscreen.h"
#include "render/tile_quadrics.h"

namespace meniscus {

namespace {

// Of a list, that are gone through at once: Mesa's software driver ends loops that run too often
// (shaders/include/loops.glsl). Longer lists are drawn part by part.
constexpr int kMostEntries = 3500;

// Quadric of shaders/quadrics/tiles.frag.
struct QuadricTexels {
  glm::vec4 pixel, center, shape, axisU, axisV, range;
};
static_assert(sizeof(QuadricTexels) == 6 * 16);

QuadricTexels texelsOf(const tiles::QuadricRecord& q) {
  const auto high = [](double x) { return static_cast<float>(x); };
  const auto low = [&](double x) { return static_cast<float>(x - static_cast<double>(high(x))); };
  return {{high(q.pixelX), high(q.pixelY), low(q.pixelX), low(q.pixelY)},
          {q.centerX, q.centerY, q.centerZ, q.front},
          {q.fromEye != 0 ? 0.0f : q.perPixel, q.eyeAbove, static_cast<float>(q.kind), q.radius},
          {q.axisU[0], q.axisU[1], q.axisU[2], q.radii[0]},
          {q.axisV[0], q.axisV[1], q.axisV[2], q.radii[1]},
          {q.rangeHi, q.rangeLo, q.radii[2], 0}};
}

// 0xRRGGBB from bytes R, G, B, 255.
std::uint32_t colorOf(std::uint32_t albedo) {
  return (albedo & 0xFFu) << 16 | (albedo & 0xFF00u) | (albedo >> 16 & 0xFFu);
}

}  // namespace

void GlslTileQuadrics::setPrimitives(std::shared_ptr<const Primitives> primitives) {
  primitives_ = std::move(primitives);
  levels_ = nullptr;
  camera_ = {};
  light_ = {};
}

void GlslTileQuadrics::update(Lists& lists, const tiles::TileTarget& target) {
  if (lists.valid && tiles::sameLists(lists.target, target)) return;
  lists.valid = false;
  const tiles::DetailLevels::Level all = levels_->level(levels_->levelFor(target));
  const tiles::QuadricSource source(*all.primitives, target);
  lists.made.build(source, *all.clusters, target);
  const int blocks = lists.made.grid().blocks();
  std::vector<std::size_t> firsts(static_cast<std::size_t>(blocks) + 1, 0);  // members before a block's own
  for (int b = 0; b < blocks; ++b)
    firsts[static_cast<std::size_t>(b) + 1] =
        firsts[static_cast<std::size_t>(b)] + lists.made.block(b).members.size();
  std::vector<QuadricTexels> texels(firsts.back());
  std::vector<glm::uvec4> colors(firsts.back());
  std::vector<TileBlockEntries> entries(static_cast<std::size_t>(blocks));
  tbb::parallel_for(0, blocks, [&](int b) {
    const tiles::TileBlock& block = lists.made.block(b);
    const std::size_t first = firsts[static_cast<std::size_t>(b)];
    for (std::size_t i = 0; i < block.members.size(); ++i) {
      tiles::QuadricRecord record;
      source.record(block.members[i], record);
      texels[first + i] = texelsOf(record);
      colors[first + i] = {colorOf(record.albedo[0]), colorOf(record.albedo[1]), record.id[0], record.id[1]};
    }
    TileBlockEntries& out = entries[static_cast<std::size_t>(b)];
    for (const std::uint32_t member : block.entries)
      out.entries.push_back(static_cast<std::uint32_t>(first + member));
    for (int t = 0; t < tiles::kTilesPerBlock; ++t)
      out.counts[static_cast<std::size_t>(t)] = static_cast<std::uint32_t>(block.list(t).size());
  });
  lists.quadrics.upload(texels.data(), texels.size());
  lists.colors.reserve(std::max<std::size_t>(sizeof(glm::uvec4) * colors.size(), sizeof(glm::uvec4)));
  lists.colors.write(colors.data(), sizeof(glm::uvec4) * colors.size());
  lists.buffers.upload(lists.made.grid(), target.area, entries, "--quadrics tiles");
  lists.target = target;
  lists.valid = true;
}

void GlslTileQuadrics::add(FrameGraph& graph, ShaderLibrary& shaders, const tiles::TileTarget& target,
                           const GBufferRefs& g, const std::string& prefix) {
  Lists& lists = prefix.empty() ? camera_ : light_;
  if (!levels_) levels_ = tiles::levelsOf(*primitives_);
  tellDetail(graph, *levels_, target, prefix);
  graph.addPass(prefix + "tiles", {g.depth}, attachmentsOf(g),
                [this, &shaders, &lists, target, g, prefix](const PassContext& context) {
                  context.part(prefix + "tiles: lists", [&] { update(lists, target); });
                  context.part(prefix + "tiles: cast", [&] { draw(context, shaders, lists, g); });
                });
}

void GlslTileQuadrics::draw(const PassContext& context, ShaderLibrary& shaders, const Lists& lists,
                            const GBufferRefs& g) const {
  context.bindTarget();
  lists.buffers.bind();
  lists.colors.bindStorage(0);
  lists.quadrics.bind(0);
  const unsigned program =
      shaders.program("surface/near_plane.vert", "quadrics/tiles.frag", channelFlags(context, g));
  const tiles::PixelArea& area = lists.target.area;
  const tiles::PixelArea part = lists.made.occupied(area);
  glEnable(GL_SCISSOR_TEST);
  glScissor(part.x - area.x, part.y - area.y, part.width, part.height);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  const glm::ivec4& grid = lists.buffers.grid();
  glProgramUniform4i(program, 0, grid.x, grid.y, grid.z, grid.w);
  glProgramUniform1f(program, 2, lists.made.slack());
  for (int first = 0; first < static_cast<int>(lists.buffers.longest()); first += kMostEntries) {
    glProgramUniform2i(program, 1, first, kMostEntries);
    drawFullscreen(program);
  }
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_SCISSOR_TEST);
}

std::vector<ResourceStats> GlslTileQuadrics::buffers() const {
  std::vector<ResourceStats> out;
  const auto add = [&](const char* name, std::uint64_t bytes) {
    if (bytes > 0) out.push_back({name, bytes});
  };
  add("quadrics of tiles",
      camera_.quadrics.bytes() + camera_.colors.bytes() + light_.quadrics.bytes() + light_.colors.bytes());
  add("lists of tiles", camera_.buffers.bytes() + light_.buffers.bytes());
  return out;
}

}  // namespace meniscus

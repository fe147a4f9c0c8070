#include "render/surface/bvh.h"

#include <fmt/format.h>
#include <glad/gl.h>
#include <tbb/blocked_range.h>
#include <tbb/combinable.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <optional>

#include "core/bvh/field_tracer.h"
#include "core/bvh/view_ray.h"
#include "core/error.h"
#include "render/gl/storage.h"
#include "render/post/fullscreen.h"
#include "render/surface/ball_texture.h"
#include "render/surface/item_rows.h"
#include "render/surface/peel_regions.h"
#include "render/surface/projected_field.h"
#include "render/surface/ray_counts.h"
#include "render/two_floats.h"

namespace meniscus {

namespace {

constexpr SurfaceParameter kBvhParameters[] = {
    {"search", "0: the first root, isolated for certain; 1: the paper's search between projected centres", 0,
     0, 1, true},
    {"tolerance", "width to which a root is narrowed down, as a share of the smallest support around", 1e-5,
     1e-7, 0.1, false},
    {"square", "what a leaf of n balls is taken to cost: 1: n^2; 0: n", 1, 0, 1, true},
    {"fit", "1: cells are cut to the balls in them", 1, 0, 1, true},
    {"tight", "1: cells are cut to where their balls can add up to the level", 1, 0, 1, true},
    {"discard", "1: cells drop balls that add nothing to their surface", 1, 0, 1, true},
};

// Textures for so many pixels at once.
constexpr std::int64_t kMostPixels = std::int64_t{8} << 20;

// As in shaders/include/bvh.glsl.
constexpr int kMembersPerRow = 4096;
constexpr std::uint32_t kHit = 1, kInsideOut = 2, kUnanswered = 4;

// Loops of software drivers end after 65,535 turns (shaders/include/loops.glsl), and what the surface is
// like is summed up in one over a cell's members, each of which takes `kernelDegree()` turns of the power
// kernel's and none of the others'.
constexpr std::uint32_t kMostTurns = 50'000;

std::uint32_t mostInCell(const Kernel& kernel) {
  const bool power = kernel.shape == KernelShape::power;
  return kMostTurns / (power ? static_cast<std::uint32_t>(kernelDegree(kernel)) : 1u);
}

// BvhUniforms of shaders/include/bvh.glsl.
struct BvhBlock {
  glm::vec4 turn[3];
  glm::vec4 base, search;
  glm::ivec4 region;
};

// Two texels of tNodes.
struct NodeTexels {
  glm::vec3 low;
  std::uint32_t first;
  glm::vec3 high;
  std::uint32_t count;
};
static_assert(sizeof(NodeTexels) == 32);

// Sums of shaders/include/sums.glsl.
struct BvhCounts {
  RayCounts common;
  std::uint32_t nodes, leaves, balls;
};

// A ball that the near plane cuts.
bool mayBeginInside(const ProjectedField& projected) {
  return std::any_of(projected.depths.begin(), projected.depths.end(), [&](const glm::dvec2& depths) {
    return depths.x <= projected.nearDepth + 1e-6 * std::abs(projected.nearDepth);
  });
}

class Bvh : public SurfaceMethod {
 public:
  explicit Bvh(const SurfaceParameters& values)
      : tolerance_(values.at("tolerance")),
        search_(values.at("search") != 0 ? bvh::Search::paper : bvh::Search::guaranteed) {
    settings_.cost = values.at("square") != 0 ? bvh::LeafCost::square : bvh::LeafCost::linear;
    settings_.fit = values.at("fit") != 0;
    settings_.tight = values.at("tight") != 0;
    settings_.discard = values.at("discard") != 0;
  }

  void prepare(const MetaballField& field) override;
  void addPasses(FrameGraph& graph, ShaderLibrary& shaders, const SurfaceTarget& target) override;
  SurfaceStats takeStats() override;
  std::vector<ResourceStats> buffers() const override;
  std::uint64_t bytesOfBalls() const override;

 private:
  using Hits = std::vector<glm::uvec4>;

  void draw(const PassContext& context, ShaderLibrary& shaders, const SurfaceTarget& target);
  void drawRegion(const PassContext& context, ShaderLibrary& shaders, const SurfaceTarget& target,
                  const ProjectedField& projected, bool inside, const ScreenRect& region);
  void uploadTree();
  void setUniforms(const SurfaceTarget& target, const ProjectedField& projected, bool inside,
                   const ScreenRect& region);
  void answer(const gl::Texture& hits, const SurfaceTarget& target, const ProjectedField& projected,
              const ScreenRect& region);

  double tolerance_;
  bvh::Search search_;
  bvh::TreeSettings settings_;
  const MetaballField* field_ = nullptr;
  std::vector<float> coreShares_;
  bvh::FieldTree tree_;
  std::optional<bvh::FieldTracer> tracer_;  // once it is needed
  double buildMs_ = 0;
  gl::Texture nodes_, members_;
  BallTexture ballTexture_{4};
  gl::Storage balls_, control_;
  RayCountCopies<BvhCounts> counts_;
  gl::Buffer fieldUniforms_, bvhUniforms_;
  bvh::TraceCounts answered_;
};

void Bvh::prepare(const MetaballField& field) {
  field_ = &field;
  coreShares_ = coreShares(field);
  const auto start = std::chrono::steady_clock::now();
  tree_ = bvh::buildFieldTree(field, settings_);
  buildMs_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  tracer_.reset();
  const std::uint32_t most = mostInCell(field.kernel);
  for (const bvh::Node& node : tree_.nodes) {
    if (node.leaf() && node.count > most)
      throw InputError(
          fmt::format("surface method bvh: {} balls of a surface overlap in one place, of which "
                      "{} are possible with its kernel; use --surface-method tiles",
                      node.count, most));
  }
  if (tree_.nodes.empty()) return;
  uploadTree();
  fieldUniforms_ = gl::Buffer::updatable(sizeof(FieldBlock));
  bvhUniforms_ = gl::Buffer::updatable(sizeof(BvhBlock));
  control_.reserve(sizeof(std::uint32_t));
  counts_.prepare();
}

void Bvh::uploadTree() {
  std::vector<NodeTexels> texels;
  texels.reserve(tree_.nodes.size());
  for (const bvh::Node& node : tree_.nodes)
    texels.push_back({node.box.low, node.first, node.box.high, node.count});
  nodes_ = rowsOf(gl::TextureFormat::rgba32ui, texels, kBallsPerRow, 2);
  std::vector<std::uint32_t> members = tree_.members;
  members_ = rowsOf(gl::TextureFormat::r32ui, members, kMembersPerRow, 1);
}

void Bvh::addPasses(FrameGraph& graph, ShaderLibrary& shaders, const SurfaceTarget& target) {
  graph.addPass(target.prefix + "surface", {target.gbuffer.depth}, attachmentsOf(target.gbuffer),
                [this, &shaders, target](const PassContext& context) { draw(context, shaders, target); });
}

void Bvh::draw(const PassContext& context, ShaderLibrary& shaders, const SurfaceTarget& target) {
  if (tree_.nodes.empty()) return;
  const ProjectedField projected = projectField(*field_, coreShares_, target.view, target.origin, target.tile,
                                                target.sampleShift, BallOrder::depth);
  if (projected.balls.empty()) return;
  // By their number in the field; those that no ray meets stay zero.
  std::vector<ProjectedBall> balls(field_->balls.size());
  for (std::size_t i = 0; i < projected.balls.size(); ++i) balls[projected.indices[i]] = projected.balls[i];
  ballTexture_.upload(balls.data(), balls.size());
  balls_.reserve(balls.size() * sizeof(ProjectedBall));
  balls_.write(balls.data(), balls.size() * sizeof(ProjectedBall));
  const bool inside = mayBeginInside(projected);
  for (const ScreenRect& region : splitRect({0, 0, target.tile.width, target.tile.height}, kMostPixels))
    drawRegion(context, shaders, target, projected, inside, region);
}

void Bvh::setUniforms(const SurfaceTarget& target, const ProjectedField& projected, bool inside,
                      const ScreenRect& region) {
  const View& view = target.view;
  BvhBlock block{};
  const glm::dmat3 rows = glm::transpose(view.rotation);
  for (int i = 0; i < 3; ++i) block.turn[i] = glm::vec4(glm::vec3(rows[i]), 0);
  const double plane = static_cast<double>(projected.block.plane.x);
  block.base = glm::vec4(glm::vec3(rows * glm::dvec3(0, 0, plane) + (view.pivot - target.origin)), 0);
  block.search = {static_cast<float>(tolerance_), 0, 0, 0};
  block.region = {region.x, region.y, inside ? 1 : 0, 2};
  bvhUniforms_.update(&block);
  fieldUniforms_.update(&projected.block);
  glBindBufferBase(GL_UNIFORM_BUFFER, 1, fieldUniforms_.object.name());
  glBindBufferBase(GL_UNIFORM_BUFFER, 2, bvhUniforms_.object.name());
  balls_.bindStorage(0);
  control_.bindStorage(4);
  counts_.bindStorage(5);
  ballTexture_.bind(5);
  glBindTextureUnit(6, nodes_.object.name());
  glBindTextureUnit(7, members_.object.name());
}

void Bvh::drawRegion(const PassContext& context, ShaderLibrary& shaders, const SurfaceTarget& target,
                     const ProjectedField& projected, bool inside, const ScreenRect& region) {
  setUniforms(target, projected, inside, region);
  control_.zero();
  const TextureLease hits =
      context.pool().lease("surface: hits", {gl::TextureFormat::rgba32ui, region.width, region.height});
  glBindFramebuffer(GL_FRAMEBUFFER, context.pool().framebuffer({hits.get()}, nullptr));
  glViewport(0, 0, region.width, region.height);
  glBindTextureUnit(4, context.texture(target.gbuffer.depth).object.name());
  ShaderFlags flags = kernelFlags(field_->kernel);
  if (search_ == bvh::Search::paper) flags.insert("PAPER");
  drawFullscreen(shaders.program("post/fullscreen.vert", "surface/bvh_trace.frag", flags));
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  std::uint32_t unanswered = 0;
  control_.read(&unanswered, sizeof unanswered);
  if (unanswered > 0) answer(*hits, target, projected, region);

  context.bindTarget();
  glBindTextureUnit(4, hits->object.name());
  glEnable(GL_SCISSOR_TEST);
  glScissor(region.x, region.y, region.width, region.height);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  drawFullscreen(shaders.program("surface/near_plane.vert", "surface/bvh_surface.frag",
                                 channelFlags(context, target.gbuffer)));
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_SCISSOR_TEST);
}

// The processor casts what the shader has left to it.
void Bvh::answer(const gl::Texture& hits, const SurfaceTarget& target, const ProjectedField& projected,
                 const ScreenRect& region) {
  if (!tracer_) tracer_.emplace(*field_, tree_, search_);
  Hits texels(static_cast<std::size_t>(region.pixels()));
  hits.read(region.width, region.height, region.width, texels.data());
  const bvh::ViewRays rays(target.view, target.origin);
  const double plane = static_cast<double>(projected.block.plane.x);
  const bool perspective = target.view.projection == Projection::perspective;
  const glm::dvec2 corner =
      glm::dvec2(target.tile.x + region.x, target.tile.y + region.y) + glm::dvec2(target.sampleShift) + 0.5;
  tbb::combinable<bvh::TraceCounts> counts;
  tbb::parallel_for(tbb::blocked_range<int>(0, region.height, 1), [&](const auto& rows) {
    bvh::RayScratch scratch;
    for (int y = rows.begin(); y < rows.end(); ++y) {
      for (int x = 0; x < region.width; ++x) {
        glm::uvec4& texel = texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(region.width) +
                                   static_cast<std::size_t>(x)];
        if (texel.w != kUnanswered) continue;
        const auto ray = rays.through(corner + glm::dvec2(x, y));
        const bvh::FieldHit hit =
            tracer_->cast({ray.origin, ray.direction, ray.start}, scratch, counts.local());
        texel = glm::uvec4(0u);
        if (!hit) continue;
        const double stretch = perspective ? 1 / -rays.toView(ray.direction).z : 1;
        const double toPlane = perspective ? target.view.distance - plane : target.view.nearZ - plane;
        const double place = hit.distance - toPlane * stretch;
        texel = {hit.leaf, std::bit_cast<std::uint32_t>(high(place)),
                 std::bit_cast<std::uint32_t>(low(place)), kHit | (hit.fromInside ? kInsideOut : 0u)};
      }
    }
  });
  counts.combine_each([&](const bvh::TraceCounts& part) { answered_.add(part); });
  hits.write(region.width, region.height, texels.data(), 0, 0);
}

SurfaceStats Bvh::takeStats() {
  SurfaceStats stats;
  stats.method = search_ == bvh::Search::paper ? "bvh (the paper's search)" : "bvh";
  double hits = 0, nodes = 0, leaves = 0, balls = 0;
  for (const BvhCounts& c : counts_.take(stats)) {
    hits += c.common.hits;
    nodes += c.nodes;
    leaves += c.leaves;
    balls += c.balls;
  }
  stats.pixels += answered_.rays;
  stats.pieces += answered_.effort.pieces;
  stats.iterations += answered_.effort.iterations;
  stats.grazing += answered_.effort.grazing;
  stats.notConverged += answered_.effort.notConverged;
  stats.overflow = answered_.rays;
  stats.details = {
      {"hits", hits},
      {"nodes met", nodes + static_cast<double>(answered_.nodes)},
      {"cells searched", leaves + static_cast<double>(answered_.leaves)},
      {"balls in them", balls + static_cast<double>(answered_.balls)},
      {"cast by the processor", static_cast<double>(answered_.rays)},
      {"most nodes", static_cast<double>(tree_.nodes.size())},
      {"most balls in all cells", static_cast<double>(tree_.members.size())},
      {"most cells cut short", static_cast<double>(tree_.forcedLeaves)},
      {"most ms of construction", buildMs_},
      {"most bytes per pixel", static_cast<double>(gl::bytesPerTexel(gl::TextureFormat::rgba32ui))}};
  answered_ = {};
  return stats;
}

std::uint64_t Bvh::bytesOfBalls() const {
  if (tree_.nodes.empty()) return 0;
  return nodes_.bytes() + members_.bytes() + balls_.bytes() + ballTexture_.bytes();
}

std::vector<ResourceStats> Bvh::buffers() const {
  if (tree_.nodes.empty()) return {};
  return {{"surface: tree", nodes_.bytes() + members_.bytes()},
          {"surface: balls", balls_.bytes() + ballTexture_.bytes()},
          {"surface: sums", counts_.bytes() + control_.bytes()}};
}

}  // namespace

std::span<const SurfaceParameter> bvhParameters() {
  return kBvhParameters;
}

std::unique_ptr<SurfaceMethod> makeBvh(const SurfaceParameters& values) {
  return std::make_unique<Bvh>(values);
}

}  // namespace meniscus
